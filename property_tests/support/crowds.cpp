#include "property_tests/support/crowds.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "planner/core/random.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab {
namespace {

/// A few cells, and on most of them robots whose goals are among these cells.
PlanCase make_crowd(std::uint64_t seed) {
  Random random(seed);
  const auto upto = [&random](std::uint64_t most) {
    return 1 + static_cast<std::int32_t>(random.below(most));
  };
  PlanCase plan_case;
  GridMap& map = plan_case.instance.map;
  map = GridMap(1 + upto(3), upto(3));
  std::vector<std::size_t> cells(map.cell_count());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  random.shuffle(cells);
  const std::size_t free_cells = std::min<std::size_t>(cells.size(), 2 + random.below(6));
  for (std::size_t i = free_cells; i < cells.size(); ++i) map.set_blocked(map.cell(cells[i]), true);
  cells.resize(free_cells);
  std::vector<std::size_t> goals = cells;
  random.shuffle(goals);
  const std::size_t robots = free_cells - std::min<std::size_t>(free_cells, random.below(4));
  // In half of the cases bodies of all sizes that the planner takes; in half of those slow or fast ones.
  constexpr std::array<double, 4> kRadii = {0.5, 0.375, 0.25, 0.125};
  constexpr std::array<double, 4> kSpeeds = {1, 1, 0.5, 2};
  const bool are_equal = random.one_in(2);
  const double speed = are_equal ? 1 : kSpeeds[random.below(kSpeeds.size())];
  for (std::size_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = map.cell(cells[i]);
    agent.goal = map.cell(goals[i]);
    agent.speed_cells_per_s = speed;
    if (!are_equal) agent.radius_cells = kRadii[random.below(kRadii.size())];
    plan_case.instance.agents.push_back(agent);
  }
  constexpr std::array<double, 4> kSsis = {0, 2.5, 5, kInfiniteSsi};
  plan_case.options.ssi_s = kSsis[random.below(kSsis.size())];
  plan_case.options.seed = random.next();
  return plan_case;
}

}  // namespace

PlanCase any_crowd() {
  PlanCase plan_case = make_crowd(at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); }));
  RC_PRE(pebble_search_is_small(plan_case.instance));
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

}  // namespace sipplab
