// The steps of a neighbourhood that a disk can make from each cell of one map.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/grid/line_of_sight.hpp"
#include "planner/grid/neighbourhood.hpp"

namespace sipplab {

class StepTable {
 public:
  /// Cells. The largest radius for which a step to one of eight neighbours is clear if and only if all
  /// cells that it touches are free.
  static constexpr double kCellRadius = 0.5;

  /// For the 2^k neighbourhood. `line_of_sight` must outlive the table.
  StepTable(const LineOfSight& line_of_sight, std::size_t cell_count, int k)
      : line_of_sight_(line_of_sight), steps_(neighbourhood(k)), clear_(cell_count, kUnknown) {}

  /// Bit i is set if neighbourhood(k)[i] leads to a legal cell in line of sight. Computed
  /// on first use. REQUIRES: the cell is legal; `index` is its row-major index.
  std::uint32_t clear_steps(Cell cell, std::size_t index) {
    if (clear_[index] == kUnknown) clear_[index] = find_clear_steps(cell);
    return static_cast<std::uint32_t>(clear_[index]);
  }

 private:
  static constexpr std::uint64_t kUnknown = UINT64_MAX;
  static constexpr std::size_t kStraight = 4;

  std::uint64_t find_clear_steps(Cell cell) const {
    std::uint64_t clear = 0;
    if (line_of_sight_.radius_cells() <= kCellRadius && steps_.size() <= 2 * kStraight) {
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        const auto is_free = [&](std::size_t step) {
          return line_of_sight_.is_legal({cell.x + steps_[step].x, cell.y + steps_[step].y});
        };
        // Each of the other four lies between two of the straight ones.
        const bool is_clear = is_free(i) && (i < kStraight || ((clear >> (i - kStraight) & 1) != 0 &&
                                                               (clear >> ((i + 1) % kStraight) & 1) != 0));
        if (is_clear) clear |= std::uint64_t{1} << i;
      }
      return clear;
    }
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const Cell next{cell.x + steps_[i].x, cell.y + steps_[i].y};
      if (line_of_sight_.is_legal(next) && line_of_sight_.is_clear(cell, next))
        clear |= std::uint64_t{1} << i;
    }
    return clear;
  }

  const LineOfSight& line_of_sight_;
  std::span<const Cell> steps_;
  std::vector<std::uint64_t> clear_;
};

}  // namespace sipplab
