#include "fuzz/support/case_input.hpp"

#include <algorithm>
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_mutator.hpp"

namespace sipplab::fuzz {
namespace {

bool is_mixed(const Instance& instance) {
  const auto differs = [&](const Agent& agent) {
    const Agent& first = instance.agents.front();
    return agent.radius_cells != first.radius_cells || agent.speed_cells_per_s != first.speed_cells_per_s;
  };
  return std::any_of(instance.agents.begin(), instance.agents.end(), differs);
}

void count_kind(const PlanCase& plan_case) {
  const Instance& instance = plan_case.instance;
  count(Event::kValidInstances);
  if (instance.agents.size() >= 2) {
    count(Event::kTwoRobots);
    if (plan_case.options.ssi_s > 0) count(Event::kStartsProtected);
  }
  if (plan_case.options.any_angle) count(Event::kAnyAngle);
  if (!instance.obstacles.empty()) count(Event::kObstacles);
  if (is_mixed(instance)) count(Event::kMixedBodies);
}

}  // namespace

std::optional<PlanCase> read_case(const std::uint8_t* data, std::size_t size) {
  count(Event::kInputs);
  std::optional<PlanCase> plan_case = decode_case(text_of(data, size));
  if (!plan_case) {
    count(Event::kRefused);
    return std::nullopt;
  }
  count(Event::kAccepted);
  const std::string text = encode_case(*plan_case);
  const std::optional<PlanCase> again = decode_case(text);
  require(Claim::kReadsBackEqual,
          again && again->instance == plan_case->instance && encode_case(*again) == text,
          "the text of a case is read as another case");
  if (!is_small_case(*plan_case) || find_error(plan_case->instance)) return std::nullopt;
  PlannerOptions& options = plan_case->options;
  options.max_expansions = std::min(options.max_expansions, kMutatedExpansions);
  options.max_restarts = std::min(options.max_restarts, kMutatedRestarts);
  // The claims speak of one method, with one start-safe interval.
  options.method = Method::kPrioritized;
  options.fallback = Fallback::kNone;
  options.longer_ssi_s.clear();
  count_kind(*plan_case);
  return plan_case;
}

}  // namespace sipplab::fuzz
