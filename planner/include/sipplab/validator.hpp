// What "right" means: an independent check of a solution against its instance.
// The planner solves for the times at which two disks touch; the validator
// minimises their distance. The two share definitions and no formula.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

enum class ViolationKind {
  kAgentCount,         ///< not one trajectory for each agent
  kNotFinite,          ///< a time that is not a finite number, or negative
  kEndpoint,           ///< does not begin at the start or does not end at the goal
  kDiscontinuity,      ///< a gap in time or place between two motions
  kSpeed,              ///< a motion that does not take length / speed
  kStaticObstacle,     ///< the body overlaps a blocked cell or leaves the grid
  kAgentCollision,     ///< two robots closer than the sum of their radii
  kObstacleCollision,  ///< a robot and a dynamic obstacle likewise
  kStartSafeInterval,  ///< a robot too close to the start of a lower-priority robot in [0, ssi]
  kHeading,            ///< a robot moves, or ends, with another heading than it faces
  kStandingTime,       ///< too little time to turn, or to wait before a move
  kSpacing,            ///< less distance or time to another body than the rules ask for
};
/// "agent-collision" and so on, in lower case with hyphens.
std::string_view name(ViolationKind kind);

struct Violation {
  ViolationKind kind = ViolationKind::kAgentCount;
  AgentIndex agent = 0;
  /// The other robot (or the obstacle's position for kObstacleCollision).
  std::optional<std::size_t> other;
  double time_s = 0;  ///< when the violation is deepest, or where it stands in the trajectory
  /// Overlap at that time; for other kinds the size of the error, in seconds for times and
  /// in degrees for headings.
  double depth_cells = 0;
  std::string message;  ///< one line for a person
};

struct ValidationOptions {
  /// The start-safe interval whose guarantee is to be checked, with the final
  /// priority order; 0 or an empty order: nothing to check.
  double ssi_s = 0;
  std::vector<AgentIndex> order;
  MotionRules rules = {};  ///< what the plan was made for
  /// Stop collecting after this many violations; 0 counts as 1.
  std::size_t max_violations = 100;
};

struct ValidationReport {
  std::vector<Violation> violations;
  /// Least distance of a robot and any other body (robot or dynamic obstacle) minus
  /// the sum of their radii, in cells: negative means overlap, however small. Exact
  /// below kClearanceReachCells (1); if all are farther apart than that, that
  /// value. Infinity if there is nothing to compare: no two bodies, or a solution
  /// without usable times. If max_violations ended the comparison early, that of
  /// the pairs compared so far.
  double min_clearance_cells = std::numeric_limits<double>::infinity();

  bool valid() const { return violations.empty(); }
};

/// Checks everything that a solution guarantees: endpoints, continuity, speed, static
/// clearance, turns and delays, separation of every pair for all time, what the rules ask
/// for beyond that, start-safe intervals. Overlap
/// up to kValidatorToleranceCells passes. Never asserts on a bad solution.
/// Pairs are found by sweeping a uniform grid over (place, time); each candidate
/// pair of motions is decided in closed form. Violations come in this order: single
/// trajectories by agent, collisions by time, start-safe intervals by agent.
/// REQUIRES: !find_error(instance). (With other instances it does not crash, but the
/// verdict means little.)
ValidationReport validate(const Instance& instance, const Solution& solution,
                          const ValidationOptions& options = {});

// A proof instead of an opinion: whether pairs of bodies keep apart, decided in
// interval arithmetic, so that no rounding error can hide in the answer.

/// What is proven of two bodies. Trajectories are taken at their word: the doubles in
/// them are exact times, and between these a body moves exactly uniformly.
enum class PairCertificate {
  kSafe,       ///< nowhere do they overlap deeper than kValidatorToleranceCells
  kCollision,  ///< at one time at least they do
  kUndecided,  ///< neither was proven
};
/// "safe", "collision", "undecided".
std::string_view name(PairCertificate certificate);

struct PairVerdict {
  PairCertificate certificate = PairCertificate::kUndecided;
  /// Of a collision: a time, and a depth by which they overlap then for certain. Close
  /// to the deepest, not exactly it. 0 otherwise.
  double time_s = 0;
  double depth_cells = 0;
};

/// A span of uniform motion that is not decided by its ends, its least distance and the
/// line that one body runs along as seen from the other is halved, until it is in
/// kCertifiedParts parts. A span stays undecided if its deepest overlap is within rounding
/// of the tolerance; all pairs of a body are undecided if its motions do not follow each
/// other exactly (validate() permits gaps of 1e-9 s). O(motions of both).
/// REQUIRES: radii are finite and above 0.
PairVerdict certify_pair(const Trajectory& a, double radius_a_cells, const Trajectory& b,
                         double radius_b_cells);

/// The hard pairs are those whose distance hardly changes while they touch: rounding of places (1e-14 cells
/// on a map of 100) hides the direction of a line that is shorter than 1e-6 cells. Parts of 1e-8 cells, the
/// tolerance, are decided by their length alone, so a few hundred of them are enough.
inline constexpr int kCertifiedParts = 1024;

/// A pair that is not safe.
struct PairFinding {
  AgentIndex agent = 0;
  std::size_t other = 0;  ///< a later agent, or an obstacle
  bool other_is_obstacle = false;
  PairVerdict verdict;
};

struct Certification {
  std::size_t safe = 0;
  std::size_t collisions = 0;
  std::size_t undecided = 0;
  /// Pairs that are not safe, by agent, then other; at most max_findings.
  std::vector<PairFinding> findings;

  std::size_t pairs() const { return safe + collisions + undecided; }
};

/// Certifies each pair of robots and each robot with each dynamic obstacle. Does not check what
/// a trajectory guarantees on its own; validate() does. All pairs of a robot without trajectory
/// are undecided. O(n^2) pairs; one whose paths stay apart costs a comparison.
/// REQUIRES: !find_error(instance).
Certification certify(const Instance& instance, const Solution& solution, std::size_t max_findings = 100);

}  // namespace sipplab
