// Plans in discrete time, as programs write them that let all robots step at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/solution_io.hpp"

namespace sipplab {

/// Collects the cells of each robot, step after step, and checks them against the instance. A step lasts as
/// long as the slowest robot needs for a cell.
class StepPlan {
 public:
  explicit StepPlan(const Instance& instance);

  std::size_t robots() const { return trajectories_.size(); }
  /// Robot number `position` is at this cell at step `step`; if steps were passed over, it waited first.
  /// Empty, or what is wrong: another start than the instance has, a jump, no such robot, a step that is not
  /// later.
  std::string add(std::size_t position, Cell cell, std::int64_t step);
  /// At the next step.
  std::string add(std::size_t position, Cell cell) { return add(position, cell, next_step(position)); }
  std::int64_t next_step(std::size_t position) const {
    return position < last_step_.size() ? last_step_[position] + 1 : 0;
  }
  Cell at(std::size_t position) const { return trajectories_[position].end(); }
  /// Empty, or which robot nothing was said of.
  std::string missing() const;
  Solution take() { return Solution{std::move(trajectories_)}; }

 private:
  const Instance& instance_;
  double step_s_ = 1;
  std::vector<Trajectory> trajectories_;
  std::vector<std::int64_t> last_step_;  ///< -1: none
};

/// A pair of whole numbers in parentheses, "(3,4)", cut off the text; nothing, and the text as it was, where
/// it does not begin with one.
std::optional<Cell> cut_pair(std::string_view& text);

/// What a program says of its own run: a finite number, kept under the program's name for it. Others are
/// passed over.
void add_report(SolutionDocument& document, std::string_view name, std::string_view value);
/// The numbers of a table in CSV, names in the first line, and the values of its last one.
void add_report_table(SolutionDocument& document, std::string_view text);

}  // namespace sipplab
