// One step of all robots at once, in discrete time: priority inheritance with backtracking.
// [PIBT]: Okumura, Machida, Defago and Tamura, Artificial Intelligence 310, 2022;
// [LC23]: Okumura, IJCAI 2023, section 4 (swaps in narrow places).
// [HI25]: Okumura and Nagai, arXiv 2505.12623, 2025 (hindrance).
// Differs from [PIBT]: who is pushed need not go where it would like to go itself. The row of robots that
// push each other is the cheapest one: short, and straight, since a disk that follows around a corner is
// sqrt(2) later than the one before, and rows that wind made plans of crowds twice to four times as long.
// Differs from both: a closed ring of robots never turns. Robots of radius 0.5 that fill a
// ring of cells cannot turn it without overlap, so that such a step has no plan in
// continuous time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/complete/goal_distances.hpp"
#include "planner/complete/guidance.hpp"
#include "planner/core/random.hpp"

namespace sipplab {

/// The cell of each robot at one time step.
using Configuration = CellIds;

inline constexpr RobotId kNoRobot = UINT32_MAX;

/// Where one robot has to be after the step.
struct StepConstraint {
  RobotId robot = 0;
  CellId cell = 0;
};

enum class StepOutcome {
  kFound,
  kNotFound,       ///< the robots got into each other's way; other constraints may do
  kContradiction,  ///< the constraints alone break the rules, and so do they with more of them
};

class Pibt {
 public:
  /// Both must outlive this. `prefer_free_cells`: of cells that are equally near, robots try
  /// free ones first. O(cells).
  Pibt(const FreeGrid& grid, GoalDistances& distances, bool prefer_free_cells, std::uint64_t seed);

  /// Cells are nearer or farther by these distances from now on; null: by moves alone.
  void follow(GuidedDistances* guide) { guide_ = guide; }

  /// Whether rows of pushes are the cheapest ones from now on, or those of [PIBT], which get the last robots
  /// home where cheap ones go back and forth.
  void push_cheaply(bool cheaply) { pushes_cheaply_ = cheaply; }

  /// Moves each robot to a neighbour of its cell or leaves it where it is, so that
  ///  (1) no two robots end in one cell;
  ///  (2) no robots move in a closed ring, so that no two change places either (following a
  ///      robot into the cell that it leaves is fine);
  ///  (3) each constraint is met;
  ///  (4) if all robots are constrained and (1) and (2) allow it, a step is found.
  /// Robots choose in the given order, nearer cells first. `next` is worthless unless
  /// a step was found.
  ///
  /// REQUIRES: `order` holds each robot once; constraints name different robots, and cells
  /// that these can be in after one step. O(robots) unless rows of robots push each other.
  StepOutcome make_step(const Configuration& now, std::span<const RobotId> order,
                        std::span<const StepConstraint> constraints, Configuration& next);

  /// Cells that robots looked at so far, to go there or to push others there.
  std::uint64_t cells_seen() const { return cells_seen_; }

 private:
  static constexpr std::size_t kMaxCandidates = 5;  ///< four neighbours and its own cell

  /// A robot that is choosing its cell.
  struct Choice {
    RobotId robot = 0;
    RobotId swap_partner = kNoRobot;
    std::uint32_t tried = 0;
    std::uint32_t count = 0;
    std::array<CellId, kMaxCandidates> candidates{};
  };

  /// The end of a row of pushes: the last of its robots goes `from` one cell to the next.
  struct RowEnd {
    std::uint32_t cost = 0;
    CellId cell = 0;
    CellId from = 0;
    bool operator>(const RowEnd& other) const { return cost > other.cost; }
  };

  /// Above 0 if `to` is nearer to the robot's goal than `from`.
  int gain(RobotId robot, CellId from, CellId to) const {
    if (guide_ != nullptr) return guide_->gain(robot, from, to);
    return distances_.is_nearer(robot, from, to) ? 1 : -1;
  }
  /// [HI25]: other robots next to the cell that want to go there.
  std::uint32_t hindrance(RobotId robot, CellId cell) const;
  bool assign_all(std::span<const StepConstraint> constraints);
  bool move(RobotId root);
  bool push(RobotId root);
  void extend_row(CellId root_cell, CellId before, CellId from, CellId to, std::uint32_t cost);
  void add_end(const RowEnd& end);
  bool is_free(CellId cell) const { return robot_at_[cell] == kNoRobot || is_assigned(robot_at_[cell]); }
  bool is_turn(CellId a, CellId b, CellId c) const;
  Choice begin_choice(RobotId robot);
  /// Reserves the next candidate that is free to take. False if none is left.
  bool reserve_candidate(Choice& choice);
  /// The robot that has to give way to the candidate reserved last; kNoRobot for none.
  RobotId robot_in_the_way(const Choice& choice) const;
  void pull_swap_partner(const Choice& choice);

  void assign(RobotId robot, CellId cell) {
    (*next_)[robot] = cell;
    taken_by_[cell] = robot;
  }
  bool is_assigned(RobotId robot) const { return (*next_)[robot] != kNoCell; }
  bool closes_ring(CellId from, CellId to) const;

  RobotId swap_partner(RobotId robot, CellId wanted) const;
  bool is_swap_required(RobotId pusher, RobotId puller, CellId pusher_cell, CellId puller_cell) const;
  bool is_swap_possible(CellId pusher_cell, CellId puller_cell) const;
  struct SideStep {
    std::size_t paths = 0;  ///< out of the puller's cell, other than to the pusher
    CellId cell = kNoCell;
  };
  SideStep side_steps(CellId pusher_cell, CellId puller_cell) const;

  const FreeGrid& grid_;
  GoalDistances& distances_;
  GuidedDistances* guide_ = nullptr;
  bool prefer_free_cells_;
  bool pushes_cheaply_ = false;
  Random random_;
  const Configuration* now_ = nullptr;
  Configuration* next_ = nullptr;
  std::vector<RobotId> robot_at_;  ///< by cell, before the step
  std::vector<RobotId> taken_by_;  ///< by cell, after the step
  std::vector<Choice> choices_;    ///< each robot after the first is in the way of the one before

  std::vector<RowEnd> ends_;             ///< a heap, the cheapest first
  std::vector<RowEnd> reached_;          ///< by cell: the cheapest row that ends there
  std::vector<std::uint32_t> searched_;  ///< by cell: the search that reached it
  std::uint32_t search_ = 0;
  std::uint64_t cells_seen_ = 0;
  std::uint32_t least_cost_ = 0;  ///< of the rows so far whose end is free
  std::vector<char> is_narrow_;   ///< by cell: whether some next cell has fewer than two ways on
};

}  // namespace sipplab
