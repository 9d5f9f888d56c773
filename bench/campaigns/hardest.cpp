#include "bench/campaigns/hardest.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "planner/io/case_codec.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

void plan_file(const fs::path& file, std::vector<HardCase>& cases) {
  const auto text = read_file(file.string());
  if (!text) return;
  auto plan_case = decode_case(*text);
  if (!plan_case || plan_case->instance.agents.empty() || find_error(plan_case->instance)) return;
  plan_case->options.max_expansions = kHardestExpansions;
  plan_case->options.max_restarts = kHardestRestarts;
  HardCase hard;
  hard.file = file;
  const PlanResult result = plan(plan_case->instance, plan_case->options);
  hard.status = result.status;
  hard.expansions = result.statistics.expansions;
  hard.tries = result.tries();
  hard.plan_case = std::move(*plan_case);
  cases.push_back(std::move(hard));
}

}  // namespace

std::vector<HardCase> hardest_cases(const std::vector<std::string>& folders) {
  std::vector<HardCase> cases;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_regular_file(ignored)) plan_file(entry->path(), cases);
    }
  }
  std::sort(cases.begin(), cases.end(), [](const HardCase& a, const HardCase& b) {
    if (a.expansions_per_robot() != b.expansions_per_robot()) {
      return a.expansions_per_robot() > b.expansions_per_robot();
    }
    return a.file < b.file;
  });
  return cases;
}

std::vector<HardCase> distinct_cases(std::vector<HardCase> cases, std::size_t keep) {
  std::set<std::tuple<Rescheduling, bool, std::size_t>> seen;
  std::vector<HardCase> kept;
  for (HardCase& hard : cases) {
    const PlannerOptions& options = hard.plan_case.options;
    const auto kind =
        std::make_tuple(options.rescheduling, options.any_angle, hard.plan_case.instance.agents.size());
    if (kept.size() < keep && seen.insert(kind).second) kept.push_back(std::move(hard));
  }
  return kept;
}

}  // namespace sipplab::bench
