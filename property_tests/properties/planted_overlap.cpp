// The validator finds every planted overlap, with pair, time and depth, and lets touching
// pass. Depths come from radii: on a grid two paths are whole numbers of cells apart.
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>

#include "property_tests/support/property.hpp"
#include "property_tests/support/scene_maker.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::planted_overlap_laws {
namespace {

/// Cells. Rounding of a depth that was planted through a sum of radii.
constexpr double kDepthRounding = 1e-12;

enum class Meeting { kPassing, kAtAGoalForEver, kAtTheStart };

struct Planted {
  Scene scene;
  double time_s = 0;  ///< of the deepest overlap
};

/// Robot 0 rests next to row 0, on which robot 1 passes, ends or begins.
Planted plant(Meeting meeting, double depth_cells) {
  const int apart = *rc::gen::element(1, 2);
  const int length = *rc::gen::element(2, 4, 6, 12);
  const double share = *rc::gen::element(0.5, 0.25, 0.75);
  const double wait_s = *rc::gen::element(0.0, 0.125, 3.0, 250.0);
  Planted planted;
  Instance& instance = planted.scene.instance;
  instance.map = GridMap(length + 10, apart + 10);
  constexpr std::int32_t kMargin = 5;  // no body leaves the grid
  instance.agents.resize(2);
  Agent& rests = instance.agents[0];
  Agent& drives = instance.agents[1];
  rests.radius_cells = share * apart;
  drives.radius_cells = (1 - share) * apart + depth_cells;
  drives.start = {kMargin, kMargin};
  drives.goal = {kMargin + length, kMargin};
  const int along = meeting == Meeting::kPassing ? length / 2 : meeting == Meeting::kAtTheStart ? 0 : length;
  rests.start = rests.goal = {kMargin + along, kMargin + apart};
  planted.time_s = meeting == Meeting::kAtTheStart ? 0 : wait_s + along;

  Trajectory path{drives.start, {}};
  if (wait_s > 0) path.motions.push_back({0, wait_s, drives.start, drives.start});
  path.motions.push_back({wait_s, wait_s + length, drives.start, drives.goal});
  planted.scene.solution.trajectories = {{rests.start, {}}, path};
  return planted;
}

Meeting any_meeting() {
  return *rc::gen::element(Meeting::kPassing, Meeting::kAtAGoalForEver, Meeting::kAtTheStart);
}

const PropertyRoom room("planted_overlap", [] {
  bool passed = true;

  passed &= property("planted overlaps from 1e-6 cells on are found, with pair, time and depth", [] {
    const double depth_cells = std::pow(10.0, -*rc::gen::inRange(4, 61) / 10.0);
    const Meeting meeting = any_meeting();
    const Planted planted = plant(meeting, depth_cells);
    const ValidationReport report = validate(planted.scene.instance, planted.scene.solution);
    RC_CLASSIFY(depth_cells < 1e-3, "below a thousandth of a cell");
    RC_ASSERT(report.violations.size() == 1u);
    const Violation& found = report.violations.front();
    RC_ASSERT(found.kind == ViolationKind::kAgentCollision);
    RC_ASSERT(found.agent == 0u && found.other == std::size_t{1});
    RC_ASSERT(std::abs(found.depth_cells - depth_cells) <= kDepthRounding);
    if (meeting != Meeting::kAtAGoalForEver) RC_ASSERT(std::abs(found.time_s - planted.time_s) <= 1e-6);
    if (meeting == Meeting::kAtAGoalForEver) RC_ASSERT(found.time_s >= planted.time_s - 1e-6);
  });

  passed &= property("bodies that touch are no conflict, nor is what rounding makes of it", [] {
    const double depth_cells = *rc::gen::element(0.0, 1e-12, 1e-9);
    const Planted planted = plant(any_meeting(), depth_cells);
    RC_ASSERT(validate(planted.scene.instance, planted.scene.solution).valid());
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::planted_overlap_laws
