// Re-scheduling by ejection: its plans are right, its final order keeps the guarantee of
// start-safe intervals, and its trace tells what happened.
#include "planner/prioritized/ejection.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/prioritized/conflict.hpp"
#include "planner/prioritized/partial_plan.hpp"
#include "planner/prioritized/start_precedence.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/generator.hpp"

namespace sipplab::ejection_laws {
namespace {

/// Enough for every case that can be solved; others end soon.
constexpr std::uint64_t kRestarts = 200;

PlanCase any_ejecting_case() {
  PlanCase plan_case = *any_case();
  plan_case.options.rescheduling = Rescheduling::kEjection;
  plan_case.options.max_restarts = std::min(plan_case.options.max_restarts, kRestarts);
  return plan_case;
}

std::size_t ejections(const PlanResult& result) {
  std::size_t count = 0;
  for (const Try& pass : result.trace) count += pass.ejected.size();
  return count;
}

PlanResult plan_case_of(const PlanCase& plan_case) {
  classify_case(plan_case);
  note_case(plan_case);
  PlanResult result = plan(plan_case.instance, plan_case.options);
  RC_CLASSIFY(result.status == PlanStatus::kSolved, "solved");
  RC_CLASSIFY(ejections(result) > 0, "somebody was ejected");
  RC_CLASSIFY(ejections(result) > 0 && result.status == PlanStatus::kSolved, "solved after ejections");
  return result;
}

void is_right(const PlanCase& plan_case, const PlanResult& result) {
  if (result.status != PlanStatus::kSolved) return;
  assert_valid(plan_case.instance, result.solution, {plan_case.options.ssi_s, result.order()});
}

/// The first order, as the other rules have it.
PriorityOrder first_order(PlanCase plan_case) {
  plan_case.options.rescheduling = Rescheduling::kNone;
  return plan(plan_case.instance, plan_case.options).trace.front().order;
}

/// Plays the trace: the next in the queue is planned or fails, and those that a
/// failed robot ejects were planned before and are next.
void tells_what_happened(const PlanCase& plan_case, const PlanResult& result) {
  const PriorityOrder first = first_order(plan_case);
  std::deque<AgentIndex> waiting(first.begin(), first.end());
  std::set<AgentIndex> planned;
  for (std::size_t i = 0; i < result.tries(); ++i) {
    const Try& pass = result.trace[i];
    const bool is_last = i + 1 == result.tries();
    RC_ASSERT(pass.order.empty() != is_last);
    RC_ASSERT(pass.failed.has_value() != (is_last && result.status == PlanStatus::kSolved));
    if (!pass.failed) break;
    while (!waiting.empty() && waiting.front() != *pass.failed) {
      planned.insert(waiting.front());
      waiting.pop_front();
    }
    RC_ASSERT(!waiting.empty());
    waiting.pop_front();
    for (auto robot = pass.ejected.rbegin(); robot != pass.ejected.rend(); ++robot) {
      RC_ASSERT(planned.erase(*robot) == 1u);
      waiting.push_front(*robot);
    }
    planned.insert(*pass.failed);
  }
  RC_ASSERT(result.order().size() == first.size());
  RC_ASSERT(std::is_permutation(first.begin(), first.end(), result.order().begin()));
}

/// Plays ejection by its rules (1) to (3) until a robot fails for the second time: from then on chance has a
/// say. Returns how many failures it saw.
std::size_t ejects_by_the_rules(const PlanCase& plan_case, const PlanResult& result) {
  const Instance& instance = plan_case.instance;
  const double ssi_s = plan_case.options.ssi_s;
  const auto search = single_agent_planner(instance, plan_case.options);
  PartialPlan plan(instance, ssi_s, *search);
  SearchStatistics work;
  const PriorityOrder first = first_order(plan_case);
  std::deque<AgentIndex> waiting(first.begin(), first.end());
  std::vector<int> times(instance.agents.size());
  std::set<AgentIndex> have_failed;
  std::size_t failures = 0;
  while (!waiting.empty()) {
    const AgentIndex agent = waiting.front();
    if (auto found = plan.find(agent, {}, work)) {
      plan.insert(agent, std::move(*found));
      waiting.pop_front();
      continue;
    }
    if (!have_failed.insert(agent).second) break;
    PartialPlan nobody(instance, ssi_s, *search);
    auto forced = nobody.find(agent, {}, work);
    if (failures >= result.tries()) break;  // the limit of restarts
    const Try& pass = result.trace[failures++];
    RC_ASSERT(pass.failed == agent);
    if (!forced) {
      RC_ASSERT(pass.ejected.empty());
      break;
    }
    Trajectory path = std::move(*forced);
    // Those ejected most often are the first to be put back, of these the first of the input.
    std::vector<std::pair<int, AgentIndex>> candidates;
    for (const AgentIndex other : plan.conflicts(agent, path)) candidates.emplace_back(-times[other], other);
    std::sort(candidates.begin(), candidates.end());
    std::vector<PartialPlan::Taken> taken;
    for (const auto& [rank, other] : candidates) taken.push_back(plan.take_out(other));
    std::vector<AgentIndex> ejected;
    for (PartialPlan::Taken& one : taken) {
      const AgentIndex other = one.agent;
      plan.put_back(std::move(one));
      if (plan.conflicts(agent, path) == std::vector<AgentIndex>{} && plan.keeps_guarantee(agent, path))
        continue;
      if (auto around = plan.find(agent, {}, work)) {
        path = std::move(*around);
      } else {
        plan.take_out(other);
        ejected.push_back(other);
        ++times[other];
      }
    }
    RC_ASSERT(pass.ejected == ejected);
    plan.insert(agent, std::move(path));
    waiting.pop_front();
    waiting.insert(waiting.begin(), ejected.begin(), ejected.end());
  }
  return failures;
}

/// Robots on walks, few enough to try all of their orders.
Scene any_few_walks() {
  constexpr std::size_t kMost = 4;
  Scene scene = *any_scene();
  RC_PRE(scene.instance.agents.size() >= 2u);
  scene.instance.agents.resize(std::min(scene.instance.agents.size(), kMost));
  scene.solution.trajectories.resize(scene.instance.agents.size());
  // Who begins in another one has no guarantee to keep.
  const auto& agents = scene.instance.agents;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      RC_PRE(distance(agents[i].start, agents[j].start) >= agents[i].radius_cells + agents[j].radius_cells);
    }
  }
  return scene;
}

