// Which robots' paths to destroy and repair.
// After Li, Chen, Harabor, Stuckey and Koenig, "Anytime Multi-Agent Path Finding via Large
// Neighborhood Search", IJCAI 2021: their agent-based and random rules, a rule for places in
// time, and one for the last to arrive; adaptive selection as in Ropke and Pisinger 2006.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/prioritized/partial_plan.hpp"

namespace sipplab {

enum class RemovalRule {
  kCrossing,  ///< a robot, drawn by its delay, and some in conflict with its fastest path
  kLast,      ///< the same for a robot among the last to arrive
  kWindow,    ///< robots that come near one place within a short time
  kRandom,    ///< any, drawn by delay
};
inline constexpr std::size_t kRemovalRules = 4;
/// "crossing", "last", "window", "random".
std::string_view name(RemovalRule rule);

/// What the rules know of the robots.
struct Neighbours {
  const Instance& instance;
  const PartialPlan& plan;
  const std::vector<double>& static_times_s;     ///< by robot
  const std::vector<Trajectory>& fastest_paths;  ///< by robot, alone on the map
};

/// At least one robot and at most `most` of them, all different.
/// REQUIRES: all robots are planned, and there is at least one; most > 0.
std::vector<AgentIndex> choose_neighbourhood(RemovalRule rule, const Neighbours& among, std::size_t most,
                                             Random& random);

/// Adaptive selection by roulette wheel: favours rules that gain most for their work.
class RuleRoulette {
 public:
  RemovalRule draw(Random& random) const;
  /// `gain` >= 0, per unit of work, in any unit.
  void learn(RemovalRule rule, double gain);

 private:
  std::array<double, kRemovalRules> weights_ = {1, 1, 1, 1};
  double scale_ = 0;  ///< greatest recent gain, so that weights do not depend on units
};

}  // namespace sipplab
