// Which of many disks on cell centres overlap a given one, without testing all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "sipplab/grid_map.hpp"

namespace sipplab {

/// True when two open disks overlap. Overlap shallower than kTouchDepthCells counts
/// as touching; disks on one cell always overlap.
bool disks_overlap(Cell a, double radius_a_cells, Cell b, double radius_b_cells);

/// Disks in buckets, a grid of buckets for each size class of disks, so that one large disk does not slow
/// down the search among small ones.
class DiskLookup {
 public:
  /// REQUIRES: radius_cells <= kMaxRadiusCells.
  void add(std::size_t id, Cell cell, double radius_cells);

  /// The least id of a disk that overlaps this one.
  std::optional<std::size_t> find_overlap(Cell cell, double radius_cells) const;

 private:
  struct Disk {
    std::size_t id;
    Cell cell;
    double radius_cells;
  };
  /// Class k holds radii up to 2^k, in buckets of 2^(k+1) cells; 2^6 = kMaxRadiusCells.
  static constexpr int kClasses = 7;

  static std::uint64_t bucket_key(std::int64_t column, std::int64_t row);

  struct SizeClass {
    std::vector<Disk> disks;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> buckets;  // positions in `disks`
  };
  std::array<SizeClass, kClasses> classes_;
};

}  // namespace sipplab
