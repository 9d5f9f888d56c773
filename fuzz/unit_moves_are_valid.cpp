// Claim: a plan of LaCAM that is improved by unit moves is valid for disks, with the start-safe intervals
// that it states; it is still one of unit moves, is no worse, and is the same on any number of threads.
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/complete/complete_planner.hpp"
#include "planner/core/random.hpp"
#include "planner/improve/objective.hpp"
#include "planner/retime/steps.hpp"
#include "planner/unit_moves/improve_unit_moves.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "sipplab/validator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;
using fuzz::Event;
using fuzz::require;

/// One case in so many, by its seed, is made a crowd: five robots, of which a case has no more
/// (kMutatedRobots), seldom follow each other around corners.
constexpr std::uint64_t kCrowdOneIn = 2;
/// Starts and goals drawn for a crowd.
constexpr int kCrowdDraws = 40;

/// With more robots like the first one where there is room.
Instance crowded(Instance instance, std::uint64_t seed) {
  Random random(seed);
  for (int draw = 0; draw < kCrowdDraws && !instance.agents.empty(); ++draw) {
    Agent agent = instance.agents.front();
    agent.id = std::to_string(instance.agents.size());
    agent.start = instance.map.cell(random.below(instance.map.cell_count()));
    agent.goal = instance.map.cell(random.below(instance.map.cell_count()));
    instance.agents.push_back(agent);
    if (find_error(instance)) instance.agents.pop_back();
  }
  return instance;
}

/// Some milliseconds each.
constexpr std::uint64_t kMostSteps = 50'000;
constexpr std::uint64_t kIterations = 40;

/// With one of a few objectives, by the seed of the case, which stays the same while a case is made smaller.
PlannerOptions improving(const PlanCase& plan_case) {
  constexpr Objective kObjectives[] = {{1, 0}, {0, 1}, {1, 20}};
  PlannerOptions options = plan_case.options;
  options.max_expansions = kMostSteps;
  options.objective = kObjectives[options.seed % std::size(kObjectives)];
  options.improve = ImproveBudget{};
  options.improve->iterations = kIterations;
  return options;
}

PlanCost cost_of(const Solution& solution) { return {flowtime_s(solution), makespan_s(solution)}; }

void check_valid(const Instance& instance, const UnitImprovement& result) {
  ValidationOptions options;
  options.ssi_s = result.order.kept_s;
  options.order = result.order.order;
  const ValidationReport report = validate(instance, result.solution, options);
  require(Claim::kPlanIsValid, report.valid(), report.valid() ? "" : report.violations.front().message);
  require(Claim::kResultIsWhole, unit_visits(instance, FreeGrid(instance.map), result.solution).has_value(),
          "not a plan of unit moves any more");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto drawn = fuzz::read_case(data, size);
  if (!drawn) return -1;
  PlanCase plan_case = within_complete_model(*drawn);
  const std::uint64_t seed = plan_case.options.seed;
  if (seed % kCrowdOneIn == 0) plan_case.instance = crowded(std::move(plan_case.instance), seed);
  const Instance& instance = plan_case.instance;
  PlannerOptions options = improving(plan_case);
  const CompleteResult planned = plan_complete(instance, options);
  if (planned.status != LacamStatus::kSolved || instance.agents.empty()) return 0;
  const std::optional<UnitImprovement> result = improve_unit_moves(instance, planned.solution, options);
  fuzz::count(result ? Event::kSolved : Event::kFailed);
  if (!result) return 0;  // rounding of lags made it worse
  check_valid(instance, *result);
  require(Claim::kImprovementIsNoWorse,
          !is_better(options.objective, cost_of(planned.solution), cost_of(result->solution)),
          "worse than the plan that was given");
  options.threads = 2;
  const std::optional<UnitImprovement> same = improve_unit_moves(instance, planned.solution, options);
  require(Claim::kSameInputSamePlan,
          same && same->solution == result->solution && same->order.order == result->order.order &&
              same->statistics.expansions == result->statistics.expansions,
          "another plan on two threads");
  return 0;
}
