#include "sipplab/grid_map.hpp"

#include <algorithm>

namespace sipplab {

std::string GridMap::check_size(std::int64_t width, std::int64_t height) {
  const auto fits = [](std::int64_t side) { return side >= 1 && side <= kMaxSide; };
  if (fits(width) && fits(height)) return {};
  return "map of " + std::to_string(width) + " x " + std::to_string(height) + " cells, expected 1 to " +
         std::to_string(kMaxSide) + " along each side";
}

GridMap::GridMap(std::int32_t width, std::int32_t height) : width_(width), height_(height) {
  PLANNER_ASSERT(check_size(width, height).empty());
  blocked_.assign(cell_count(), 0);
}

std::size_t GridMap::blocked_count() const {
  return static_cast<std::size_t>(
      std::count_if(blocked_.begin(), blocked_.end(), [](auto cell) { return cell != 0; }));
}

}  // namespace sipplab
