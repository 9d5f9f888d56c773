// Plans in repair: what they cost, and which robots a rule of improvement takes out of them, by formulas of
// this file; and how often a rule is drawn.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/improve/attempt.hpp"
#include "planner/improve/neighbourhoods.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab::removals_laws {
namespace {

/// Each draws many times.
constexpr int kFewer = kCasesOfWorlds / 10;

/// Share of a sum: its rounding.
constexpr double kRounding = 1e-9;

/// A plan in repair, all of its robots planned.
struct InRepair {
  PlanCase plan_case;
  Solution solution;
  PriorityOrder order;
  std::unique_ptr<SingleAgentPlanner> planner;
  std::unique_ptr<PartialPlan> plan;
  std::vector<Trajectory> fastest_paths;
  std::vector<double> static_times_s;

  const Instance& instance() const { return plan_case.instance; }
  Neighbours neighbours() const { return {plan_case.instance, *plan, static_times_s, fastest_paths}; }
};

/// Fills in what follows from case, solution and order.
std::unique_ptr<InRepair> completed(std::unique_ptr<InRepair> repaired) {
  const Instance& instance = repaired->instance();
  repaired->planner = single_agent_planner(instance, repaired->plan_case.options);
  repaired->plan = std::make_unique<PartialPlan>(instance, 0, *repaired->planner);
  for (const AgentIndex agent : repaired->order) {
    repaired->plan->insert(agent, repaired->solution.trajectories[agent]);
  }
  PartialPlan nobody(instance, 0, *repaired->planner);
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    SearchStatistics work;
    auto alone = nobody.find(agent, {}, work);
    repaired->fastest_paths.push_back(alone ? *alone : repaired->solution.trajectories[agent]);
    repaired->static_times_s.push_back(distance(instance.agents[agent].start, instance.agents[agent].goal) /
                                       instance.agents[agent].speed_cells_per_s);
  }
  return repaired;
}

std::unique_ptr<InRepair> any_in_repair() {
  auto repaired = std::make_unique<InRepair>();
  repaired->plan_case = *any_case();
  PlannerOptions& options = repaired->plan_case.options;
  options.rescheduling = Rescheduling::kEjection;
  options.max_restarts = 40;
  options.ssi_s = 0;
  const Instance& instance = repaired->instance();
  RC_PRE(instance.agents.size() >= 2u);
  note_case(repaired->plan_case);
  const PlanResult result = plan(instance, options);
  RC_PRE(result.status == PlanStatus::kSolved);
  repaired->solution = result.solution;
  repaired->order = result.order();
  return completed(std::move(repaired));
}

/// Robots that go to and fro in rows of their own, with long rests in between.
std::unique_ptr<InRepair> any_in_rows() {
  constexpr std::int32_t kWidth = 30;
  constexpr std::int32_t kHeight = 10;
  auto repaired = std::make_unique<InRepair>();
  Instance& instance = repaired->plan_case.instance;
  instance.map = GridMap(kWidth, kHeight);
  std::vector<std::int32_t> rows(kHeight);
  std::iota(rows.begin(), rows.end(), 0);
  Random random(*rc::gen::arbitrary<std::uint64_t>());
  random.shuffle(rows);
  rows.resize(2 + random.below(7));
  for (const std::int32_t row : rows) {
    const auto any_place = [&] { return Cell{static_cast<std::int32_t>(random.below(kWidth)), row}; };
    Trajectory trajectory{any_place(), {}};
    for (auto legs = random.below(4); legs > 0; --legs) {
      const double now_s = trajectory.end_s();
      const Cell here = trajectory.end();
      const double until_s = now_s + 1 + static_cast<double>(random.below(12));
      trajectory.motions.push_back({now_s, until_s, here, here});
      const Cell next = any_place();
      if (next == here) continue;
      trajectory.motions.push_back({until_s, until_s + distance(here, next), here, next});
    }
    repaired->order.push_back(instance.agents.size());
    Agent& agent = instance.agents.emplace_back();
    agent.start = trajectory.start;
    agent.goal = trajectory.end();
    repaired->solution.trajectories.push_back(std::move(trajectory));
  }
  return completed(std::move(repaired));
}

/// A box around where a robot is at some time near `time_s`.
bool comes_near(const Trajectory& trajectory, Vec2 place, double time_s, double window_s, double cells) {
  const auto is_near = [&](Cell from, Cell to) {
    return std::min(from.x, to.x) - cells <= place.x && place.x <= std::max(from.x, to.x) + cells &&
           std::min(from.y, to.y) - cells <= place.y && place.y <= std::max(from.y, to.y) + cells;
  };
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s <= time_s + window_s && motion.end_s >= time_s - window_s &&
        is_near(motion.from, motion.to)) {
      return true;
    }
  }
  return trajectory.end_s() <= time_s + window_s && is_near(trajectory.end(), trajectory.end());
}

