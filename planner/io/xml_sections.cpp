// <section> lists: see xml_sections.hpp.
#include "planner/io/xml_sections.hpp"

#include <cmath>
#include <limits>

namespace sipplab {
namespace {

using pugi::xml_node;

/// Relative. The published planner writes durations as 32-bit floats, rounded to
/// 24 binary and then to 8 decimal digits.
constexpr double kPublishedRounding = 2e-7;

constexpr NumberRange kDurations{0, std::numeric_limits<double>::max(), "seconds from 0"};
constexpr NumberRange kAnyNumber{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "a number"};

/// How long the section takes, in seconds.
double duration_s(const TimedMotion& motion, double stated_s, const SectionOptions& options) {
  if (motion.is_wait() || !options.speed_cells_per_s) return stated_s;
  const double exact_s = distance(motion.from, motion.to) / *options.speed_cells_per_s;
  return std::abs(stated_s - exact_s) <= kPublishedRounding * exact_s ? exact_s : stated_s;
}

}  // namespace

Trajectory read_sections(XmlReader& reader, xml_node node, const SectionOptions& options) {
  Trajectory trajectory;
  double now_s = 0;
  std::optional<Cell> at;
  for (const xml_node section : node.children("section")) {
    reader.expect_only_attributes(section, {"id", "start.x", "start.y", "start.heading", "goal.x", "goal.y",
                                            "goal.heading", "duration", "begin", "end"});
    TimedMotion motion;
    motion.from = {reader.required_integer(section, "start.x"), reader.required_integer(section, "start.y")};
    motion.to = {reader.required_integer(section, "goal.x"), reader.required_integer(section, "goal.y")};
    reader.optional_real(section, "start.heading", kAnyNumber);
    reader.optional_real(section, "goal.heading", kAnyNumber);
    const bool exact = section.attribute("begin") && section.attribute("end");
    const NumberRange& times = exact && options.only_form ? kAnyNumber : kDurations;
    const double stated_s = reader.required_real(section, "duration", times);
    motion.begin_s = exact ? reader.required_real(section, "begin", times) : now_s;
    motion.end_s =
        exact ? reader.required_real(section, "end", times) : now_s + duration_s(motion, stated_s, options);
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
    const bool says_nothing = motion.is_wait() && motion.end_s == motion.begin_s;
    if (!says_nothing) trajectory.motions.push_back(motion);
  }
  return trajectory;
}

}  // namespace sipplab
