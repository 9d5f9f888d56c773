// SIPP and AA-SIPP for one robot. [PL11]: Phillips and Likhachev, ICRA 2011.
// [YA17]: Yakovlev and Andreychuk, ICAPS 2017, algorithm AA-SIPP.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planner/reservation/reservation_table.hpp"
#include "planner/search/body.hpp"
#include "planner/search/motion.hpp"
#include "planner/search/open_list.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

struct SippOptions {
  /// Also try to reach each successor straight from the expanded node's parent.
  bool any_angle = true;
  /// 2^k neighbours, k = 2..5.
  int connectedness = 2;
  /// Factor on the heuristic, >= 1, as in weighted A* (Pohl 1970). 1 is plain A*. Greater weights prefer
  /// nodes nearer to the goal: fewer expansions, and an arrival that is at most this many times as late as
  /// the earliest one by steps alone.
  double weight = 1;
  MotionRules rules{};  ///< for TurningSearch only
  /// Use the static distance heuristic: add what the map's obstacles add to a lone robot's path by steps, and
  /// stretch the sum for any-angle search. No path by steps takes less, but an any-angle path may, and may be
  /// missed if it alone meets a latest arrival. Off: the plain distance, as on an empty map.
  bool static_distances = true;
  /// Any-angle only: pull the path tight. Turning points are left out or moved to a cell beside them if that
  /// is safe; the robot is no later at any stop.
  bool elastic = true;
};

/// The search for one kind of robot. `Motion` is a policy as in motion.hpp.
template <class Motion>
class Sipp final : public SingleAgentPlanner {
 public:
  /// The instance must outlive the search. plan() REQUIRES a ReservationTable. REQUIRES:
  /// !find_error(instance).
  Sipp(const Instance& instance, SippOptions options);

  /// Turns are separate motions in the trajectory, each right after the arrival. The last one is to the goal
  /// heading; the robot has arrived when it ends.
  Expected<Trajectory, PlanFailure> plan(AgentIndex agent, Reservations& reservations,
                                         const SearchLimits& limits, SearchStatistics& statistics) override;

  /// Leaves every stop as early as is safe, then leaves out stops or moves them to a cell beside: see
  /// SippOptions::elastic. None for robots that have a heading.
  std::optional<Trajectory> tighten(AgentIndex agent, const Trajectory& given,
                                    Reservations& reservations) override;

  /// Counts travelling, turning and standing, as if the robot were alone on an empty map.
  double lower_bound_s(AgentIndex agent) const override;

 private:
  using Node = typename Motion::Node;
  using Heading = typename Motion::Heading;
  /// The nodes of one cell: consecutive, one for each safe interval. Laid out when a search first visits the
  /// cell.
  struct CellNodes {
    std::uint32_t search = 0;  ///< number of the search that laid them out
    NodeId first = kNoNode;
    NodeId last = kNoNode;  ///< one past
  };
  /// A straight move to a cell, and when it may end.
  struct Edge {
    NodeId from;
    Heading heading;
    double travel_s;
    double soonest_s;
    double latest_s;
    double step_soonest_s = kForever;  ///< for a move from the parent of `from`: by the step from `from`
  };
  /// Which of two moves to keep if they arrive together.
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
  /// At most the time of a path by steps from the cell to the goal; not weighted, without turns.
  double heuristic_s(Cell cell);
  /// The weighted heuristic for an arrival at the node with this heading.
  double to_goal_s(NodeId id, Heading heading) const {
    if constexpr (Motion::kTurns) {
      return options_.weight * (nodes_[id].least_s + motion_.standing_s(nodes_[id].cell(), heading));
    } else {
      return nodes_[id].to_goal_s;
    }
  }
  /// At most the arrival at the goal via the node and steps from there, the latter weighted.
  static double f(const Node& node) { return node.arrival_s + node.to_goal_s; }
  bool is_goal(const Node& node) const {
    return node.cell() == agent_->goal && node.interval.end_s == kForever;
  }
  /// Whether an arrival found after this was queued leaves nothing to gain.
  bool is_overtaken(const OpenList::Entry& entry) const;
  Heading heading_of(const Node& from, const Node& to) const {
    return motion_.heading(from.cell(), to.cell());
  }
  /// Whether `middle` lies on the straight line between the other two.
  static bool lies_between(const Node& first, const Node& middle, const Node& last);

