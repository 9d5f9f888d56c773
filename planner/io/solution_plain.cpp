// Solutions in plain lines, `agent: (x,y,t) (x,y,t) ...`: see solution_io.hpp.
#include <limits>

#include "planner/io/solution_parts.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

constexpr const char* kLineWords = "a robot, a colon and its cells and times, such as '0: (3,4,0) (5,4,2)'";

struct Waypoint {
  Cell cell;
  double time_s = 0;
};

/// Cuts up to `end` off the text, `end` too; nothing where it is not there.
std::optional<std::string_view> cut(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view before = text.substr(0, at);
  text.remove_prefix(at + 1);
  return before;
}

std::optional<std::int32_t> coordinate(std::string_view text) {
  const auto number = parse_integer(trimmed(text));
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (!number || *number < -kMost || *number > kMost) return std::nullopt;
  return static_cast<std::int32_t>(*number);
}

/// "3, 4, 0.5".
std::optional<Waypoint> waypoint(std::string_view text) {
  const auto x = cut(text, ',');
  const auto y = x ? cut(text, ',') : std::nullopt;
  if (!y) return std::nullopt;
  const auto column = coordinate(*x);
  const auto row = coordinate(*y);
  const auto time_s = parse_real(trimmed(text));
  if (!column || !row || !time_s) return std::nullopt;
  return Waypoint{{*column, *row}, *time_s};
}

/// What stands between two waypoints: blanks, a comma, an arrow.
bool is_separator(std::string_view text) {
  text = trimmed(text);
  return text.empty() || text == "," || text == "->" || text == ";";
}

/// "agent 7" and "robot 7" are 7.
std::string_view robot_of(std::string_view text) {
  text = trimmed(text);
  for (const std::string_view word : {"agent", "Agent", "robot", "Robot"}) {
    if (text.substr(0, word.size()) == word && text.size() > word.size()) {
      return trimmed(text.substr(word.size()));
    }
  }
  return text;
}

/// The trajectory of the part behind the colon, or the piece that is none.
Expected<Trajectory, std::string> trajectory_of(std::string_view text) {
  Trajectory trajectory;
  std::optional<Waypoint> last;
  while (!is_separator(text)) {
    const auto before = cut(text, '(');
    if (!before || !is_separator(*before)) return Unexpected{std::string(trimmed(before.value_or(text)))};
    const auto inside = cut(text, ')');
    const auto next = inside ? waypoint(*inside) : std::nullopt;
    if (!next) return Unexpected{"(" + std::string(inside.value_or(text)) + (inside ? ")" : "")};
    if (last) {
      trajectory.motions.push_back({last->time_s, next->time_s, last->cell, next->cell});
    } else {
      trajectory.start = next->cell;
    }
    last = next;
  }
  if (!last) return Unexpected{std::string()};
  return trajectory;
}

bool is_plain_solution(std::string_view head) {
  std::string_view rest = trimmed(head.substr(0, head.find('\n')));
  return rest.substr(0, 1) == "#" || (cut(rest, ':') && trimmed(rest).substr(0, 1) == "(");
}

Input<SolutionDocument> parse_solution_plain(std::string_view text, const std::string& file_name,
                                             const Instance& instance) {
  const auto error = [&file_name](int line, std::string what, std::string expected) {
    return Unexpected{InputError{file_name, line, std::move(what), std::move(expected)}};
  };
  SolutionDocument document;
  TrajectoryCollector collector(instance);
  std::size_t position = 0;
  int number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    ++number;
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    const auto robot = cut(line, ':');
    if (!robot) return error(number, in_quotes(line), kLineWords);
    const Expected<Trajectory, std::string> trajectory = trajectory_of(line);
    if (!trajectory) return error(number, in_quotes(trajectory.error()), kLineWords);
    const std::string name(robot_of(*robot));
    const Cell start = trajectory->start;
    std::string problem = collector.add(name, position++, *trajectory, start);
    const auto place = problem.empty() ? std::nullopt : parse_integer(name);
    if (place && *place >= 0)
      problem = collector.add(std::nullopt, static_cast<std::size_t>(*place), *trajectory, start);
    if (!problem.empty()) return error(number, problem, "one line for each robot of the instance");
  }
  if (const auto missing = collector.missing()) {
    return error(number, "no line of robot " + in_quotes(instance.agents[*missing].id),
                 "one for each robot of the instance");
  }
  document.solution = collector.take();
  return document;
}

}  // namespace

SolutionFormat plain_format() {
  return {"lines", "0: (3,4,0) (5,4,2): cells and times", is_plain_solution, parse_solution_plain};
}

}  // namespace sipplab
