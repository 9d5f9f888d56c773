// SIPP and AA-SIPP for one robot. [PL11]: Phillips and Likhachev, ICRA 2011.
// [YA17]: Yakovlev and Andreychuk, ICAPS 2017, algorithm AA-SIPP.
#pragma once

#include <span>
#include <vector>

#include "planner/search/body.hpp"
#include "planner/search/open_list.hpp"
#include "planner/search/single_agent_planner.hpp"
#include "planner/search/sipp_node.hpp"

namespace sipplab {

struct SippOptions {
  /// Try to reach each successor straight from the parent of the expanded node as well.
  bool any_angle = true;
  /// 2^k neighbours, k = 2..5.
  int connectedness = 2;
  /// Factor on the lower bound of what lies ahead, >= 1, as in weighted A* (Pohl 1970). With 1 the
  /// least f is expanded first; with more, nodes nearer to the goal are: fewer expansions, and
  /// an arrival that is at most so many times as late as the earliest one by steps alone.
  double weight = 1;
  /// Add to the heuristic what the map's obstacles add to a robot's way by steps, were it alone: no way by
  /// steps takes less, but some any-angle way may, and may be missed where it alone is in time for a latest
  /// arrival. Off: the plain bound, as on an empty map.
  bool detours = true;
  /// Try the straight way to the goal from each expanded node, departing at once, or so late
  /// that the goal is free for good on arrival: no node of OPEN promises an earlier one (with a
  /// weight, one that is earlier by more than that factor), and the search ends. Any-angle only, where the
  /// search is greedy and f may fall along a way: now and then an earlier arrival would have been found by
  /// searching on.
  bool direct_shot = true;
  /// Weighted, at any angle: leave out those bends of the way that was found behind which a straight way
  /// from the bend before is safe and earlier. The arrival is never later. (Trials on the paper's instances,
  /// 50 a cell, weight 1.2: a quarter to a half of the flowtime that the weight costs on empty maps and with
  /// up to 32 robots in the warehouse, nothing with more.)
  bool straighten = true;
  /// Queue successors with a lower bound on their arrival and compute the arrival when
  /// they come up; off: compute it for each successor at once, the plain twin. The two
  /// break ties differently.
  bool lazy_evaluation = true;
  /// Ask the reservation table by its indexed search; off: by its plain twin.
  bool indexed_reservations = true;
};

class SippSearch final : public SingleAgentPlanner {
 public:
  /// The instance must outlive the search. REQUIRES: !find_error(instance).
  SippSearch(const Instance& instance, SippOptions options);

  Expected<Trajectory, PlanFailure> plan(AgentIndex agent, ReservationTable& reservations,
                                         const SearchLimits& limits, SearchStatistics& statistics) override;

  /// Straight-line distance (any-angle) or the neighbourhood's distance over speed.
  double lower_bound_s(AgentIndex agent) const override;

 private:
  /// The nodes of one cell: consecutive, one for each safe interval. Laid out when a
  /// search first comes to the cell.
  struct CellNodes {
    std::uint32_t search = 0;  ///< number of the search that laid them out
    NodeId first = kNoNode;
    NodeId last = kNoNode;  ///< one past
  };

  void begin(AgentIndex agent, ReservationTable& reservations);
  const CellNodes& nodes_of(Cell cell) {
    const CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
    return nodes.search == search_ ? nodes : lay_out(cell);
  }
  const CellNodes& lay_out(Cell cell);
  double lower_bound_s(Cell from, Cell to) const;
  /// At most what the way by steps from the cell to the goal takes; not weighted.
  double heuristic_s(Cell cell);
  double travel_s(Cell from, Cell to) const;
  double seconds(double cells) const {
    const double speed = agent_->speed_cells_per_s;
    return speed == 1 ? cells : cells / speed;
  }
  /// At most the arrival at the goal by the node and steps from there, what is ahead weighted.
  static double f(const SippNode& node) { return node.arrival_s + node.to_goal_s; }
  bool is_goal(const SippNode& node) const;
  /// Whether an arrival that leaves nothing to gain was found after this was queued.
  bool is_overtaken(const OpenList::Entry& entry) const;

  void expand(NodeId id, SearchStatistics& statistics);
  /// Promises node `id`, a neighbour of `from`, which may be reached from it or straight from `parent`
  /// (kNoNode: there is no such way), no earlier than at `arrival_s`.
  void offer(NodeId from, NodeId parent, NodeId id, double arrival_s, SearchStatistics& statistics);
  /// Computes what a promise is worth. Whether it lowered the arrival at the node.
  bool relax(NodeId from, NodeId parent, NodeId id, SearchStatistics& statistics);
  /// Whether `from` lies on the straight line from `parent` to node `id`.
  bool is_on_the_way(NodeId parent, NodeId from, NodeId id) const;
  /// Lowers the arrival at node `id` to that of the straight way from `parent`, if earlier.
  bool arrive_straight(NodeId parent, NodeId id);
  /// Which way to keep of two that arrive at the same time.
  enum class Tie { kKeep, kReplace };
  /// Lowers the arrival at node `id` to that of the step from `from`, if earlier.
  bool arrive_by_step(NodeId from, NodeId id, Tie tie) {
    double departure_s = 0;
    return arrive(from, id, 0, tie, nullptr, departure_s);
  }
  /// The same for any straight way on which no departure before `known_s` is safe. What is asked of the
  /// reservations then, if anything, is answered in `departure_s`.
  bool arrive(NodeId from, NodeId id, double known_s, Tie tie, ReservationTable::DiskId* likely_blocker,
              double& departure_s);
  /// Whether the straight way to the goal is safe when the node is left at once, or in time for
  /// the moment from which the goal is free; then the goal's node says so.
  bool shoot(NodeId id, SearchStatistics& statistics);
  double earliest_departure(const Move& move, double from_s, double until_s,
                            ReservationTable::DiskId* likely_blocker);
  /// What is handed over once the goal's node is reached.
  Trajectory finish(NodeId goal);
  /// From the start.
  std::vector<NodeId> way_to(NodeId goal) const;
  /// Lowers arrivals along the way by straight ways that leave out bends. REQUIRES: any-angle.
  void straighten(std::span<const NodeId> way);
  /// Any-angle steps that go on in one line are one motion.
  Trajectory reconstruct(std::span<const NodeId> way) const;

  const Instance& instance_;
  SippOptions options_;
  Bodies bodies_;
  std::vector<double> step_lengths_;  ///< in cells, by step of the neighbourhood
  Arena arena_;

  // The search under way.
  const Agent* agent_ = nullptr;
  Body* body_ = nullptr;
  ReservationTable* reservations_ = nullptr;
  std::uint32_t search_ = 0;
  ArenaVector<CellNodes> cell_nodes_;
  ArenaVector<SippNode> nodes_;
  ReservationTable::DiskId shot_blocker_ = ReservationTable::kNoDisk;  ///< of the last shot
  ReservationTable::DiskId way_blocker_ = ReservationTable::kNoDisk;   ///< of the last straight way
  OpenList open_;
};

}  // namespace sipplab
