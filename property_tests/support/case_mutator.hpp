// Cases changed at random: what fuzzers climb with. A change keeps the rules of instances,
// so that nearly every input of a target is a problem and reaches the planner.
#pragma once

#include <cstddef>
#include <cstdint>

#include "planner/core/random.hpp"
#include "planner/io/plan_case.hpp"

namespace sipplab {

/// How large a mutated case may become, and what planning it may cost: a target plans each
/// input several times and has to try a thousand in a second.
inline constexpr std::int32_t kMutatedSide = 7;
inline constexpr std::size_t kMutatedRobots = 5;
inline constexpr std::size_t kMutatedObstacles = 3;
inline constexpr std::size_t kMutatedMotions = 5;
inline constexpr std::uint64_t kMutatedExpansions = 600;
inline constexpr std::uint64_t kMutatedRestarts = 12;

/// Whether the case is within these bounds (its limits are not looked at).
bool is_small_case(const PlanCase& plan_case);

/// One to four changes: robots, goals, sizes, speeds, the map, obstacles, options; seldom a
/// fresh case. Keeps the rules of find_error and the bounds above. The same `random` gives
/// the same case.
PlanCase mutate_case(const PlanCase& plan_case, Random& random);

/// A case with the map of one and robots, obstacles and options from both.
PlanCase cross_cases(const PlanCase& one, const PlanCase& other, Random& random);

}  // namespace sipplab
