#include "planner/io/step_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "planner/io/csv_text.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

std::string place_text(Cell cell) { return fmt::format("({}, {})", cell.x, cell.y); }

}  // namespace

StepPlan::StepPlan(const Instance& instance)
    : instance_(instance), trajectories_(instance.agents.size()), last_step_(instance.agents.size(), -1) {
  if (!instance.agents.empty()) step_s_ = 0;
  for (const Agent& agent : instance.agents) step_s_ = std::max(step_s_, 1 / agent.speed_cells_per_s);
}

std::string StepPlan::add(std::size_t position, Cell cell, std::int64_t step) {
  if (position >= trajectories_.size()) {
    return fmt::format("robot {} for an instance of {} robots", position, trajectories_.size());
  }
  Trajectory& trajectory = trajectories_[position];
  std::int64_t& last = last_step_[position];
  if (step <= last) return fmt::format("robot {}: step {} after step {}", position, step, last);
  constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;
  if (step > kMostSteps) return fmt::format("robot {}: step {}", position, step);
  if (last < 0) {
    const Cell start = instance_.agents[position].start;
    if (cell != start) {
      return fmt::format("robot {} begins at {}, the instance has {}", position, place_text(cell),
                         place_text(start));
    }
    trajectory.start = cell;
    if (step > 0) trajectory.motions.push_back({0, static_cast<double>(step) * step_s_, cell, cell});
    last = step;
    return {};
  }
  const Cell here = trajectory.end();
  const std::int64_t columns = std::abs(std::int64_t{cell.x} - here.x);
  const std::int64_t rows = std::abs(std::int64_t{cell.y} - here.y);
  if (columns > 1 || rows > 1) {
    return fmt::format("robot {} jumps from {} to {} at step {}", position, place_text(here),
                       place_text(cell), step);
  }
  std::vector<TimedMotion>& motions = trajectory.motions;
  const auto wait_until = [&](std::int64_t end) {
    const double end_s = static_cast<double>(end) * step_s_;
    if (!motions.empty() && motions.back().is_wait()) {
      motions.back().end_s = end_s;
    } else {
      motions.push_back({static_cast<double>(last) * step_s_, end_s, here, here});
    }
  };
  if (cell == here) {
    wait_until(step);
  } else {
    if (step - 1 > last) wait_until(step - 1);
    motions.push_back(
        {static_cast<double>(step - 1) * step_s_, static_cast<double>(step) * step_s_, here, cell});
  }
  last = step;
  return {};
}

std::string StepPlan::missing() const {
  const auto found = std::find(last_step_.begin(), last_step_.end(), -1);
  if (found == last_step_.end()) return {};
  return fmt::format("nothing of robot {}", found - last_step_.begin());
}

std::optional<Cell> cut_pair(std::string_view& text) {
  const std::size_t comma = text.find(',');
  const std::size_t end = text.find(')');
  if (text.substr(0, 1) != "(" || end == std::string_view::npos || comma > end) return std::nullopt;
  const auto x = parse_integer(text.substr(1, comma - 1));
  const auto y = parse_integer(text.substr(comma + 1, end - comma - 1));
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (!x || !y || std::max(std::abs(*x), std::abs(*y)) > kMost) return std::nullopt;
  text.remove_prefix(end + 1);
  return Cell{static_cast<std::int32_t>(*x), static_cast<std::int32_t>(*y)};
}

void add_report(SolutionDocument& document, std::string_view name, std::string_view value) {
  const auto number = parse_real(value);
  name = trimmed(name);
  if (!number || name.empty() || !is_valid_utf8(name)) return;
  const auto is_same = [&](const auto& known) { return known.first == name; };
  if (std::none_of(document.reported.begin(), document.reported.end(), is_same)) {
    document.reported.emplace_back(name, *number);
  }
}

void add_report_table(SolutionDocument& document, std::string_view text) {
  constexpr std::size_t kMostColumns = 256;
  int line = 1;
  const std::vector<std::string> names = next_csv_record(text, line, kMostColumns).fields;
  std::vector<std::string> values;
  while (!text.empty()) {
    std::vector<std::string> fields = next_csv_record(text, line, kMostColumns).fields;
    if (fields.size() == names.size()) values = std::move(fields);
  }
  for (std::size_t i = 0; i < values.size(); ++i) add_report(document, names[i], values[i]);
}

}  // namespace sipplab
