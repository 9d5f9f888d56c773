// Movement in the picture, as SMIL: browsers play it, no script is involved.
#pragma once

#include <string>

#include "planner/io/svg_paint.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// When a picture plays which moment. It begins at time 0, rests at the end, and begins again.
class SvgClock {
 public:
  /// `end_s`: the last moment at which something moves; `speed`: seconds of the plan in one
  /// of the picture, > 0.
  SvgClock(double end_s, double speed);

  double end_s() const { return end_s_; }
  /// Share of a round at which this moment is shown, within [0, 1].
  double share(double time_s) const;
  /// ` dur="..." repeatCount="indefinite"`, for any element that animates.
  const std::string& attributes() const { return attributes_; }

 private:
  double end_s_;
  double round_s_;  ///< of the plan, the rest at the end included
  std::string attributes_;
};

/// An element that moves its parent along the trajectory; if the clock does not play, the
/// parent is moved by nothing. REQUIRES: times that are finite and do not run backwards.
void draw_movement(SvgCanvas& canvas, const Trajectory& trajectory, const SvgClock& clock);

/// An element that widens its parent from nothing to `width` while the plan lasts.
void draw_progress(SvgCanvas& canvas, double width, const SvgClock& clock);

}  // namespace sipplab