Vec2 place_at(const Trajectory& trajectory, double time_s) {
  for (const TimedMotion& motion : trajectory.motions) {
    if (time_s > motion.end_s || motion.end_s <= motion.begin_s) continue;
    const double share = (time_s - motion.begin_s) / (motion.end_s - motion.begin_s);
    return centre(motion.from) + (centre(motion.to) - centre(motion.from)) * share;
  }
  return centre(trajectory.end());
}

struct WindowChances {
  std::vector<double> of;  ///< by robot: to be chosen beside the first
  double nobody = 0;       ///< that nobody is near: then any may be chosen
};

/// For a moment of the first one's way, drawn uniformly.
WindowChances window_chances(const std::vector<Trajectory>& trajectories, AgentIndex first) {
  constexpr double kWindowCells = 3;
  constexpr double kHalfWindowS = 3;
  constexpr int kMoments = 500;
  WindowChances chances{std::vector<double>(trajectories.size(), 0)};
  for (int i = 0; i < kMoments; ++i) {
    const double time_s = trajectories[first].arrival_s() * (i + 0.5) / kMoments;
    const Vec2 place = place_at(trajectories[first], time_s);
    std::vector<AgentIndex> near;
    for (AgentIndex other = 0; other < trajectories.size(); ++other) {
      if (other != first && comes_near(trajectories[other], place, time_s, kHalfWindowS, kWindowCells)) {
        near.push_back(other);
      }
    }
    if (near.empty()) chances.nobody += 1.0 / kMoments;
    for (const AgentIndex other : near)
      chances.of[other] += 1.0 / kMoments / static_cast<double>(near.size());
  }
  return chances;
}

