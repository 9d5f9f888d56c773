// What the validator found, in red.
#pragma once

#include <vector>

#include "planner/io/svg_paint.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {

/// What a picture of violations is about: one trajectory for each agent.
struct ViolationScene {
  const Instance& instance;
  const std::vector<Trajectory>& trajectories;
  const ValidationReport& report;
};

/// In the units of the world: for each violation both bodies at the time of deepest
/// overlap, a cross between them, and for the first ones a number and the pair.
void draw_violation_marks(SvgCanvas& canvas, const ViolationScene& scene);

/// In pixels: height of the list of messages; 0 without violations.
double violation_list_height_px(const ValidationReport& report);
/// The list itself, from this corner downwards.
void draw_violation_list(SvgCanvas& canvas, const ValidationReport& report, Vec2 corner_px);

}  // namespace sipplab
