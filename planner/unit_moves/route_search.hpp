// The fastest route of one robot by unit moves around all others, in continuous time: SIPP ([PL11]: Phillips
// and Likhachev, ICRA 2011) over cells and the gaps between the stays of others there.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "planner/complete/goal_distances.hpp"
#include "planner/unit_moves/timetable.hpp"

namespace sipplab {

/// Distances to the goals of all robots, for several threads.
class SharedDistances {
 public:
  /// The grid must outlive this. REQUIRES: each goal can be reached from its start. O(robots x cells) at
  /// worst.
  SharedDistances(const FreeGrid& grid, const std::vector<CellId>& starts, const std::vector<CellId>& goals);

  /// The distances of one robot, for one thread at a time.
  class OfRobot {
   public:
    OfRobot(GoalDistances& all, RobotId robot, std::mutex& mutex) : all_(all), robot_(robot), lock_(mutex) {}
    /// Whether `to` is nearer to the goal than its neighbour `from`.
    bool is_nearer(CellId from, CellId to) { return all_.is_nearer(robot_, from, to); }
    /// The same, for several neighbours of one cell.
    GoalDistances::Nearer nearer_than(CellId from) { return all_.nearer_than(robot_, from); }

   private:
    GoalDistances& all_;
    RobotId robot_;
    std::unique_lock<std::mutex> lock_;
  };
  OfRobot of(RobotId robot) { return {distances_, robot, mutexes_[robot % mutexes_.size()]}; }

  CellId start(RobotId robot) const { return starts_[robot]; }
  CellId goal(RobotId robot) const { return distances_.goal(robot); }
  /// Moves from start to goal.
  Tick moves(RobotId robot) const { return moves_[robot]; }
  /// The time that they take: no arrival is earlier.
  Tick least_arrival(RobotId robot) const { return moves_[robot] * kMoveTicks; }

 private:
  static constexpr std::size_t kMutexes = 256;

  GoalDistances distances_;
  std::vector<CellId> starts_;
  std::vector<Tick> moves_;
  std::vector<std::mutex> mutexes_{kMutexes};
};

/// The search of one thread; it keeps its memory.
class RouteSearch {
 public:
  /// Both must outlive this.
  RouteSearch(const UnitMoves& moves, SharedDistances& distances);

  /// A route of a robot that has none, around all others, that arrives at `latest` or before. The earliest
  /// but for kBucketTicks; none also if more than `most_expansions` would be needed.
  std::optional<Route> find(RobotId robot, const Timetable& others, Tick latest,
                            std::uint64_t most_expansions);

  std::uint64_t expansions() const { return expansions_; }
  std::uint64_t generations() const { return generations_; }

 private:
  using NodeId = std::uint32_t;
  static constexpr NodeId kNoNode = UINT32_MAX;
  /// Nodes whose f differ by less are taken last in, first out.
  static constexpr Tick kBucketTicks = kMoveTicks / 16;

  /// Arrival at a cell in a gap: between the stay `gap - 1` and the stay `gap` of others.
  struct Node {
    CellId cell;
    std::uint32_t gap;
    Tick arrival;
    Tick left;  ///< moves to the goal
    NodeId parent;
  };

  void begin();
  void expand(NodeId id, const Timetable& others, SharedDistances::OfRobot& distances, Tick latest);
  void reach(const Node& node, const Timetable& others);
  void push(NodeId id, Tick estimate);
  NodeId pop();
  Route route_to(NodeId id) const;

  const UnitMoves& moves_;
  SharedDistances& distances_;
  std::uint64_t expansions_ = 0;
  std::uint64_t generations_ = 0;

  std::vector<Node> nodes_;
  /// By cell: where its gaps begin in `best_`, if it was reached in this search.
  std::vector<std::uint32_t> gaps_;
  std::vector<std::uint32_t> reached_in_;
  std::uint32_t search_ = 0;
  std::vector<NodeId> best_;               ///< by gap of a reached cell: the earliest node
  std::vector<std::vector<NodeId>> open_;  ///< by (f - least_) / kBucketTicks
  Tick least_ = 0;
  std::size_t bucket_ = 0;  ///< the first that is not empty, or before it
};

}  // namespace sipplab
