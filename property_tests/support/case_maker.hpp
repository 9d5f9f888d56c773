// Cases drawn from families that are known to be hard for a planner. Times, sizes
// and speeds come from lattices such as k/8: exact in a double, easy to draw.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/io/plan_case.hpp"

namespace sipplab {

enum class CaseFamily {
  kScattered,      ///< a few robots and blocked cells anywhere
  kDense,          ///< more than half of the cells hold a robot
  kCorridor,       ///< one cell wide, with bays to step aside
  kContactStarts,  ///< robots that touch each other at time 0
  kConvoy,         ///< a queue that moves on in contact
  kMixedBodies,    ///< small and large, slow and fast
};
inline constexpr int kCaseFamilies = 6;
std::string_view name(CaseFamily family);

/// A case that keeps the rules of find_error. `size` from 0 to 100 bounds map and
/// robots. The same seed gives the same case.
PlanCase make_case(CaseFamily family, int size, std::uint64_t seed);

/// The same case for robots with headings, and one time in four each with a delay, a
/// distance or a time to keep as well. Keeps the rules of find_error.
PlanCase with_motion_rules(PlanCase plan_case, std::uint64_t seed);

/// k/8 for a uniform k in 0 .. 8 * limit.
double draw_eighths(Random& random, std::uint64_t limit);
/// Uniform over the cells of a map.
Cell draw_cell(Random& random, const GridMap& map);
double draw_radius(Random& random);
double draw_speed(Random& random);
/// Degrees: mostly a direction of moves, now and then anything on a lattice.
double draw_heading(Random& random);
/// Half turns per second.
double draw_rotation_speed(Random& random);
/// None, or a heading.
std::optional<double> draw_goal_heading(Random& random);

}  // namespace sipplab
