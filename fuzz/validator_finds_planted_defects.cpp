// Claim: whatever is broken in a plan on purpose, the validator finds it and says what and
// whose it is. One defect of every kind is planted into the plan of each case. The picture
// of each finding is drawn: it must not crash either.
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/sampling_oracle.hpp"
#include "property_tests/support/symmetry.hpp"
#include "sipplab/svg.hpp"
#include "sipplab/validator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Seconds and cells: far more than any tolerance.
constexpr double kShiftS = 0.5;
constexpr double kDepthCells = 0.05;
/// Seconds between the times at which a start is looked at.
constexpr double kSampleStepS = 0.125;
/// One plan in this many is drawn with what was found: a picture takes as long as the rest.
constexpr std::uint64_t kDrawnOneIn = 4;

/// A right plan that defects are planted into.
struct Plan {
  Scene scene;
  PlannerOptions options;
  PriorityOrder order;
  double clearance_cells = 0;

  Trajectory& trajectory(Scene& of, AgentIndex agent) const { return of.solution.trajectories[agent]; }
};

bool names(const ValidationReport& report, ViolationKind kind, std::optional<AgentIndex> agent) {
  return std::any_of(report.violations.begin(), report.violations.end(), [&](const Violation& violation) {
    return violation.kind == kind && (!agent || violation.agent == *agent);
  });
}

void require_found(const Plan& plan, const Scene& broken, ViolationKind kind,
                   std::optional<AgentIndex> agent) {
  const ValidationReport report = validate(broken.instance, broken.solution);
  fuzz::require(Claim::kPlantedDefectIsFound, names(report, kind, agent),
                std::string(name(kind)) + " is not found");
  if (plan.options.seed % kDrawnOneIn == 0) draw_svg(broken.instance, broken.solution, report);
}

/// The last motion of the agent that moves, if any.
std::optional<std::size_t> last_move(const Trajectory& trajectory) {
  for (std::size_t i = trajectory.motions.size(); i > 0; --i) {
    if (!trajectory.motions[i - 1].is_wait()) return i - 1;
  }
  return std::nullopt;
}

void plant_in_trajectory(const Plan& plan, AgentIndex agent) {
  Scene broken = plan.scene;
  Trajectory& trajectory = plan.trajectory(broken, agent);
  const auto move = last_move(trajectory);
  if (!move) return;
  const Trajectory whole = trajectory;

  trajectory.motions.resize(*move);
  require_found(plan, broken, ViolationKind::kEndpoint, agent);

  trajectory = whole;
  for (std::size_t i = *move; i < trajectory.motions.size(); ++i) {
    trajectory.motions[i].begin_s += kShiftS;
    trajectory.motions[i].end_s += kShiftS;
  }
  require_found(plan, broken, ViolationKind::kDiscontinuity, agent);

  trajectory = whole;
  TimedMotion& faster = trajectory.motions[*move];
  faster.end_s = (faster.begin_s + faster.end_s) / 2;
  trajectory.motions.resize(*move + 1);
  require_found(plan, broken, ViolationKind::kSpeed, agent);

  trajectory = whole;
  trajectory.motions[*move].end_s = std::numeric_limits<double>::quiet_NaN();
  require_found(plan, broken, ViolationKind::kNotFinite, agent);
}

void plant_missing_trajectory(const Plan& plan) {
  Scene broken = plan.scene;
  broken.solution.trajectories.pop_back();
  require_found(plan, broken, ViolationKind::kAgentCount, std::nullopt);
}

/// A cell at which the agent turns or waits becomes blocked.
void plant_blocked_cell(const Plan& plan, AgentIndex agent) {
  for (const TimedMotion& motion : plan.scene.solution.trajectories[agent].motions) {
    Scene broken = plan.scene;
    broken.instance.map.set_blocked(motion.to, true);
    if (find_error(broken.instance)) continue;  // a start or a goal
    return require_found(plan, broken, ViolationKind::kStaticObstacle, agent);
  }
}

/// All robots grow until those that came closest overlap.
void plant_overlap(const Plan& plan) {
  Scene broken = plan.scene;
  if (!(plan.clearance_cells < 1)) return;
  for (Agent& agent : broken.instance.agents) agent.radius_cells += plan.clearance_cells + kDepthCells;
  if (find_error(broken.instance)) return;
  const ValidationReport report = validate(broken.instance, broken.solution);
  fuzz::require(Claim::kPlantedDefectIsFound,
                names(report, ViolationKind::kAgentCollision, std::nullopt) ||
                    names(report, ViolationKind::kObstacleCollision, std::nullopt) ||
                    report.violations.size() >= ValidationOptions{}.max_violations,
                "an overlap is not found");
  const Certification certified = certify(broken.instance, broken.solution);
  fuzz::require(Claim::kPlantedDefectIsFound, certified.collisions > 0, "an overlap is not proven");
}

/// An agent that passes the start of another gets priority over it, and starts are protected
/// until then.
void plant_intrusion(const Plan& plan, AgentIndex agent) {
  const auto& agents = plan.scene.instance.agents;
  const Trajectory& path = plan.scene.solution.trajectories[agent];
  for (AgentIndex other = 0; other < agents.size(); ++other) {
    if (other == agent) continue;
    const double near = agents[agent].radius_cells + agents[other].radius_cells - kDepthCells;
    for (double time_s = 0; time_s <= path.arrival_s(); time_s += kSampleStepS) {
      if (norm(sampled_position(path, time_s) - centre(agents[other].start)) >= near) continue;
      ValidationOptions options;
      options.ssi_s = time_s + kSampleStepS;
      options.order = {agent, other};
      for (AgentIndex i = 0; i < agents.size(); ++i) {
        if (i != agent && i != other) options.order.push_back(i);
      }
      const ValidationReport report = validate(plan.scene.instance, plan.scene.solution, options);
      return fuzz::require(Claim::kPlantedDefectIsFound,
                           names(report, ViolationKind::kStartSafeInterval, agent),
                           "an intrusion into a protected start is not found");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  const PlanResult result = plan(plan_case->instance, plan_case->options);
  if (result.status != PlanStatus::kSolved || plan_case->instance.agents.empty()) return 0;
  fuzz::count(fuzz::Event::kSolved);
  Plan plan{{plan_case->instance, result.solution}, plan_case->options, result.order(), 0};
  const ValidationReport report = validate(plan.scene.instance, plan.scene.solution);
  fuzz::require(Claim::kPlanIsValid, report.valid(), "a plan is invalid before anything is planted");
  plan.clearance_cells = report.min_clearance_cells;
  const AgentIndex agent = plan_case->options.seed % plan_case->instance.agents.size();
  plant_in_trajectory(plan, agent);
  plant_missing_trajectory(plan);
  plant_blocked_cell(plan, agent);
  plant_overlap(plan);
  plant_intrusion(plan, agent);
  return 0;
}
