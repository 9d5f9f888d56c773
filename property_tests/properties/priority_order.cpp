// What the first order goes by, what a budget buys, and the one exception to protected
// starts. [AY18], sections 3 and 4.
#include "planner/prioritized/priority_order.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::priority_order_laws {
namespace {

/// The least time that a robot needs, if a formula is at hand: any-angle, or four
/// neighbours.
double least_time_s(const Agent& agent, bool any_angle) {
  const double steps = std::abs(agent.goal.x - agent.start.x) + std::abs(agent.goal.y - agent.start.y);
  return (any_angle ? distance(agent.start, agent.goal) : steps) / agent.speed_cells_per_s;
}

void first_order_goes_by_time(InitialOrder kind) {
  PlanCase plan_case = *any_case_of(CaseFamily::kMixedBodies);
  PlannerOptions& options = plan_case.options;
  options.order = kind;
  options.rescheduling = Rescheduling::kNone;
  if (!options.any_angle) options.connectedness = 2;
  note_case(plan_case);
  const PriorityOrder order = plan(plan_case.instance, options).trace.front().order;
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const double first_s = least_time_s(plan_case.instance.agents[order[i]], options.any_angle);
    const double second_s = least_time_s(plan_case.instance.agents[order[i + 1]], options.any_angle);
    RC_CLASSIFY(first_s == second_s, "ties");
    if (first_s == second_s) {
      RC_ASSERT(order[i] < order[i + 1]);
    } else {
      RC_ASSERT((first_s < second_s) == (kind == InitialOrder::kShortestFirst));
    }
  }
}

/// The same for a robot with a heading, at any angle: it turns to where its goal lies, and ends with its goal
/// heading.
double least_turning_time_s(const Agent& agent, const MotionRules& rules) {
  const auto turn_s = [&](double from_deg, double to_deg) {
    return std::abs(std::remainder(from_deg - to_deg, 360)) / (180 * agent.rotation_speed);
  };
  const double last_s = agent.goal_heading_deg ? turn_s(agent.start_heading_deg, *agent.goal_heading_deg) : 0;
  if (agent.start == agent.goal) return last_s;
  const double towards_deg =
      std::atan2(agent.start.y - agent.goal.y, agent.goal.x - agent.start.x) * (180 / std::acos(-1.0));
  return distance(agent.start, agent.goal) / agent.speed_cells_per_s + rules.wait_before_move_s +
         std::max(last_s, turn_s(agent.start_heading_deg, towards_deg));
}

/// Uniform over first .. last, at every size.
int any_between(int first, int last) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(first, last + 1));
}

/// A goal at most this many columns and rows from the start of a robot that is planned
/// later, and room to step aside.
PlanCase goal_by_a_protected_start(int most_apart) {
  constexpr int kLeast = 5;  // cells between the two, so that there is time to leave
  PlanCase plan_case;
  plan_case.instance.map = GridMap(any_between(kLeast + 1, 11), any_between(3, 7));
  const GridMap& map = plan_case.instance.map;
  plan_case.instance.agents.resize(2);
  Agent& first = plan_case.instance.agents[0];
  Agent& second = plan_case.instance.agents[1];
  const auto row = [&map] { return any_between(0, map.height() - 1); };
  const auto near = [most_apart](int place, int side) {
    return any_between(std::max(0, place - most_apart), std::min(side - 1, place + most_apart));
  };
  first.start = {0, row()};
  second.start = {any_between(kLeast, map.width() - 1), row()};
  first.goal = {near(second.start.x, map.width()), near(second.start.y, map.height())};
  second.goal = {any_between(1, map.width() - 1), row()};
  RC_PRE(second.goal != first.goal);
  plan_case.options.order = InitialOrder::kFifo;
  plan_case.options.rescheduling = Rescheduling::kNone;
  plan_case.options.ssi_s = kInfiniteSsi;
  plan_case.options.any_angle = *rc::gen::arbitrary<bool>();
  note_case(plan_case);
  return plan_case;
}

bool keeps_starts_for_ever(const PlanCase& plan_case, const PlanResult& result) {
  ValidationOptions options;
  options.ssi_s = kInfiniteSsi;
  options.order = result.order();
  return validate(plan_case.instance, result.solution, options).valid();
}

const PropertyRoom room("priority_order", [] {
  bool passed = true;

  passed &= property("shortest first goes by least time, ties by input position",
                     [] { first_order_goes_by_time(InitialOrder::kShortestFirst); });

  passed &= property("longest first goes by least time, ties by input position",
                     [] { first_order_goes_by_time(InitialOrder::kLongestFirst); });

  passed &= property("shortest first counts turns and delays", [] {
    constexpr double kRoundingS = 1e-9;
    PlanCase plan_case = *any_turning_case();
    plan_case.options.order = InitialOrder::kShortestFirst;
    plan_case.options.rescheduling = Rescheduling::kNone;
    plan_case.options.any_angle = true;
    plan_case.options.max_expansions = 1;  // the first order is all that counts
    note_case(plan_case);
    const PriorityOrder order = plan(plan_case.instance, plan_case.options).trace.front().order;
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      RC_ASSERT(least_turning_time_s(plan_case.instance.agents[order[i]], plan_case.options.rules) <=
                least_turning_time_s(plan_case.instance.agents[order[i + 1]], plan_case.options.rules) +
                    kRoundingS);
    }
  });

  passed &= property("initial_order: by length, ties by input position, however many robots there are", [] {
    const int robots = any_between(0, 90);
    std::vector<double> lengths_s;
    for (int i = 0; i < robots; ++i) lengths_s.push_back(any_between(0, 3) / 8.0);
    for (const InitialOrder kind :
         {InitialOrder::kFifo, InitialOrder::kShortestFirst, InitialOrder::kLongestFirst}) {
      std::vector<std::pair<double, AgentIndex>> sorted;
      for (AgentIndex i = 0; i < lengths_s.size(); ++i) {
        const double key = kind == InitialOrder::kFifo            ? 0
                           : kind == InitialOrder::kShortestFirst ? lengths_s[i]
                                                                  : -lengths_s[i];
        sorted.emplace_back(key, i);
      }
      std::sort(sorted.begin(), sorted.end());
      Random random(0);
      const PriorityOrder order = initial_order(kind, lengths_s, random);
      RC_ASSERT(order.size() == sorted.size());
      for (std::size_t i = 0; i < order.size(); ++i) RC_ASSERT(order[i] == sorted[i].second);
    }
    RC_CLASSIFY(robots > 16, "more than 16 robots");
  });

  passed &= property("a budget of just the expansions that are needed is enough", [] {
    PlanCase plan_case = *any_case();
    const PlanResult free = plan(plan_case.instance, plan_case.options);
    RC_PRE(free.status == PlanStatus::kSolved);
    plan_case.options.max_expansions = free.statistics.expansions;
    note_case(plan_case);
    const PlanResult limited = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(limited.status == PlanStatus::kSolved);
    RC_ASSERT(limited.solution == free.solution);
  });

  passed &= property("starts protected for ever: a goal on another's start is reached all the same", [] {
    const PlanCase plan_case = goal_by_a_protected_start(0);
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(result.status == PlanStatus::kSolved);
    RC_ASSERT(keeps_starts_for_ever(plan_case, result));
  });

  passed &= property("starts protected for ever: a start beside the own goal is protected, too", [] {
    const PlanCase plan_case = goal_by_a_protected_start(2);
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_CLASSIFY(result.status == PlanStatus::kSolved, "solved");
    if (result.status == PlanStatus::kSolved) RC_ASSERT(keeps_starts_for_ever(plan_case, result));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::priority_order_laws