/// How deep the two bodies are in each other at the deepest, in cells; negative if they stay apart.
double depth_cells(const Agent& one, const Trajectory& path, const Agent& other,
                   const Trajectory& other_path) {
  double least = kForever;
  for (const MovingDisk& a : disks_of(path, one.radius_cells)) {
    for (const MovingDisk& b : disks_of(other_path, other.radius_cells)) {
      least = std::min(least, closest_approach(leg_of(a), leg_of(b)));
    }
  }
  return one.radius_cells + other.radius_cells - least;
}

/// Whether some goal is near the start of another robot, and does not overlap it. The guarantee lets the
/// robot come too near within the disk of its goal then; plans are not made so.
bool has_goals_beside_starts(const Instance& instance) {
  for (std::size_t i = 0; i < instance.agents.size(); ++i) {
    for (std::size_t j = 0; j < instance.agents.size(); ++j) {
      const double contact = instance.agents[i].radius_cells + instance.agents[j].radius_cells;
      const double apart = distance(instance.agents[i].goal, instance.agents[j].start);
      if (i != j && contact <= apart && apart < 2 * contact) return true;
    }
  }
  return false;
}

/// Whether each robot keeps off the starts of those that come later.
bool keeps_guarantee(const Scene& scene, double ssi_s, const PriorityOrder& order) {
  ValidationOptions options;
  options.ssi_s = ssi_s;
  options.order = order;
  options.max_violations = 1000;
  const ValidationReport report = validate(scene.instance, scene.solution, options);
  return std::none_of(report.violations.begin(), report.violations.end(), [](const Violation& violation) {
    return violation.kind == ViolationKind::kStartSafeInterval;
  });
}

