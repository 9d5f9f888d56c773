// Buckets of disks; see disk_lookup.hpp.
#include "planner/instance/disk_lookup.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

bool disks_overlap(Cell a, double radius_a_cells, Cell b, double radius_b_cells) {
  return a == b || distance(a, b) < radius_a_cells + radius_b_cells - kTouchDepthCells;
}

std::uint64_t DiskLookup::bucket_key(std::int64_t column, std::int64_t row) {
  return static_cast<std::uint64_t>(column) << 32 ^ (static_cast<std::uint64_t>(row) & 0xffffffffu);
}

void DiskLookup::add(std::size_t id, Cell cell, double radius_cells) {
  PLANNER_ASSERT(radius_cells <= kMaxRadiusCells);
  int size_class = 0;
  while (size_class + 1 < kClasses && radius_cells > static_cast<double>(1 << size_class)) ++size_class;
  SizeClass& members = classes_[static_cast<std::size_t>(size_class)];
  // An arithmetic shift rounds towards minus infinity, also left of the map.
  const int shift = size_class + 1;
  members.buckets[bucket_key(cell.x >> shift, cell.y >> shift)].push_back(members.disks.size());
  members.disks.push_back({id, cell, radius_cells});
}

std::optional<std::size_t> DiskLookup::find_overlap(Cell cell, double radius_cells) const {
  std::optional<std::size_t> least;
  const auto look_at = [&](const Disk& disk) {
    if (disks_overlap(disk.cell, disk.radius_cells, cell, radius_cells) && (!least || disk.id < *least)) {
      least = disk.id;
    }
  };
  for (int size_class = 0; size_class < kClasses; ++size_class) {
    const SizeClass& members = classes_[static_cast<std::size_t>(size_class)];
    const int shift = size_class + 1;
    const auto reach =
        static_cast<std::int64_t>(std::ceil(radius_cells + static_cast<double>(1 << size_class)));
    const std::int64_t first_column = (cell.x - reach) >> shift;
    const std::int64_t last_column = (cell.x + reach) >> shift;
    const std::int64_t first_row = (cell.y - reach) >> shift;
    const std::int64_t last_row = (cell.y + reach) >> shift;
    const std::int64_t bucket_count = (last_column - first_column + 1) * (last_row - first_row + 1);
    if (bucket_count >= static_cast<std::int64_t>(members.disks.size())) {
      std::for_each(members.disks.begin(), members.disks.end(), look_at);
      continue;
    }
    for (std::int64_t row = first_row; row <= last_row; ++row) {
      for (std::int64_t column = first_column; column <= last_column; ++column) {
        const auto bucket = members.buckets.find(bucket_key(column, row));
        if (bucket == members.buckets.end()) continue;
        for (const std::size_t position : bucket->second) look_at(members.disks[position]);
      }
    }
  }
  return least;
}

}  // namespace sipplab
