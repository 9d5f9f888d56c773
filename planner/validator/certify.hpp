// A proof instead of an opinion: whether pairs of bodies keep apart, decided in
// interval arithmetic, so that no rounding error can hide in the answer.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "planner/instance/instance.hpp"
#include "planner/solution/solution.hpp"

namespace sipplab {

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
/// kCertifiedParts parts. Undecided remain spans whose deepest overlap is within
/// rounding of the tolerance, and all pairs of a body whose motions do not follow each
/// other exactly (validate() permits gaps of 1e-9 s). O(motions of both).
/// REQUIRES: radii are finite and above 0.
PairVerdict certify_pair(const Trajectory& a, double radius_a_cells, const Trajectory& b,
                         double radius_b_cells);

/// Ways that hardly change while two bodies touch are the hard ones: rounding of places
/// (1e-14 cells on a map of 100) hides the direction of a line of up to 1e-6 cells, and
/// parts of 1e-8, the tolerance, are decided by their length alone. Some hundreds do.
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

/// Certifies each pair of robots and each robot with each dynamic obstacle. Says nothing of
/// what a trajectory promises on its own: that is for validate(). All pairs of a robot
/// without trajectory are undecided. O(n^2) pairs, of which those whose paths stay apart
/// cost a comparison.
/// REQUIRES: !find_error(instance).
Certification certify(const Instance& instance, const Solution& solution, std::size_t max_findings = 100);

}  // namespace sipplab