/// Enters, looks for and takes out robots at random: afterwards a plan is what one is that only got those who
/// are in it.
void leaves_nothing_behind(const PlanCase& plan_case) {
  const Instance& instance = plan_case.instance;
  RC_PRE(instance.agents.size() >= 2u);
  note_case(plan_case);
  const auto search = single_agent_planner(instance, plan_case.options);
  SearchLimits limits;
  limits.max_expansions = 2'000;
  SearchStatistics work;
  PartialPlan used(instance, plan_case.options.ssi_s, *search);
  std::vector<AgentIndex> planned;
  Random random(at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); }));
  const std::size_t steps = 4 * instance.agents.size();
  for (std::size_t i = 0; i < steps; ++i) {
    const auto agent = static_cast<AgentIndex>(random.below(instance.agents.size()));
    if (used.is_planned(agent)) {
      PartialPlan::Taken taken = used.take_out(agent);
      if (random.one_in(2)) {
        used.put_back(std::move(taken));
      } else {
        planned.erase(std::find(planned.begin(), planned.end(), agent));
      }
    } else if (auto found = used.find(agent, limits, work); found && !random.one_in(3)) {
      used.insert(agent, std::move(*found));
      planned.push_back(agent);
    }
  }
  PartialPlan fresh(instance, plan_case.options.ssi_s, *search);
  for (const AgentIndex agent : planned) fresh.insert(agent, used.trajectory(agent));
  RC_ASSERT(used.planned() == fresh.planned());
  if (planned.size() == instance.agents.size()) RC_ASSERT(used.order() == fresh.order());
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    if (used.is_planned(agent)) continue;
    const auto one = used.find(agent, limits, work);
    const auto other = fresh.find(agent, limits, work);
    RC_ASSERT(one.has_value() == other.has_value());
    if (one) RC_ASSERT(*one == *other);
  }
  RC_CLASSIFY(planned.size() >= 2, "two planned or more");
  RC_CLASSIFY(planned.size() < instance.agents.size(), "some not planned");
}

