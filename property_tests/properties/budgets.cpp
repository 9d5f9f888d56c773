// Limits that several phases share: time, steps and restarts are kept by all of them together, a request to
// stop reaches each, and what a limit ends is called so. The clock of this file is its own: each look at
// it takes a second, so that time depends on work alone and is the same in every run.
#include <rapidcheck.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include "planner/complete/complete_planner.hpp"
#include "planner/prioritized/ejection.hpp"
#include "planner/solve/best_plan.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/improve.hpp"
#include "sipplab/solve.hpp"

namespace {

/// Looks at the clock so far, while it ticks; one second each.
std::chrono::seconds ticks{0};
bool ticking = false;

std::chrono::nanoseconds monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace

// Instead of the one of the standard library, which is in a shared library and gives way. It ticks for this
// file alone.
std::chrono::steady_clock::time_point std::chrono::steady_clock::now() noexcept {
  return std::chrono::steady_clock::time_point(ticking ? ++ticks : monotonic_ns());
}

namespace sipplab::budgets_laws {
namespace {

constexpr double kNoTimeLimit = std::numeric_limits<double>::infinity();
/// Looks at the clock beyond the limit: each phase takes at most so many until it sees that the time is up
/// and has said how long it took.
constexpr double kLooksOfAPhaseS = 8;

/// With `options.best`: LaCAM twice, the method and ejection with each start-safe interval,
/// and improvement.
double last_looks_s(const PlannerOptions& options) {
  const double intervals = options.longer_ssi_s.empty() ? static_cast<double>(std::size(kLongerSsiS))
                                                        : static_cast<double>(options.longer_ssi_s.size());
  return kLooksOfAPhaseS * (options.best ? 5 + 2 * intervals : 2 + intervals);
}

double ticks_of(const auto& run) {
  const auto begin = ticks;
  run();
  return std::chrono::duration<double>(ticks - begin).count();
}

PlanCase any_limited_case() {
  PlanCase plan_case = *any_case();
  PlannerOptions& options = plan_case.options;
  options.max_restarts = std::min<std::uint64_t>(options.max_restarts, 40);
  if (*rc::gen::inRange(0, 3) == 0) options.rescheduling = Rescheduling::kEjection;
  options.longer_ssi_s = *rc::gen::element(std::vector<double>{}, std::vector<double>{1, 2.5, 9},
                                           std::vector<double>{0.5, 1, 2, 4, 8, kInfiniteSsi});
  options.time_limit_s = kNoTimeLimit;
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// Seconds: from less than any plan takes to more than most.
double any_time_limit_s() { return *rc::gen::element(1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0); }

/// Robots that all have to move.
PlanCase any_moving_case() {
  PlanCase plan_case = any_limited_case();
  std::vector<Agent>& agents = plan_case.instance.agents;
  std::erase_if(agents, [](const Agent& agent) { return agent.start == agent.goal; });
  RC_PRE(!agents.empty());
  return plan_case;
}

/// ... and are to be improved, after one start-safe interval.
PlanCase any_improved_case() {
  PlanCase plan_case = any_moving_case();
  plan_case.options.longer_ssi_s.clear();
  plan_case.options.improve = ImproveBudget{};
  return plan_case;
}

const PropertyRoom room("budgets", [] {
  ticking = true;
  bool passed = true;

  passed &= property(
      "a time limit holds for all start-safe intervals together, and for the fallback once more", [] {
        PlanCase plan_case = any_limited_case();
        PlannerOptions& options = plan_case.options;
        if (!find_beyond_complete(plan_case.instance) && *rc::gen::arbitrary<bool>()) {
          options.fallback = Fallback::kComplete;
        }
        const PlanResult free = plan(plan_case.instance, options);
        options.time_limit_s = any_time_limit_s();
        PlanResult limited;
        const double taken_s = ticks_of([&] { limited = plan(plan_case.instance, options); });
        const bool falls_back = limited.made_by == Method::kComplete;
        RC_CLASSIFY(limited.status == PlanStatus::kLimit, "ended by the limit");
        RC_CLASSIFY(falls_back, "with the fallback");
        RC_ASSERT(taken_s <= options.time_limit_s * (falls_back ? 2 : 1) + last_looks_s(options));
        if (falls_back) return;  // it may have begun sooner
        // Whatever a limit did not end is as without it.
        if (limited.status != PlanStatus::kLimit) {
          RC_ASSERT(limited.status == free.status);
          RC_ASSERT(limited.solution == free.solution);
          RC_ASSERT(limited.tries() == free.tries());
          RC_ASSERT(limited.statistics.expansions == free.statistics.expansions);
        } else {
          RC_ASSERT(limited.solution.trajectories.empty());
          RC_ASSERT(limited.statistics.expansions <= free.statistics.expansions ||
                    free.status == PlanStatus::kLimit);
        }
        RC_ASSERT(limited.planning_seconds <= taken_s);
      });

  passed &= property("the best plan: a time limit is kept by all steps and improvement together", [] {
    PlanCase plan_case = any_limited_case();
    PlannerOptions& options = plan_case.options;
    options.best = true;
    options.time_limit_s = any_time_limit_s();
    SolveResult best;
    const double taken_s = ticks_of([&] { best = solve(plan_case.instance, options); });
    RC_CLASSIFY(best.improvement.has_value(), "improved");
    RC_ASSERT(taken_s <= options.time_limit_s + last_looks_s(options));
    RC_ASSERT(best.plan.planning_seconds <= taken_s);
    double ended_s = 0;
    double seconds = 0;
    for (const BestStep& step : best.steps) {
      RC_ASSERT(step.ended_s >= ended_s + step.seconds);
      ended_s = step.ended_s;
      seconds += step.seconds;
    }
    RC_ASSERT(std::abs(best.plan.planning_seconds - seconds) <= 1e-9 * (1 + seconds));
    if (!best.improvement) return;
    // With a first plan in hand, which may have taken its own share, improvement has most of the time.
    if (best.steps.front().kind == BestStep::Kind::kFallback &&
        best.steps.front().status == PlanStatus::kSolved) {
      RC_ASSERT(ended_s <=
                std::max(best.steps.front().ended_s, kShareBeforeImprovement * options.time_limit_s) +
                    last_looks_s(options));
    }
  });

  passed &= property("the best plan: the first plan has its share of the time and no more", [] {
    PlanCase plan_case = any_limited_case();
    RC_PRE(!find_beyond_complete(plan_case.instance));
    plan_case.options.best = true;
    plan_case.options.time_limit_s = any_time_limit_s();
    plan_case.options.improve = ImproveBudget{};
    plan_case.options.improve->iterations = 1;
    const SolveResult best = solve(plan_case.instance, plan_case.options);
    RC_ASSERT(best.steps.front().kind == BestStep::Kind::kFallback);
    RC_ASSERT(best.steps.front().seconds <=
              kShareOfFirstPlan * plan_case.options.time_limit_s + kLooksOfAPhaseS);
  });

  passed &= property("improvement for so many seconds ends then", [] {
    PlanCase plan_case = any_improved_case();
    PlannerOptions& options = plan_case.options;
    options.improve->seconds = *rc::gen::element(1.0, 10.0, 100.0);
    SolveResult result;
    double planning_s = 0;
    const double taken_s = ticks_of([&] {
      const auto begin = ticks;
      const PlanResult first = plan(plan_case.instance, options);
      planning_s = std::chrono::duration<double>(ticks - begin).count();
      RC_PRE(first.status == PlanStatus::kSolved);
      result = solve(plan_case.instance, options);
    });
    RC_ASSERT(result.improvement.has_value());
    // Planning is timed twice; unit moves, the pass after them and the search look again before each robot's
    // turn.
    constexpr double kPhases = 5;
    RC_ASSERT(taken_s <= 2 * planning_s + options.improve->seconds + kPhases * kLooksOfAPhaseS);
    RC_ASSERT(result.seconds() ==
              result.plan.planning_seconds + result.improvement->log.curve.back().seconds);
  });

  passed &= property("improvement without any time left searches no more", [] {
    PlanCase plan_case = any_improved_case();
    PlannerOptions& options = plan_case.options;
    options.improve->seconds = 0;
    const SolveResult result = solve(plan_case.instance, options);
    RC_PRE(result.improvement.has_value());
    RC_ASSERT(result.improvement->statistics.expansions == 0u);
    RC_ASSERT(result.improvement->log.was_cut_short);
  });

  passed &= property("a request to stop, or a time limit that is over, ends every phase at once", [] {
    PlanCase plan_case = any_limited_case();
    PlannerOptions& options = plan_case.options;
    if (!find_beyond_complete(plan_case.instance)) {
      options.fallback = *rc::gen::element(Fallback::kNone, Fallback::kComplete);
      options.method = *rc::gen::element(Method::kPrioritized, Method::kComplete);
    }
    const PlanResult free = plan(plan_case.instance, options);
    const std::atomic<bool> stop{true};
    if (*rc::gen::arbitrary<bool>()) {
      options.stop = &stop;
    } else {
      options.time_limit_s = 0;
    }
    const PlanResult stopped = plan(plan_case.instance, options);
    RC_ASSERT(stopped.statistics.expansions == 0u);
    if (free.statistics.expansions == 0) return;
    RC_ASSERT(stopped.status != PlanStatus::kSolved);
    RC_CLASSIFY(free.status == PlanStatus::kSolved, "solved if not stopped");
    // Some fail before they look at it.
    if (free.status == PlanStatus::kSolved) RC_ASSERT(stopped.status == PlanStatus::kLimit);
    options.best = true;
    const SolveResult best = solve(plan_case.instance, options);
    RC_ASSERT(best.statistics().expansions == 0u);
    if (best.improvement) RC_ASSERT(best.improvement->log.iterations == 0u);
  });

  passed &= property("work is that of all runs: escalation", [] {
    PlanCase plan_case = any_limited_case();
    RC_PRE(!plan_case.options.longer_ssi_s.empty());
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_PRE(result.status != PlanStatus::kLimit);
    SearchStatistics work;
    std::size_t tries = 0;
    std::vector<double> all_s = plan_case.options.longer_ssi_s;
    all_s.insert(all_s.begin(), plan_case.options.ssi_s);
    PlannerOptions one = plan_case.options;
    one.longer_ssi_s.clear();
    double seconds = 0;
    for (const double ssi_s : all_s) {
      one.ssi_s = ssi_s;
      const PlanResult next = plan(plan_case.instance, one);
      work += next.statistics;
      tries += next.tries();
      seconds += next.planning_seconds;
      if (next.status == PlanStatus::kSolved) {
        RC_ASSERT(result.order() == next.order());
        break;
      }
    }
    RC_CLASSIFY(tries > 1, "several runs");
    RC_ASSERT(result.statistics.expansions == work.expansions);
    RC_ASSERT(result.statistics.generations == work.generations);
    RC_ASSERT(result.tries() == tries);
    // This clock counts looks; a run within others looks a little more often.
    RC_ASSERT(result.planning_seconds >= seconds - 4.0 * static_cast<double>(all_s.size()));
  });

  passed &= property("budgets of expansions are kept by all runs together", [] {
    PlanCase plan_case = any_limited_case();
    const PlanResult free = plan(plan_case.instance, plan_case.options);
    RC_PRE(free.statistics.expansions > 0u);
    plan_case.options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.statistics.expansions);
    const PlanResult limited = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(limited.statistics.expansions <= plan_case.options.max_expansions);
    RC_ASSERT(limited.status == PlanStatus::kLimit);
    // One interval after the other with what is left, and none after the limit.
    std::vector<double> all_s = plan_case.options.longer_ssi_s;
    all_s.insert(all_s.begin(), plan_case.options.ssi_s);
    PlannerOptions one = plan_case.options;
    one.longer_ssi_s.clear();
    std::size_t tries = 0;
    for (const double ssi_s : all_s) {
      one.ssi_s = ssi_s;
      const PlanResult next = plan(plan_case.instance, one);
      tries += next.tries();
      RC_ASSERT(next.status != PlanStatus::kSolved);
      if (next.status == PlanStatus::kLimit) {
        RC_ASSERT(limited.ssi_s == ssi_s);
        RC_ASSERT(limited.tries() == tries);
        break;
      }
      if (tries > plan_case.options.max_restarts) break;
      one.max_expansions -= next.statistics.expansions;
      one.max_restarts -= next.tries();
    }
    plan_case.options.best = true;
    plan_case.options.longer_ssi_s = {2, 4};
    plan_case.options.improve = ImproveBudget{};
    plan_case.options.improve->iterations = 1;
    const SolveResult best = solve(plan_case.instance, plan_case.options);
    // LaCAM has a budget of its own, twice.
    std::uint64_t allowed = plan_case.options.max_expansions;
    for (const BestStep& step : best.steps) {
      if (step.kind == BestStep::Kind::kFallback) allowed += plan_case.options.max_expansions;
    }
    RC_ASSERT(best.plan.statistics.expansions <= allowed);
  });

  passed &= property("work of improvement: each robot alone, then iterations", [] {
    PlanCase plan_case = any_improved_case();
    PlannerOptions& options = plan_case.options;
    options.improve->iterations = 0;
    const SolveResult none = solve(plan_case.instance, options);
    RC_PRE(none.improvement.has_value());
    std::uint64_t alone = 0;
    PlanCost fastest;
    for (const Agent& agent : plan_case.instance.agents) {
      Instance one = plan_case.instance;
      one.agents = {agent};
      PlannerOptions unprotected = options;
      unprotected.rescheduling = Rescheduling::kNone;
      unprotected.ssi_s = 0;
      unprotected.max_expansions = UINT64_MAX;
      const PlanResult planned = plan(one, unprotected);
      alone += planned.statistics.expansions;
      fastest.flowtime_s += flowtime_s(planned.solution);
      fastest.makespan_s = std::max(fastest.makespan_s, makespan_s(planned.solution));
    }
    RC_ASSERT(none.improvement->statistics.expansions == alone);
    RC_ASSERT(none.statistics().expansions == none.plan.statistics.expansions + alone);
    options.improve->iterations = *rc::gen::inRange<std::uint64_t>(1, 7);
    const SolveResult some = solve(plan_case.instance, options);
    const ImprovementLog& log = some.improvement->log;
    RC_ASSERT(log.iterations <= options.improve->iterations);
    // Whatever makes the plan better moves, and that takes work.
    RC_ASSERT(some.improvement->statistics.expansions >= alone + log.improvements);
    RC_ASSERT(log.curve.size() >= log.improvements + 2);  // the first and the last of each stage
    // It ends where every robot is as fast as alone, but for rounding of sums.
    const PlanCost& cost = log.curve.back().cost;
    const bool is_optimal =
        cost.flowtime_s <= fastest.flowtime_s + 1e-9 && cost.makespan_s <= fastest.makespan_s + 1e-9;
    RC_ASSERT(log.iterations == options.improve->iterations || is_optimal);
    RC_CLASSIFY(is_optimal, "optimal");
  });

  passed &= property("a robot that is ejected too often ends the run as failed", [] {
    PlanCase plan_case = any_limited_case();
    PlannerOptions& options = plan_case.options;
    options.rescheduling = Rescheduling::kEjection;
    const auto search = single_agent_planner(plan_case.instance, options);
    const PlanResult free = plan_by_ejection(plan_case.instance, options, *search);
    std::vector<std::uint64_t> times(plan_case.instance.agents.size());
    for (const Try& pass : free.trace) {
      for (const AgentIndex robot : pass.ejected) ++times[robot];
    }
    const std::uint64_t most = times.empty() ? 0 : *std::max_element(times.begin(), times.end());
    RC_PRE(most > 0u);
    const PlanResult enough = plan_by_ejection(plan_case.instance, options, *search, most + 1);
    RC_ASSERT(enough.status == free.status);
    RC_ASSERT(enough.solution == free.solution);
    const std::uint64_t allowed = *rc::gen::inRange<std::uint64_t>(1, most + 1);
    const PlanResult limited = plan_by_ejection(plan_case.instance, options, *search, allowed);
    RC_ASSERT(limited.status == PlanStatus::kFailed);
    std::fill(times.begin(), times.end(), 0);
    for (const Try& pass : limited.trace) {
      for (const AgentIndex robot : pass.ejected) ++times[robot];
    }
    RC_ASSERT(*std::max_element(times.begin(), times.end()) == allowed);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::budgets_laws
