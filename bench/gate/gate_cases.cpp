#include "bench/gate/gate_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/judge/case_words.hpp"
#include "planner/core/try.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::bench {
namespace {

/// Every kind of case once: what the timed cells leave out.
constexpr const char* kExactSuite = "smoke";
constexpr const char* kTimedSuite = "gate";
constexpr const char* kCrowdedSuite = "gate-crowded";

}  // namespace

Expected<GateCases, std::string> GateCases::make(const std::string& suite, std::uint64_t seed,
                                                 const Extent& extent) {
  auto folder = SIPPLAB_TRY(TemporaryFolder::make());
  GateCases cases(std::move(folder));
  std::string error = cases.add_suite(suite, seed, true, false, extent.instances);
  if (error.empty() && extent.laboratory) cases.add_laboratory();
  if (error.empty() && extent.crowded && suite == kTimedSuite) {
    error = cases.add_suite(kCrowdedSuite, seed, true, true, extent.instances);
  }
  if (error.empty() && extent.exact && suite != kExactSuite) {
    error = cases.add_suite(kExactSuite, seed, false, false, extent.instances);
  }
  if (!error.empty()) return Unexpected{error};
  return cases;
}

void GateCases::add_laboratory() {
  // With what the last cell plans: the largest instances of the suite.
  const GateCell planned = cells_.back();
  for (const GateTask task : kLaboratoryTasks) {
    GateCell cell = planned;
    cell.name = fmt::format("laboratory: {}", name(task));
    cell.row.planner = fmt::format("laboratory:{}", name(task));
    cell.task = task;
    cell.jobs.clear();
    for (const std::size_t number : planned.jobs) {  // a history is the same for each: they are repetitions
      GateJob job = jobs_[number];
      job.cell = cells_.size();
      cell.jobs.push_back(jobs_.size());
      jobs_.push_back(std::move(job));
    }
    cells_.push_back(std::move(cell));
  }
}

std::string GateCases::add_suite(const std::string& name, std::uint64_t seed, bool timed, bool slow,
                                 std::optional<std::uint64_t> instances) {
  SweepRequest request;
  request.suite = find_suite(name);
  if (request.suite == nullptr) return fmt::format("no suite '{}'", name);
  // Restarts limit these suites; a clock would change results.
  request.values = {{find_option("time-limit"), {"inf"}}};
  request.seed = seed;
  request.count = instances;
  Expected<ExpandedSweep, std::string> sweep = expand(request);
  if (!sweep) return sweep.error();

  std::map<std::string, std::size_t> known;  // content hash to file
  for (std::size_t i = 0; i < hashes_.size(); ++i) known[hashes_[i]] = i;
  std::vector<db::CaseInfo> rows;
  for (const NamedCase& named : sweep->cases) rows.push_back(case_row(named.parameters));
  const std::vector<std::string> names = case_words(rows);
  for (std::size_t number = 0; number < rows.size(); ++number) {
    const SweepCase& parameters = sweep->cases[number].parameters;
    GateCell cell{names[number], rows[number], parameters.options, GateTask::kPlan, timed, slow, {}};
    for (const PreparedInstance& prepared : sweep->sets[parameters.set].instances) {
      const auto [place, is_new] = known.emplace(prepared.row.content_hash, files_.size());
      if (is_new) {
        files_.push_back((folder_.path() / fmt::format("{}.xml", files_.size())).string());
        hashes_.push_back(prepared.row.content_hash);
        const auto error = write_file(files_.back(), write_instance_xml(prepared.instance));
        if (error) return error->message();
      }
      cell.jobs.push_back(jobs_.size());
      jobs_.push_back({cells_.size(), place->second, prepared.row});
    }
    cells_.push_back(std::move(cell));
  }
  return "";
}

Expected<std::size_t, std::string> GateCases::hand_over(WorkerProcess& worker, bool all) const {
  std::size_t count = 0;
  std::size_t files = 0;
  for (const GateJob& job : jobs_) {
    if (!all && !cells_[job.cell].timed) break;
    for (; files <= job.instance; ++files) {
      const auto hash = SIPPLAB_TRY(worker.load(files_[files]));
      if (hash != hashes_[files]) {
        return Unexpected{job.row.name + ": the builds read the same file as different instances, expected " +
                          "equal content hashes"};
      }
    }
    SIPPLAB_TRY(worker.add_job(job.instance, cells_[job.cell].options, cells_[job.cell].task));
    ++count;
  }
  return count;
}

}  // namespace sipplab::bench