const PropertyRoom room("ejection", [] {
  bool passed = true;

  passed &= property("every solution is valid and keeps its start-safe interval in the final order", [] {
    const PlanCase plan_case = any_ejecting_case();
    is_right(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the same with start-safe intervals without end", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.ssi_s = kInfiniteSsi;
    is_right(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the trace tells who ejected whom, and the last try has the order", [] {
    const PlanCase plan_case = any_ejecting_case();
    RC_PRE(!plan_case.instance.agents.empty());
    tells_what_happened(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the same case gives the same result, to the last bit and counter", [] {
    const PlanCase plan_case = any_ejecting_case();
    const PlanResult one = plan_case_of(plan_case);
    const PlanResult other = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(one.solution == other.solution);
    RC_ASSERT(one.order() == other.order());
    RC_ASSERT(one.tries() == other.tries());
    RC_ASSERT(one.statistics.expansions == other.statistics.expansions);
  });

  passed &= property("what is solved without re-scheduling is solved the same way", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.rescheduling = Rescheduling::kNone;
    const PlanResult off = plan_case_of(plan_case);
    RC_PRE(off.status == PlanStatus::kSolved);
    plan_case.options.rescheduling = Rescheduling::kEjection;
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(result.tries() == 1u);
    RC_ASSERT(result.solution == off.solution);
    RC_ASSERT(result.order() == off.order());
  });

  passed &= property("budgets of restarts and expansions are kept, and end as limits", [] {
    PlanCase plan_case = any_ejecting_case();
    const PlanResult free = plan_case_of(plan_case);
    RC_PRE(free.tries() > 1u);
    plan_case.options.max_restarts = *rc::gen::inRange<std::uint64_t>(0, free.tries() - 1);
    const PlanResult few_tries = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(few_tries.status == PlanStatus::kLimit);
    RC_ASSERT(few_tries.tries() == plan_case.options.max_restarts + 1);
    plan_case.options.max_restarts = kRestarts;
    plan_case.options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.statistics.expansions);
    const PlanResult few_expansions = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(few_expansions.status == PlanStatus::kLimit);
    RC_ASSERT(few_expansions.statistics.expansions <= plan_case.options.max_expansions);
  });

  passed &= property("who is ejected, by the rules, until a robot fails for the second time", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.max_expansions = UINT64_MAX;
    plan_case.options.max_restarts = 8;
    const PlanResult result = plan_case_of(plan_case);
    const std::size_t failures = ejects_by_the_rules(plan_case, result);
    RC_CLASSIFY(failures > 1, "several failures");
  });

  passed &= property("PartialPlan: what was only looked for, or taken out, leaves nothing behind",
                     [] { leaves_nothing_behind(any_ejecting_case()); });

  passed &= property("PartialPlan: nothing is left behind in a crowd that crosses starts", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.ssi_s = kInfiniteSsi;
    GeneratorOptions generator;
    generator.agents = static_cast<std::size_t>(*rc::gen::inRange(4, 8));
    generator.seed = at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); });
    plan_case.instance = *generate_instance(GridMap(4, 3), generator);
    leaves_nothing_behind(plan_case);
  });

  passed &= property("are_in_conflict: exactly where bodies overlap deeper than touching", [] {
    constexpr double kSureCells = 1e-7;
    const Scene scene = any_few_walks();
    const auto& agents = scene.instance.agents;
    const auto& paths = scene.solution.trajectories;
    bool some = false;
    for (std::size_t i = 0; i < agents.size(); ++i) {
      for (std::size_t j = 0; j < agents.size(); ++j) {
        if (i == j) continue;
        const double depth = depth_cells(agents[i], paths[i], agents[j], paths[j]);
        const bool found = are_in_conflict(agents[i], paths[i], agents[j].radius_cells, paths[j]);
        RC_LOG() << i << " and " << j << ": " << depth << " deep" << std::endl;
        if (depth > kSureCells) RC_ASSERT(found);
        if (depth <= 0) RC_ASSERT(!found);
        some = some || found;
      }
    }
    RC_CLASSIFY(some, "some conflicts");
  });

  passed &= property(
      "StartPrecedence: the first order by preference that keeps the guarantee, if there is any", [] {
        const Scene scene = any_few_walks();
        const std::size_t robots = scene.instance.agents.size();
        const double ssi_s = *rc::gen::element(kInfiniteSsi, 0.5, 2.0, 5.0, 0.0, kInfiniteSsi);
        PriorityOrder preferred(robots);
        std::iota(preferred.begin(), preferred.end(), AgentIndex{0});
        Random random(at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); }));
        random.shuffle(preferred);
        // Those that keep the guarantee, by the places that their robots have in the preferred order.
        std::vector<std::size_t> ranks(robots);
        std::iota(ranks.begin(), ranks.end(), std::size_t{0});
        std::optional<PriorityOrder> expected;
        do {
          PriorityOrder order;
          for (const std::size_t rank : ranks) order.push_back(preferred[rank]);
          if (keeps_guarantee(scene, ssi_s, order)) expected = order;
        } while (!expected && std::next_permutation(ranks.begin(), ranks.end()));

        StartPrecedence precedence(scene.instance, ssi_s);
        bool closes = false;
        for (AgentIndex agent = 0; agent < robots; ++agent) {
          // Set twice or taken back, a trajectory counts once.
          if (random.one_in(3)) {
            precedence.set(agent, scene.solution.trajectories[agent]);
            if (random.one_in(2)) precedence.reset(agent);
          }
        }
        for (AgentIndex agent = 0; agent < robots; ++agent) precedence.reset(agent);
        for (AgentIndex agent = 0; agent < robots && !closes; ++agent) {
          closes = precedence.closes_cycle(agent, scene.solution.trajectories[agent]);
          precedence.set(agent, scene.solution.trajectories[agent]);
        }
        RC_CLASSIFY(!expected, "no order");
        RC_CLASSIFY(expected && *expected != preferred, "not the preferred one");
        const std::optional<PriorityOrder> found = precedence.order(preferred);
        if (found) RC_ASSERT(keeps_guarantee(scene, ssi_s, *found));
        if (ssi_s == kInfiniteSsi && has_goals_beside_starts(scene.instance)) return;
        RC_ASSERT(closes == !expected);
        if (expected) RC_ASSERT(found == expected);
      });

  return passed;
});

}  // namespace
}  // namespace sipplab::ejection_laws
