// SIPP and AA-SIPP for one robot. [PL11]: Phillips and Likhachev, ICRA 2011.
// [YA17]: Yakovlev and Andreychuk, ICAPS 2017, algorithm AA-SIPP.
#pragma once

#include <span>
#include <vector>

#include "planner/search/body.hpp"
#include "planner/search/motion.hpp"
#include "planner/search/open_list.hpp"
#include "planner/search/single_agent_planner.hpp"

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
  MotionRules rules{};  ///< for TurningSearch alone
  /// Add to the heuristic what the map's obstacles add to a robot's path by steps, were it alone, and stretch
  /// it at any angle: no path by steps takes less, but some any-angle path may, and may be missed where it
  /// alone is in time for a latest arrival. Off: the plain distance, as on an empty map.
  bool detours = true;
  /// At any angle: pull the way that was found tight. Bends are left out or moved to a cell beside them where
  /// that is safe; nobody is later at any stop.
  bool elastic = true;
};

/// The search for one kind of robot. `Motion` is a policy as in motion.hpp.
template <class Motion>
class Sipp final : public SingleAgentPlanner {
 public:
  /// The instance must outlive the search. REQUIRES: !find_error(instance).
  Sipp(const Instance& instance, SippOptions options);

  /// Turns are motions of their own in the trajectory, each right after the arrival; the
  /// last one is to the goal heading, and the robot has arrived when it is done.
  Expected<Trajectory, PlanFailure> plan(AgentIndex agent, ReservationTable& reservations,
                                         const SearchLimits& limits, SearchStatistics& statistics) override;

  /// Of travelling, turning and standing, as if the robot were alone on an empty map.
  double lower_bound_s(AgentIndex agent) const override;

 private:
  using Node = typename Motion::Node;
  using Heading = typename Motion::Heading;
  /// The nodes of one cell: consecutive, one for each safe interval. Laid out when a
  /// search first comes to the cell.
  struct CellNodes {
    std::uint32_t search = 0;  ///< number of the search that laid them out
    NodeId first = kNoNode;
    NodeId last = kNoNode;  ///< one past
  };
  /// A straight way to a cell, and when it may end.
  struct Way {
    NodeId from;
    Heading heading;
    double travel_s;
    double soonest_s;
    double latest_s;
    double step_soonest_s = 0;  ///< for a way from the parent of `from`: by the step from `from`
  };
  /// Which way to keep of two that arrive at the same time.
  enum class Tie { kKeep, kReplace };

  void begin(const Agent& agent, ReservationTable& reservations);
  const CellNodes& nodes_of(Cell cell) {
    const CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
    return nodes.search == search_ ? nodes : lay_out(cell);
  }
  const CellNodes& lay_out(Cell cell);

  double seconds(double cells) const {
    const double speed = agent_->speed_cells_per_s;
    return speed == 1 ? cells : cells / speed;
  }
  double line_cells(Cell from, Cell to) const {
    return options_.any_angle ? distance(from, to) : neighbourhood_distance(from, to, options_.connectedness);
  }
  /// At most what a way by steps from the cell to the goal takes; neither weighted nor with any turn.
  double heuristic_s(Cell cell);
  /// The heuristic, weighted, for who comes to the node facing this way.
  double to_goal_s(NodeId id, Heading heading) {
    if constexpr (!Motion::kTurns) return nodes_[id].to_goal_s;
    const Cell cell = nodes_[id].cell();
    return options_.weight * (heuristic_s(cell) + motion_.standing_s(cell, heading));
  }
  /// At most the arrival at the goal by the node and steps from there, what is ahead weighted.
  static double f(const Node& node) { return node.arrival_s + node.to_goal_s; }
  bool is_goal(const Node& node) const {
    return node.cell() == agent_->goal && node.interval.end_s == kForever;
  }
  /// Whether an arrival that leaves nothing to gain was found after this was queued.
  bool is_overtaken(const OpenList::Entry& entry) const;
  Heading heading_of(const Node& from, const Node& to) const {
    return motion_.heading(from.cell(), to.cell());
  }
  /// Whether `middle` lies on the straight line between the two others.
  static bool is_on_the_way(const Node& first, const Node& middle, const Node& last);

