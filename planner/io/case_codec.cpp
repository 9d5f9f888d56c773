// Cases as text and back; see case_codec.hpp.
#include "planner/io/case_codec.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <ostream>
#include <utility>
#include <vector>

#include "planner/core/number.hpp"

namespace sipplab {
namespace {

/// The words of one line, taken one after another.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  bool empty() {
    skip_blanks();
    return rest_.empty();
  }
  std::string_view next() {
    skip_blanks();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  template <class Number>
  bool read(Number& number) {
    const std::optional<Number> value = parse_number<Number>(next());
    if (value) number = *value;
    return value.has_value();
  }
  bool read(Cell& cell) { return read(cell.x) && read(cell.y); }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size())); }

  std::string_view rest_;
};

bool read_robot(Words& words, Instance& instance) {
  Agent agent;
  agent.id = std::to_string(instance.agents.size());
  if (!words.read(agent.start) || words.next() != "to" || !words.read(agent.goal)) return false;
  while (!words.empty()) {
    const std::string_view word = words.next();
    if (word == "radius" && words.read(agent.radius_cells)) continue;
    if (word == "speed" && words.read(agent.speed_cells_per_s)) continue;
    if (word == "heading" && words.read(agent.start_heading_deg)) continue;
    if (word == "goal-heading" && words.read(agent.goal_heading_deg.emplace())) continue;
    if (word == "rotation" && words.read(agent.rotation_speed)) continue;
    return false;
  }
  instance.agents.push_back(std::move(agent));
  return instance.agents.size() <= kMaxCaseRobots;
}

bool read_obstacle(Words& words, Instance& instance) {
  DynamicObstacle obstacle;
  obstacle.id = std::to_string(instance.obstacles.size());
  Trajectory& trajectory = obstacle.trajectory;
  if (!words.read(trajectory.start)) return false;
  while (!words.empty()) {
    const std::string_view word = words.next();
    if (word == "radius" && words.read(obstacle.radius_cells)) continue;
    TimedMotion motion{trajectory.end_s(), 0, trajectory.end(), {}};
    if (word != "until" || !words.read(motion.end_s) || words.next() != "at" || !words.read(motion.to))
      return false;
    trajectory.motions.push_back(motion);
    if (trajectory.motions.size() > kMaxCaseMotions) return false;
  }
  instance.obstacles.push_back(std::move(obstacle));
  return instance.obstacles.size() <= kMaxCaseObstacles;
}

/// Wall clocks and threads are left out: plans of a case can be repeated anywhere.
bool is_of_a_case(const Option& option) {
  return option.name != std::string_view("time-limit") && *option.json != '\0';
}

bool read_option(std::string_view name, Words& words, PlannerOptions& options, OptionRows table) {
  const Option* option = find_option(name, table);
  return option != nullptr && is_of_a_case(*option) && option->set(options, words.next());
}

std::optional<GridMap> make_map(const std::vector<std::string_view>& rows) {
  if (rows.empty() || rows.size() > kMaxCaseSide || rows[0].size() > kMaxCaseSide) return std::nullopt;
  GridMap map(static_cast<std::int32_t>(rows[0].size()), static_cast<std::int32_t>(rows.size()));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    if (rows[y].size() != rows[0].size()) return std::nullopt;
    for (std::size_t x = 0; x < rows[y].size(); ++x) {
      map.set_blocked({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, rows[y][x] == '@');
    }
  }
  return map;
}

std::string text(double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  return {digits, end};
}

std::string text(Cell cell) { return std::to_string(cell.x) + ' ' + std::to_string(cell.y); }

}  // namespace

std::optional<PlanCase> decode_case(std::string_view input, OptionRows table) {
  PlanCase plan_case;
  plan_case.options.time_limit_s = std::numeric_limits<double>::infinity();
  std::vector<std::string_view> rows;
  bool in_map = true;
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size());
    std::string_view line = input.substr(0, end);
    input.remove_prefix(std::min(end + 1, input.size()));
    line = line.substr(0, line.find('#'));
    Words words(line);
    if (words.empty()) continue;

    const std::string_view first = words.next();
    if (in_map && first.find_first_not_of(".@") == std::string_view::npos) {
      rows.push_back(first);
    } else {
      in_map = false;
      const bool understood = first == "robot"      ? read_robot(words, plan_case.instance)
                              : first == "obstacle" ? read_obstacle(words, plan_case.instance)
                                                    : read_option(first, words, plan_case.options, table);
      if (!understood) return std::nullopt;
    }
    if (!words.empty()) return std::nullopt;
  }
  auto map = make_map(rows);
  if (!map) return std::nullopt;
  plan_case.instance.map = std::move(*map);
  // plan_by_ejection() requires otherwise.
  const PlannerOptions& options = plan_case.options;
  if (options.rescheduling == Rescheduling::kEjection && options.rules.inflates()) return std::nullopt;
  return plan_case;
}

std::string encode_case(const PlanCase& plan_case, OptionRows table) {
  const auto& [instance, options] = plan_case;
  std::string out;
  for (std::int32_t y = 0; y < instance.map.height(); ++y) {
    for (std::int32_t x = 0; x < instance.map.width(); ++x)
      out += instance.map.is_blocked({x, y}) ? '@' : '.';
    out += '\n';
  }
  for (const Agent& agent : instance.agents) {
    out += "robot " + text(agent.start) + " to " + text(agent.goal);
    if (agent.radius_cells != kDefaultRadiusCells) out += " radius " + text(agent.radius_cells);
    if (agent.speed_cells_per_s != kDefaultSpeedCellsPerS) out += " speed " + text(agent.speed_cells_per_s);
    if (agent.start_heading_deg != 0) out += " heading " + text(agent.start_heading_deg);
    if (agent.goal_heading_deg) out += " goal-heading " + text(*agent.goal_heading_deg);
    if (agent.rotation_speed != kDefaultRotationSpeed) out += " rotation " + text(agent.rotation_speed);
    out += '\n';
  }
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    out += "obstacle " + text(obstacle.trajectory.start) + " radius " + text(obstacle.radius_cells);
    for (const TimedMotion& motion : obstacle.trajectory.motions) {
      out += " until " + text(motion.end_s) + " at " + text(motion.to);
    }
    out += '\n';
  }
  for (const Option& option : table) {
    if (is_of_a_case(option) && is_told(option, options)) {
      out += std::string(option.name) + ' ' + option.get(options) + '\n';
    }
  }
  return out;
}

std::ostream& operator<<(std::ostream& out, const PlanCase& plan_case) {
  return out << '\n' << encode_case(plan_case);
}

}  // namespace sipplab
