// A reservation table as full as it gets: many disks at one place and time, slow ones, and late ones.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "property_tests/support/plain_twins.hpp"

namespace sipplab {
namespace {

constexpr std::int32_t kSide = 5;
constexpr double kRadius = 0.5;

Cell any_cell(Random& random) {
  return {static_cast<std::int32_t>(random.below(kSide)), static_cast<std::int32_t>(random.below(kSide))};
}

/// Between two cells or at one, begun in the same few seconds as all others or long after them.
MovingDisk any_disk(Random& random, double begin_s) {
  const Cell from = any_cell(random);
  const Cell to = any_cell(random);
  begin_s += static_cast<double>(random.below(16)) / 8;
  if (from == to) return MovingDisk::resting(centre(from), begin_s, begin_s + 1.5, kRadius);
  constexpr double kSpeeds[] = {1, 1, 1, 0.01};
  return MovingDisk::moving(Displacement(centre(from), centre(to)), begin_s,
                            begin_s + distance(from, to) / kSpeeds[random.below(4)], kRadius);
}

/// Whether all unit steps are answered as by looking at every disk, from times on at which there is
/// something.
void agrees_with_plain_twin(const ReservationTable& table, const PlainTable& twin, double begin_s) {
  for (std::int32_t y = 0; y < kSide; ++y) {
    for (std::int32_t x = 0; x + 1 < kSide; ++x) {
      const Move move(Displacement(centre({x, y}), centre({x + 1, y})), 1);
      for (const double from_s : {begin_s, begin_s + 1.25, begin_s + 40}) {
        EXPECT_EQ(table.earliest_departure(move, kRadius, from_s, kForever),
                  twin.earliest_departure(move, kRadius, from_s, kForever))
            << "(" << x << ", " << y << ") from " << from_s;
      }
    }
  }
}

TEST(ReservationTable, HoldsCrowdsAndLosesNobodyWhenSomeLeave) {
  constexpr double kLate = 1e5;  // beyond all slices of time
  const GridMap map(kSide, kSide);
  for (const double begin_s : {0.0, kLate}) {
    ReservationTable table(map, kRadius);
    Random random(7);
    std::vector<std::pair<ReservationTable::DiskId, MovingDisk>> added;
    const auto agree = [&] {
      PlainTable twin;
      for (const auto& [id, disk] : added) twin.disks.push_back(disk);
      agrees_with_plain_twin(table, twin, begin_s);
    };
    for (int i = 0; i < 80; ++i) {
      const MovingDisk disk = any_disk(random, begin_s);
      added.emplace_back(table.add(disk), disk);
    }
    agree();
    random.shuffle(added);
    while (!added.empty()) {
      for (std::size_t i = 0; i < 8; ++i, added.pop_back()) table.remove(added.back().first);
      agree();
    }
    EXPECT_EQ(table.safe_intervals({2, 2}, kRadius).size(), 1U);
  }
}

}  // namespace
}  // namespace sipplab
