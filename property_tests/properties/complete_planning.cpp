// LaCAM: what it solves, against an exhaustive search; that its plans are
// valid; for how long its order keeps the starts safe.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "planner/complete/complete_planner.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// Steps: far more than the cases here take, a few milliseconds each at most.
constexpr std::uint64_t kMostSteps = 20'000;

PlannerOptions options_of(const PlanCase& plan_case) {
  PlannerOptions options = plan_case.options;
  options.max_expansions = kMostSteps;
  return options;
}

PlanCase any_case_within_model() {
  PlanCase plan_case = within_complete_model(*any_case());
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// A few cells, and on most of them robots whose goals are among these cells.
PlanCase make_crowd(std::uint64_t seed) {
  Random random(seed);
  const auto upto = [&random](std::uint64_t most) {
    return 1 + static_cast<std::int32_t>(random.below(most));
  };
  PlanCase plan_case;
  GridMap& map = plan_case.instance.map;
  map = GridMap(1 + upto(3), upto(3));
  std::vector<std::size_t> cells(map.cell_count());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  random.shuffle(cells);
  const std::size_t free_cells = std::min<std::size_t>(cells.size(), 2 + random.below(6));
  for (std::size_t i = free_cells; i < cells.size(); ++i) map.set_blocked(map.cell(cells[i]), true);
  cells.resize(free_cells);
  std::vector<std::size_t> goals = cells;
  random.shuffle(goals);
  const std::size_t robots = free_cells - std::min<std::size_t>(free_cells, random.below(4));
  for (std::size_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = map.cell(cells[i]);
    agent.goal = map.cell(goals[i]);
    plan_case.instance.agents.push_back(agent);
  }
  constexpr std::array<double, 4> kSsis = {0, 2.5, 5, kInfiniteSsi};
  plan_case.options.ssi_s = kSsis[random.below(kSsis.size())];
  plan_case.options.seed = random.next();
  return plan_case;
}

PlanCase any_crowd() {
  PlanCase plan_case = make_crowd(*rc::gen::arbitrary<std::uint64_t>());
  RC_PRE(pebble_search_is_small(plan_case.instance));
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

bool is_valid(const Instance& instance, const Solution& solution, double ssi_s,
              const std::vector<AgentIndex>& order) {
  ValidationOptions options;
  options.ssi_s = ssi_s;
  options.order = order;
  return validate(instance, solution, options).valid();
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("plan_complete (1): solves exactly what an exhaustive search solves", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, PlannerOptions{});
    const bool solvable = is_solvable_by_pebbles(plan_case.instance);
    RC_CLASSIFY(solvable, "solvable");
    RC_ASSERT(result.status == (solvable ? LacamStatus::kSolved : LacamStatus::kUnsolvable));
  });

  passed &= property("plan_complete (2): every plan of a crowd is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): every plan is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_case_within_model();
    RC_ASSERT(!find_beyond_complete(plan_case.instance));
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(result.ssi_kept_s <= plan_case.options.ssi_s);
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): no order keeps the starts safe for longer", [] {
    constexpr double kLongerS = 1e-3;
    const PlanCase plan_case = any_crowd();
    RC_PRE(plan_case.instance.agents.size() <= 5u);
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    const bool all_of_it = result.ssi_kept_s == plan_case.options.ssi_s;
    RC_CLASSIFY(!all_of_it, "not kept to the end");
    if (all_of_it) return;
    std::vector<AgentIndex> order(plan_case.instance.agents.size());
    std::iota(order.begin(), order.end(), AgentIndex{0});
    do {
      RC_ASSERT(!is_valid(plan_case.instance, result.solution, result.ssi_kept_s + kLongerS, order));
    } while (std::next_permutation(order.begin(), order.end()));
  });

  passed &= property("plan_complete (3): the same case gives the same plan", [] {
    const PlanCase plan_case = any_case_within_model();
    const CompleteResult one = plan_complete(plan_case.instance, options_of(plan_case));
    const CompleteResult other = plan_complete(plan_case.instance, options_of(plan_case));
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(one.solution == other.solution);
    RC_ASSERT(one.order == other.order);
    RC_ASSERT(one.ssi_kept_s == other.ssi_kept_s);
    RC_ASSERT(one.steps_tried == other.steps_tried);
  });

  passed &= property("a fallback plans what was not solved, and changes nothing else", [] {
    PlanCase plan_case = any_case_within_model();
    plan_case.options.max_expansions = std::min(plan_case.options.max_expansions, kMostSteps);
    const PlanResult without = plan(plan_case.instance, plan_case.options);
    plan_case.options.fallback = Fallback::kComplete;
    const PlanResult with = plan(plan_case.instance, plan_case.options);
    const bool needed = without.status != PlanStatus::kSolved;
    RC_CLASSIFY(needed, "needed");
    RC_CLASSIFY(needed && with.status == PlanStatus::kSolved, "saved");
    RC_ASSERT(with.made_by == (needed ? Method::kComplete : Method::kPrioritized));
    if (!needed) {
      RC_ASSERT(with.solution == without.solution);
      RC_ASSERT(with.ssi_kept_s == plan_case.options.ssi_s);
    } else if (with.status == PlanStatus::kSolved) {
      RC_ASSERT(with.tries() == without.tries() + 1);
      RC_ASSERT(is_valid(plan_case.instance, with.solution, with.ssi_kept_s, with.order()));
    }
  });

  passed &= property("bodies, speeds and obstacles beyond the model are refused in one line", [] {
    const PlanCase plan_case = *any_case();
    const Instance& instance = plan_case.instance;
    const bool beyond = !instance.obstacles.empty() ||
                        std::any_of(instance.agents.begin(), instance.agents.end(), [&](const Agent& agent) {
                          return agent.radius_cells > kDefaultRadiusCells ||
                                 agent.speed_cells_per_s != instance.agents.front().speed_cells_per_s;
                        });
    RC_CLASSIFY(beyond, "beyond");
    const auto error = find_beyond_complete(instance);
    RC_ASSERT(error.has_value() == beyond);
    if (!error) return;
    RC_ASSERT(!error->what.empty() && !error->expected.empty());
    RC_ASSERT((error->what + error->expected).find('\n') == std::string::npos);
    PlannerOptions options;
    options.method = Method::kComplete;
    RC_ASSERT(plan(instance, options).status == PlanStatus::kFailed);
  });

  return passed ? 0 : 1;
}
