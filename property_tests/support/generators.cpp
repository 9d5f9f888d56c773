// Cases and scenes for rapidcheck; see generators.hpp.
#include "property_tests/support/generators.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "planner/core/tolerances.hpp"
#include "planner/options/option_table.hpp"
#include "property_tests/support/case_shrinker.hpp"

namespace sipplab {
namespace {

/// Uniform over [0, end), at every size: rapidcheck narrows ranges when sizes are
/// small, and a few seeds would come again and again. Shrinking a seed is no use.
template <class Number>
rc::Gen<Number> any_below(Number end) {
  return rc::gen::noShrink(rc::gen::resize(rc::kNominalSize, rc::gen::inRange<Number>(0, end)));
}

rc::Gen<std::uint64_t> any_seed() { return any_below(std::uint64_t{1} << 48); }

rc::Gen<PlanCase> shrinking(rc::Gen<PlanCase> cases) {
  return rc::gen::shrink(std::move(cases), [](const PlanCase& plan_case) {
    return rc::seq::fromContainer(simpler_cases(plan_case));
  });
}

/// Of all families, without shrinking.
rc::Gen<PlanCase> any_plain_case() {
  return rc::gen::withSize([](int size) {
    return rc::gen::apply(
        [size](int family, std::uint64_t seed) {
          return make_case(static_cast<CaseFamily>(family), size, seed);
        },
        any_below(kCaseFamilies), any_seed());
  });
}

bool has_touching_starts(const Instance& instance) {
  for (std::size_t i = 0; i < instance.agents.size(); ++i) {
    for (std::size_t j = i + 1; j < instance.agents.size(); ++j) {
      const Agent& a = instance.agents[i];
      const Agent& b = instance.agents[j];
      const double clearance = distance(a.start, b.start) - a.radius_cells - b.radius_cells;
      if (std::abs(clearance) <= kTouchDepthCells) return true;
    }
  }
  return false;
}

}  // namespace

rc::Gen<PlanCase> any_case() { return shrinking(any_plain_case()); }

rc::Gen<PlanCase> any_turning_case() {
  return shrinking(rc::gen::apply(
      [](PlanCase plan_case, std::uint64_t seed) { return with_motion_rules(std::move(plan_case), seed); },
      any_plain_case(), any_seed()));
}

rc::Gen<PlanCase> any_case_of(CaseFamily family) {
  return shrinking(rc::gen::withSize([family](int size) {
    return rc::gen::map(any_seed(),
                        [family, size](std::uint64_t seed) { return make_case(family, size, seed); });
  }));
}

rc::Gen<Scene> any_scene() {
  return rc::gen::shrink(rc::gen::withSize([](int size) {
                           return rc::gen::map(any_seed(),
                                               [size](std::uint64_t seed) { return make_scene(size, seed); });
                         }),
                         [](const Scene& scene) { return rc::seq::fromContainer(simpler_scenes(scene)); });
}

void classify_case(const PlanCase& plan_case) {
  const Instance& instance = plan_case.instance;
  const auto& agents = instance.agents;
  const std::size_t free_cells = instance.map.cell_count() - instance.map.blocked_count();
  const auto differs = [&](auto member) {
    return std::any_of(agents.begin(), agents.end(),
                       [&](const Agent& agent) { return agent.*member != agents[0].*member; });
  };
  RC_CLASSIFY(agents.empty(), "no robots");
  RC_CLASSIFY(2 * agents.size() >= free_cells, "dense");
  RC_CLASSIFY(has_touching_starts(instance), "contact starts");
  RC_CLASSIFY(differs(&Agent::radius_cells), "mixed radii");
  RC_CLASSIFY(differs(&Agent::speed_cells_per_s), "mixed speeds");
  RC_CLASSIFY(!instance.obstacles.empty(), "moving obstacles");
  RC_CLASSIFY(plan_case.options.ssi_s != std::floor(plan_case.options.ssi_s), "fractional ssi");
  RC_CLASSIFY(std::isinf(plan_case.options.ssi_s), "infinite ssi");
  RC_CLASSIFY(plan_case.options.weight > 1, "weighted heuristic");
  const MotionRules& rules = plan_case.options.rules;
  if (rules.is_plain()) return;
  RC_CLASSIFY(rules.turns, "turns");
  RC_CLASSIFY(rules.wait_before_move_s > 0, "delays");
  RC_CLASSIFY(rules.inflate_distance_cells > 0, "inflated distance");
  RC_CLASSIFY(rules.inflate_time_s > 0, "inflated time");
}

}  // namespace sipplab