const PropertyRoom room("removals", [] {
  bool passed = true;

  passed &= property("cost_of: the cost of a plan in repair is that of its solution", [] {
    const auto repaired = any_in_repair();
    const PlanCost cost = cost_of(repaired->instance(), *repaired->plan);
    double flowtime = 0;
    double makespan = 0;
    for (const Trajectory& trajectory : repaired->solution.trajectories) {
      flowtime += trajectory.arrival_s();
      makespan = std::max(makespan, trajectory.arrival_s());
    }
    RC_ASSERT(std::abs(cost.flowtime_s - flowtime) <= kRounding * (1 + flowtime));
    RC_ASSERT(cost.makespan_s == makespan);
  });

  passed &= property("choose_neighbourhood: different robots, no more than asked for, by the rule", [] {
    const auto repaired = any_in_repair();
    const std::size_t robots = repaired->instance().agents.size();
    const auto rule = static_cast<RemovalRule>(*rc::gen::inRange(0, static_cast<int>(kRemovalRules)));
    const std::size_t most = *rc::gen::inRange<std::size_t>(1, 6);
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const std::vector<AgentIndex> chosen = choose_neighbourhood(rule, repaired->neighbours(), most, random);
    RC_TAG(std::string(name(rule)));
    RC_ASSERT(!chosen.empty());
    RC_ASSERT(chosen.size() == std::min(most, robots));
    RC_ASSERT(std::set<AgentIndex>(chosen.begin(), chosen.end()).size() == chosen.size());
    RC_ASSERT(*std::max_element(chosen.begin(), chosen.end()) < robots);
    const auto& trajectories = repaired->solution.trajectories;
    if (rule == RemovalRule::kLast) {
      constexpr std::size_t kLast = 5;
      std::size_t later = 0;  // of equal arrivals the first of the input counts as later
      for (AgentIndex agent = 0; agent < robots; ++agent) {
        const double one_s = trajectories[agent].arrival_s();
        const double first_s = trajectories[chosen[0]].arrival_s();
        later += one_s > first_s || (one_s == first_s && agent < chosen[0]);
      }
      RC_ASSERT(later < kLast);
    }
    if (rule == RemovalRule::kLast || rule == RemovalRule::kCrossing) {
      // Who is in the way comes before all others.
      const std::vector<AgentIndex> crossing =
          repaired->plan->conflicts(chosen[0], repaired->fastest_paths[chosen[0]]);
      for (std::size_t i = 1; i < chosen.size() && i <= crossing.size(); ++i) {
        RC_ASSERT(std::count(crossing.begin(), crossing.end(), chosen[i]) == 1);
      }
      RC_CLASSIFY(!crossing.empty(), "somebody in the way");
    }
  });

  passed &= property(
      "choose_neighbourhood: each of the last five begins, and no other",
      [] {
        const auto repaired = at_full_size(any_in_rows);
        const auto& trajectories = repaired->solution.trajectories;
        std::vector<AgentIndex> last = repaired->order;
        std::stable_sort(last.begin(), last.end(), [&](AgentIndex a, AgentIndex b) {
          return trajectories[a].arrival_s() > trajectories[b].arrival_s();
        });
        last.resize(std::min<std::size_t>(last.size(), 5));
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        std::set<AgentIndex> first;
        constexpr int kDraws = 120;  // the chance that one of five is not drawn is 1e-11
        for (int i = 0; i < kDraws; ++i) {
          first.insert(choose_neighbourhood(RemovalRule::kLast, repaired->neighbours(), 1, random).front());
        }
        RC_ASSERT(first == std::set<AgentIndex>(last.begin(), last.end()));
      },
      kFewer);

  passed &= property(
      "choose_neighbourhood: in a window is who is near at a moment drawn, as often as that",
      [] {
        const auto repaired = at_full_size(any_in_rows);
        const auto& trajectories = repaired->solution.trajectories;
        const std::size_t robots = trajectories.size();
        // By pairs: how often the second was chosen with the first.
        std::vector<std::vector<double>> chosen(robots, std::vector<double>(robots, 0));
        std::vector<double> draws(robots, 0);
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        constexpr int kDraws = 1500;
        for (int i = 0; i < kDraws; ++i) {
          const auto both = choose_neighbourhood(RemovalRule::kWindow, repaired->neighbours(), 2, random);
          ++draws[both.at(0)];
          ++chosen[both[0]][both.at(1)];
        }
        for (AgentIndex first = 0; first < robots; ++first) {
          const WindowChances chances = window_chances(trajectories, first);
          const double tolerance = 3.5 * std::sqrt(draws[first]) + 0.03 * draws[first];  // seven deviations
          for (AgentIndex other = 0; other < robots; ++other) {
            const double least = chances.of[other] * draws[first];
            RC_ASSERT(chosen[first][other] >= least - tolerance);
            RC_ASSERT(chosen[first][other] <= least + chances.nobody * draws[first] + tolerance);
          }
          RC_CLASSIFY(chances.nobody < 0.5 && draws[first] > 200, "windows with others, often drawn");
        }
      },
      kFewer);

  passed &= property("RuleRoulette: favours the rule that gains, gives up none, and knows no unit", [] {
    const auto winner = static_cast<RemovalRule>(*rc::gen::inRange(0, static_cast<int>(kRemovalRules)));
    const double gain = *any_of({1.0, 1e-6, 1e6});
    RuleRoulette roulette;
    RuleRoulette same;
    constexpr int kLessons = 400;
    for (int i = 0; i < kLessons; ++i) {
      for (std::size_t rule = 0; rule < kRemovalRules; ++rule) {
        const bool wins = static_cast<RemovalRule>(rule) == winner;
        roulette.learn(rule, wins ? gain : 0, 1);
        same.learn(rule, wins ? 1 : 0, 1);
      }
    }
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    Random random(seed);
    Random again(seed);
    std::array<int, kRemovalRules> drawn{};
    constexpr int kDraws = 400;
    for (int i = 0; i < kDraws; ++i) {
      const std::size_t rule = roulette.draw(random);
      ++drawn[rule];
      RC_ASSERT(rule == same.draw(again));
    }
    for (std::size_t rule = 0; rule < kRemovalRules; ++rule) {
      if (static_cast<RemovalRule>(rule) == winner) {
        RC_ASSERT(drawn[rule] > kDraws / 2);
      } else {
        RC_ASSERT(drawn[rule] > 0);
      }
    }
  });

  passed &= property(
      "Roulette: of equal gains for their work, draws of k times the work are rarer by the root of k", [] {
        const double times = *any_of({1.0, 4.0, 16.0, 64.0});
        const double worth = *any_of({1.0, 0.5, 0.25});  // of the one with more work
        const double unit = *any_of({1.0, 1e-3, 1e6});
        Roulette<2> roulette;
        constexpr int kLessons = 400;
        for (int i = 0; i < kLessons; ++i) {
          roulette.learn(0, 1, unit);
          roulette.learn(1, worth * times, times * unit);
        }
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        constexpr int kDraws = 4000;
        int drawn = 0;
        for (int i = 0; i < kDraws; ++i) drawn += static_cast<int>(roulette.draw(random));
        const double weight = worth / std::sqrt(times);
        const double expected = kDraws * weight / (1 + weight);
        RC_ASSERT(std::abs(drawn - expected) < 7 * std::sqrt(expected));  // seven deviations
      });

  return passed;
});

}  // namespace
}  // namespace sipplab::removals_laws
