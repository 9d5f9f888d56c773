#include "planner/grid/neighbourhood.hpp"

#include <array>
#include <cstdint>

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

constexpr std::array<Cell, 32> kNeighbours = {{
    {1, 0},   {0, 1},   {-1, 0},  {0, -1},                                         // k = 2
    {1, 1},   {-1, 1},  {-1, -1}, {1, -1},                                         // k = 3
    {2, 1},   {1, 2},   {-1, 2},  {-2, 1},  {-2, -1}, {-1, -2}, {1, -2}, {2, -1},  // k = 4
    {3, 1},   {3, 2},   {2, 3},   {1, 3},   {-1, 3},  {-2, 3},  {-3, 2}, {-3, 1},  // k = 5
    {-3, -1}, {-3, -2}, {-2, -3}, {-1, -3}, {1, -3},  {2, -3},  {3, -2}, {3, -1},
}};

}  // namespace

std::span<const Cell> neighbourhood(int k) {
  PLANNER_ASSERT(k >= kMinConnectedness && k <= kMaxConnectedness);
  return std::span(kNeighbours).first(std::size_t{1} << k);
}

double distance_in_sectors(std::int64_t x, std::int64_t y, int k) {
  PLANNER_ASSERT(k >= kMinConnectedness && k <= kMaxConnectedness);
  // In the first octant the displacement lies between two neighbouring directions
  // lo = (1, 0) and hi = (1, 1) that span the lattice; their sum splits the sector for
  // the next k. A displacement is i lo + j hi with integers i and j.
  Cell lo{1, 0};
  Cell hi{1, 1};
  for (int split = 3; split < k; ++split) {
    const Cell middle{lo.x + hi.x, lo.y + hi.y};
    const bool below = y * middle.x < x * middle.y;
    (below ? hi : lo) = middle;
  }
  // Cramer's rule; the determinant of lo and hi is 1.
  const std::int64_t along_lo = x * hi.y - y * hi.x;
  const std::int64_t along_hi = lo.x * y - lo.y * x;
  return static_cast<double>(along_lo) * norm(centre(lo)) + static_cast<double>(along_hi) * norm(centre(hi));
}

}  // namespace sipplab
