// Each option reaches the place where it acts: the search, the order, the limits, and the repair of
// improvement.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "planner/grid/neighbourhood.hpp"
#include "planner/options/option_table.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/solve.hpp"

namespace sipplab {
namespace {

/// Robots that meet between shelves: some fail in the first try, and improvement finds something.
const Instance& crowd() {
  static const Instance instance = [] {
    GeneratorOptions wanted;
    wanted.agents = 24;
    GridMap map(14, 10);
    for (const std::int32_t y : {2, 3, 6, 7}) {
      for (std::int32_t x = 2; x < 12; ++x) map.set_blocked({x, y}, x != 6);
    }
    return generate_instance(map, wanted).value();
  }();
  return instance;
}

SolveResult solved_with(const std::string& words, const Instance& instance = crowd()) {
  PlannerOptions options;
  options.time_limit_s = std::numeric_limits<double>::infinity();
  options.max_restarts = 30;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t equals = words.find('=', at);
    const std::size_t end = std::min(words.find(' ', equals), words.size());
    const Option* option = find_option(words.substr(at, equals - at));
    EXPECT_TRUE(option != nullptr && option->set(options, words.substr(equals + 1, end - equals - 1)))
        << words;
    at = end + 1;
  }
  SolveResult result = solve(instance, options);
  if (result.is_solved()) {
    const ValidationReport report = validate(instance, result.solution(), result.guarantees(options.rules));
    EXPECT_TRUE(report.valid()) << words << ": " << report.violations.front().message;
  }
  return result;
}

std::vector<TimedMotion> motions_of(const Solution& solution) {
  std::vector<TimedMotion> all;
  for (const Trajectory& trajectory : solution.trajectories) {
    all.insert(all.end(), trajectory.motions.begin(), trajectory.motions.end());
  }
  return all;
}

bool all_on_grid(const Solution& solution, int k) {
  const std::vector<TimedMotion> motions = motions_of(solution);
  return std::all_of(motions.begin(), motions.end(), [k](const TimedMotion& motion) {
    const double exact = neighbourhood_distance(motion.from, motion.to, k);
    return motion.is_wait() || std::abs(exact - distance(motion.from, motion.to)) < 1e-9;
  });
}

bool turns(const Solution& solution) {
  const std::vector<TimedMotion> motions = motions_of(solution);
  return std::any_of(motions.begin(), motions.end(),
                     [](const TimedMotion& motion) { return motion.is_turn(); });
}

/// Work of an improvement of one and the same plan.
std::uint64_t repair_work(double weight) {
  const SolveResult given = solved_with("");
  PlannerOptions options;
  options.improve = parse_improve_budget("20i");
  options.weight = weight;
  return improve(crowd(), given.solution(), given.order(), options).statistics.expansions;
}

/// By name of the option: whether it changes what it is to change.
const std::map<std::string, std::function<bool()>> kActs = {
    {"ssi",
     [] {
       return solved_with("ssi=3").plan.ssi_s == 3 &&
              solved_with("ssi=0,7 reschedule=none").plan.tries() == 2;
     }},
    {"order",
     [] {
       return solved_with("order=longest").plan.trace[0].order !=
              solved_with("order=shortest").plan.trace[0].order;
     }},
    {"reschedule",
     [] { return solved_with("reschedule=none").plan.tries() == 1 && solved_with("").plan.tries() > 1; }},
    {"any-angle",
     [] {
       return all_on_grid(solved_with("any-angle=no connectedness=3 improve=20i").solution(), 3) &&
              !all_on_grid(solved_with("connectedness=3").solution(), 3);
     }},
    {"connectedness",
     [] {
       return all_on_grid(solved_with("any-angle=no connectedness=2 improve=20i").solution(), 2) &&
              !all_on_grid(solved_with("any-angle=no connectedness=3 improve=20i").solution(), 2);
     }},
    {"weight", [] { return repair_work(1.5) != repair_work(1); }},
    {"turns",
     [] {
       return turns(solved_with("turns=yes improve=20i").solution()) && !turns(solved_with("").solution());
     }},
    {"wait-before-move",
     [] {
       return makespan_s(solved_with("wait-before-move=2").solution()) >
              makespan_s(solved_with("").solution());
     }},
    {"inflate-distance",
     [] { return solved_with("inflate-distance=0.25").plan.solution != solved_with("").plan.solution; }},
    {"inflate-time",
     [] { return solved_with("inflate-time=0.5").plan.solution != solved_with("").plan.solution; }},
    {"seed",
     [] {
       return solved_with("order=random seed=2").plan.trace[0].order !=
              solved_with("order=random seed=3").plan.trace[0].order;
     }},
    {"max-expansions", [] { return solved_with("max-expansions=5").plan.statistics.expansions <= 5; }},
    {"max-restarts", [] { return solved_with("max-restarts=0").plan.tries() == 1; }},
    {"time-limit", [] { return solved_with("time-limit=1e-9").plan.status == PlanStatus::kLimit; }},
    {"method", [] { return solved_with("method=complete").plan.made_by == Method::kComplete; }},
    {"fallback",
     [] { return solved_with("max-expansions=500 fallback=complete").plan.made_by == Method::kComplete; }},
    {"best", [] { return solved_with("best=yes improve=1i").steps.size() > 1; }},
    {"improve",
     [] {
       return solved_with("improve=7i").improvement->log.iterations == 7 && !solved_with("").improvement;
     }},
    {"objective",
     [] {
       return solved_with("improve=1i objective=1:20").improvement->log.objective == Objective{1, 20};
     }},
    {"threads",
     [] { return solved_with("improve=8i threads=3").solution() == solved_with("improve=8i").solution(); }},
};

TEST(OptionEffects, EachOptionActs) {
  for (const Option& option : option_rows()) {
    const auto acts = kActs.find(option.name);
    ASSERT_NE(acts, kActs.end()) << "say here how to see that --" << option.name << " acts";
    EXPECT_TRUE(acts->second()) << option.name;
  }
}

}  // namespace
}  // namespace sipplab