  void expand(NodeId id);
  Way way(NodeId from, Cell to, double cells) const;
  /// Queues those of the nodes of a cell at which the way may arrive earlier than any that is known. Where
  /// there is a parent they may be reached straight from it, or by the step from way.from.
  void offer(const Way& way, NodeId parent, NodeId target, NodeId last);
  /// Whether an arrival no earlier than `soonest_s` may be in the interval and earlier than the one that is
  /// known.
  bool may_gain(NodeId id, Heading heading, double soonest_s) const {
    const SafeInterval& interval = nodes_[id].interval;
    const double earliest_s = std::max(interval.begin_s, soonest_s);
    return earliest_s <= interval.end_s && earliest_s < motion_.known_s(nodes_, id, heading);
  }
  /// Computes what a lazy successor is worth: the node whose arrival fell, or kNoNode.
  NodeId evaluate(NodeId from, NodeId parent, NodeId id);
  /// Lowers the arrival at node `id` to that of the straight way from `parent`, if earlier.
  NodeId arrive_straight(NodeId parent, NodeId id);
  /// The same for the step from `from`.
  NodeId arrive_by_step(NodeId from, NodeId id, Tie tie) {
    double departure_s = 0;
    return arrive(from, id, 0, tie, nullptr, departure_s);
  }
  /// The same for any straight way on which no departure before `known_s` is safe. `departure_s` is as of
  /// leg().
  NodeId arrive(NodeId from, NodeId id, double known_s, Tie tie, ReservationTable::DiskId* likely_blocker,
                double& departure_s);
  /// Reaches the goal by the straight way from the node, if that is safe when it is left at once, or in time
  /// for the moment from which the goal is free.
  NodeId shoot(NodeId id);
  /// What is handed over once the goal's node is reached.
  Trajectory finish(NodeId goal);
  /// The earliest way straight between two stops, in the safe interval of each, with no departure before
  /// `known_s` and no arrival after `latest_s`: whether there is one. What is asked of the reservations, if
  /// anything, is answered in `departure_s`, and is a lower bound on it where there is none.
  bool leg(const Node& from, const Node& to, double known_s, double latest_s,
           ReservationTable::DiskId* likely_blocker, double& departure_s, double& arrival_s);

  using Stops = std::vector<Node>;
  /// From the start.
  Stops stops_to(NodeId goal) const;
  /// Leaves out stops at which the robot goes on at once in the same line.
  static void join_lines(Stops& stops);
  /// As of SippOptions::elastic.
  void pull_tight(Stops& stops);
  /// Goes from stop i to stop k by nothing but the bend, if any, where that is safe, arrives by `latest_s`,
  /// and is no later at any stop behind: whether that is so.
  bool reroute(Stops& stops, std::size_t i, std::size_t k, Node* bend, double latest_s);
  /// Sets when and how the robot comes to a stop from the one before: whether it can by then.
  bool move(const Node& from, Node& to, double latest_s, ReservationTable::DiskId* likely_blocker = nullptr);
  Trajectory reconstruct(const Stops& stops) const;

  const Instance& instance_;
  SippOptions options_;
  Bodies bodies_;
  std::vector<double> step_lengths_;  ///< in cells, by step of the neighbourhood
  Arena arena_;

  // The search under way.
  const Agent* agent_ = nullptr;
  Motion motion_;
  double moving_radius_ = 0;  ///< cells
  Body* body_ = nullptr;
  ReservationTable* reservations_ = nullptr;
  SearchStatistics* statistics_ = nullptr;
  std::uint32_t search_ = 0;
  ArenaVector<CellNodes> cell_nodes_;
  ArenaVector<Node> nodes_;
  ReservationTable::DiskId shot_blocker_ = ReservationTable::kNoDisk;  ///< of the last shot
  ReservationTable::DiskId way_blocker_ = ReservationTable::kNoDisk;   ///< of the last straight way
  OpenList open_;
};

using SippSearch = Sipp<PlainMotion>;
/// For robots that have a heading, stand before they move, or keep more room than their bodies need.
using TurningSearch = Sipp<TurningMotion>;

}  // namespace sipplab
