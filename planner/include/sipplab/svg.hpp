// One picture of a solution: map, trajectories, starts, goals, dynamic obstacles,
// and what the validator found.
#pragma once

#include <string>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {

struct SvgOptions {
  std::string title = "Solution";
  std::string subtitle;  ///< one line under the title, such as makespan and flowtime
  /// Seconds of the plan in one second of a picture that moves; 0: a picture that stands
  /// still. A solution with times that are not finite, or run backwards, stands still.
  double animation_speed = 0;
};

/// A complete SVG document, legible from one robot to 10,000. An empty solution
/// shows the instance alone. Violations of the report are drawn with both bodies at
/// the time of deepest overlap.
std::string draw_svg(const Instance& instance, const Solution& solution, const ValidationReport& report = {},
                     const SvgOptions& options = {});

}  // namespace sipplab