  void expand(NodeId id);
  Edge edge(NodeId from, Cell to, double cells) const;
  /// Queues the nodes of a cell at which the move may arrive earlier than known. With a parent they may be
  /// reached straight from it, or by the step from edge.from; if the two are the same, the move is a leg.
  void offer(const Edge& edge, NodeId parent, NodeId target, NodeId last);
  /// Whether an arrival at `soonest_s` or later may be in the interval and earlier than the known one.
  bool may_gain(NodeId id, Heading heading, double soonest_s) const {
    const SafeInterval& interval = nodes_[id].interval;
    const double earliest_s = std::max(interval.begin_s, soonest_s);
    return earliest_s <= interval.end_s && earliest_s < motion_.known_s(nodes_, id, heading, earliest_s);
  }
  /// Evaluates a lazy successor. Returns the node whose arrival fell, or kNoNode.
  NodeId evaluate(NodeId from, NodeId parent, NodeId id);
  /// Lowers the arrival at node `id` to that of the straight move from `from`, if earlier. What was found out
  /// about the move is remembered.
  NodeId arrive_straight(NodeId from, NodeId id);
  /// The same for the step from `from`.
  NodeId arrive_by_step(NodeId from, NodeId id, Tie tie) {
    double departure_s = 0;
    return arrive(from, id, 0, tie, nullptr, departure_s);
  }
  /// The same for any straight move with no safe departure before `known_s`. `departure_s` is as in leg().
  NodeId arrive(NodeId from, NodeId id, double known_s, Tie tie, ReservationTable::DiskId* likely_blocker,
                double& departure_s);
  /// The goal shot: a straight move from the node to the goal, if it is safe to depart at once, or just in
  /// time for the goal to be free. Else legs are offered that lead around what is in the way; around the map
  /// only after a leg and at the start, since after a step much the same is in sight as before it.
  NodeId shoot(NodeId id, bool after_leg);
  /// Offers legs that pass the disk which blocks the goal shot, once for each disk.
  void turn_aside(NodeId id, const Move& move, double departure_s);
  /// Offers a cell for a straight move, if it is in line of sight. REQUIRES: it is legal.
  void offer_leg(NodeId from, Cell to);
  /// The result once the goal's node is reached.
  Trajectory finish(NodeId goal);
  /// Finds the earliest straight move between two stops, in the safe interval of each, with no departure
  /// before `known_s` and no arrival after `latest_s`. Returns whether there is one. If the reservations are
  /// asked, their answer is in `departure_s`: a lower bound on the departure if there is no such move.
  bool leg(const Node& from, const Node& to, double known_s, double latest_s,
           ReservationTable::DiskId* likely_blocker, double& departure_s, double& arrival_s);

  using Stops = std::vector<Node>;
  /// From the start.
  Stops stops_to(NodeId goal) const;
  /// Of a trajectory, each in the safe interval of its arrival; none if one is in no safe interval.
  std::optional<Stops> stops_of(const Trajectory& trajectory);
  /// Leaves out stops at which the robot goes straight on at once.
  static void join_lines(Stops& stops);
  /// See SippOptions::elastic.
  void pull_tight(Stops& stops);
  /// Goes from stop i to stop k straight, or via `via` alone, if that is safe, arrives by `latest_s` and is
  /// no later at any later stop. Returns whether it did.
  bool reroute(Stops& stops, std::size_t i, std::size_t k, Node* via, double latest_s);
  /// Sets times and heading of the move from one stop to the next; false if it cannot arrive by `latest_s`.
  bool move(const Node& from, Node& to, double latest_s, ReservationTable::DiskId* likely_blocker = nullptr);
  Trajectory reconstruct(const Stops& stops) const;

  const Instance& instance_;
  SippOptions options_;
  Bodies bodies_;
  std::vector<double> step_lengths_;  ///< in cells, by step of the neighbourhood
  typename Motion::Headings headings_;
  Arena arena_;

  // The current search.
  const Agent* agent_ = nullptr;
  Motion motion_;
  double moving_radius_ = 0;  ///< cells
  Body* body_ = nullptr;
  ReservationTable* reservations_ = nullptr;
  SearchStatistics* statistics_ = nullptr;
  std::uint32_t search_ = 0;
  ArenaVector<CellNodes> cell_nodes_;
  ArenaVector<Node> nodes_;
  ReservationTable::DiskId shot_blocker_ = ReservationTable::kNoDisk;  ///< of the last goal shot
  ReservationTable::DiskId edge_blocker_ = ReservationTable::kNoDisk;  ///< of the last straight move
  OpenList open_;
  int disks_passed_ = 0;                  ///< disks that legs were offered for
  std::vector<std::uint32_t> passed_in_;  ///< by disk: number of the last search in which that was so
};

using SippSearch = Sipp<PlainMotion>;
/// For robots that have a heading, stand before they move, or keep more room than their bodies need.
using TurningSearch = Sipp<TurningMotion>;

}  // namespace sipplab
