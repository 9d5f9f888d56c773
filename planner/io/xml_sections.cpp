// <section> lists: see xml_sections.hpp.
#include "planner/io/xml_sections.hpp"

#include <cmath>
#include <limits>

#include "planner/grid/heading.hpp"

namespace sipplab {
namespace {

using pugi::xml_node;

/// Relative. The published planner writes durations as 32-bit floats, rounded to
/// 24 binary and then to 8 decimal digits.
constexpr double kPublishedRounding = 2e-7;

constexpr NumberRange kDurations{0, std::numeric_limits<double>::max(), "seconds from 0"};
constexpr NumberRange kAnyNumber{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "a number"};

/// Degrees. The same for headings, which are at most 360.
constexpr double kPublishedRoundingDeg = kPublishedRounding * kFullTurnDeg;

double without_rounding(double stated, double exact, double rounding) {
  return std::abs(stated - exact) <= rounding ? exact : stated;
}

/// The headings of the robot that makes the sections, one section after another.
class HeadingReader {
 public:
  HeadingReader(XmlReader& reader, const SectionOptions& options)
      : reader_(reader), robot_(options.robot), now_deg_(robot_ ? robot_->start_heading_deg : 0) {}

  /// Sets what the section says of a turn; returns the angle of the turn in degrees.
  double read(xml_node section, bool exact, TimedMotion& motion) {
    const auto from_deg = reader_.optional_real(section, "start.heading", kAnyNumber);
    const auto to_deg = reader_.optional_real(section, "goal.heading", kAnyNumber);
    if (!robot_) return 0;
    const double before_deg = now_deg_;
    if (!motion.is_wait()) {
      now_deg_ = heading_deg(motion.from, motion.to);
    } else if (from_deg && to_deg && (*from_deg != *to_deg || section.attribute("turn"))) {
      now_deg_ = exact ? *to_deg : meant_by(section, *to_deg);
      motion.turn_to_deg = now_deg_;
    }
    return turn_deg(before_deg, now_deg_);
  }

 private:
  /// The heading after this section: that of the next move, or the goal's, where it is
  /// written down rounded.
  double meant_by(xml_node section, double stated_deg) {
    const xml_node next = section.next_sibling("section");
    if (!next) {
      return without_rounding(stated_deg, robot_->goal_heading_deg.value_or(stated_deg),
                              kPublishedRoundingDeg);
    }
    const Cell from = read_cell(reader_, next, "start.x", "start.y");
    const Cell to = read_cell(reader_, next, "goal.x", "goal.y");
    return from == to ? stated_deg
                      : without_rounding(stated_deg, heading_deg(from, to), kPublishedRoundingDeg);
  }

  XmlReader& reader_;
  const Agent* robot_;
  double now_deg_;
};

/// How long the section takes, in seconds.
double duration_s(const TimedMotion& motion, double stated_s, double turned_deg,
                  const SectionOptions& options) {
  double exact_s = stated_s;
  if (motion.is_turn()) {
    exact_s = turned_deg / (kHalfTurnDeg * options.robot->rotation_speed);
  } else if (!motion.is_wait() && options.speed_cells_per_s) {
    exact_s = distance(motion.from, motion.to) / *options.speed_cells_per_s;
  }
  return without_rounding(stated_s, exact_s, kPublishedRounding * exact_s);
}

}  // namespace

Cell read_cell(XmlReader& reader, xml_node node, const char* x, const char* y) {
  return {reader.required_integer(node, x), reader.required_integer(node, y)};
}

Trajectory read_sections(XmlReader& reader, xml_node node, const SectionOptions& options) {
  Trajectory trajectory;
  const SectionNames& names = options.names;
  double now_s = 0;
  std::optional<Cell> at;
  HeadingReader headings(reader, options);
  for (const xml_node section : node.children("section")) {
    reader.expect_only_attributes(
        section,
        {"id", "number", names.start_x, names.start_y, "start.heading", names.goal_x, names.goal_y,
         "goal.heading", "duration", "begin", "end", "turn"},
        XmlReader::Others::kIgnored);
    TimedMotion motion;
    motion.from = read_cell(reader, section, names.start_x, names.start_y);
    motion.to = read_cell(reader, section, names.goal_x, names.goal_y);
    const bool exact = section.attribute("begin") && section.attribute("end");
    const double turned_deg = headings.read(section, exact, motion);
    const NumberRange& times = exact && options.only_form ? kAnyNumber : kDurations;
    const double stated_s = reader.required_real(section, "duration", times);
    motion.begin_s = exact ? reader.required_real(section, "begin", times) : now_s;
    motion.end_s = exact ? reader.required_real(section, "end", times)
                         : now_s + duration_s(motion, stated_s, turned_deg, options);
    if (at && *at != motion.from && !options.only_form) {
      reader.fail(
          section,
          "a <section> that begins at (" + std::to_string(motion.from.x) + ", " +
              std::to_string(motion.from.y) + ")",
          "the end of the one before, (" + std::to_string(at->x) + ", " + std::to_string(at->y) + ")");
    }
    if (!motion.is_wait() && !(motion.end_s > motion.begin_s) && !options.only_form) {
      reader.fail(section, "a <section> that changes place in no time", "a duration above 0");
    }
    if (!std::isfinite(motion.end_s)) {
      reader.fail(section, "durations that sum up to infinity", "a finite time");
    }
    if (!reader.failed() && !options.only_form &&
        (motion.begin_s != now_s || motion.end_s < motion.begin_s)) {
      reader.fail(
          section,
          "a <section> from " + format_real(motion.begin_s) + " to " + format_real(motion.end_s) + " s",
          "one that follows the section before, from " + format_real(now_s) + " s on");
    }
    if (reader.failed()) return trajectory;
    if (!at) trajectory.start = motion.from;
    at = motion.to;
    now_s = motion.end_s;
    const bool says_nothing =
        !options.only_form && motion.is_wait() && !motion.is_turn() && motion.end_s == motion.begin_s;
    if (!says_nothing) trajectory.motions.push_back(motion);
  }
  return trajectory;
}

}  // namespace sipplab
