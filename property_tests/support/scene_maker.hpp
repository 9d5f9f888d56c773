// Scenes for the validator: robots on random walks, right and wrong mixed.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "property_tests/support/symmetry.hpp"

namespace sipplab {

/// Robots that start where they like, make straight motions at their own speed and
/// waits of k/8 seconds, and whose goals are where they end. They may collide, run
/// over blocked cells and stick out of the map; that is for the validator to say.
/// `size` from 0 to 100 bounds map, robots and motions; one scene in five is wide, with
/// long motions.
Scene make_scene(int size, std::uint64_t seed);

/// Scenes that are simpler by one step: fewer robots, shorter walks, fewer
/// obstacles and blocked cells, default sizes.
std::vector<Scene> simpler_scenes(const Scene& scene);

/// Prints map, bodies and all motions.
std::ostream& operator<<(std::ostream& out, const Scene& scene);

}  // namespace sipplab
