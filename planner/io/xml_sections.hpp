// <section> lists, in which AA-SIPP(m)'s XML writes trajectories of dynamic obstacles
// and of solutions.
#pragma once

#include <optional>

#include "planner/io/xml_reader.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// How attributes of a <section> are called.
struct SectionNames {
  const char* start_x;
  const char* start_y;
  const char* goal_x;
  const char* goal_y;
};
inline constexpr SectionNames kPlaces{"start.x", "start.y", "goal.x", "goal.y"};
/// Those of Continuous-CBS.
inline constexpr SectionNames kRowsAndColumns{"start_j", "start_i", "goal_j", "goal_i"};

struct SectionOptions {
  /// Speed of the robot that made the sections, in cells per second. Sections
  /// without exact times whose duration is length / speed to within the published
  /// format's rounding get exactly that duration.
  std::optional<double> speed_cells_per_s;
  /// Take sections that do not join, that change place or wait in no time: for a
  /// solution, which the validator will judge.
  bool only_form = false;
  /// The robot that made the sections: those that stay in place between two different
  /// headings are turns. Without exact times, a heading that is the next direction (or the
  /// goal heading) to within rounding becomes just that, and a duration likewise. None:
  /// headings are passed over.
  const Agent* robot = nullptr;
  SectionNames names = kPlaces;
};

/// The cell in two attributes; a missing one is an error.
Cell read_cell(XmlReader& reader, pugi::xml_node node, const char* x, const char* y);

/// The trajectory that the <section> children of `node` tell of, from time 0. Their
/// durations are summed up, unless they carry begin and end, exact times that only
/// our own files have. Waits that take no time are dropped. Errors go to the
/// reader: values that do not parse, a negative duration, and, unless only the form
/// counts, places that do not join and a change of place in no time.
Trajectory read_sections(XmlReader& reader, pugi::xml_node node, const SectionOptions& options);

}  // namespace sipplab
