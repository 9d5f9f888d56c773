// How kinds of robots differ: which states a search distinguishes, and when a robot that has arrived may
// depart. A compile-time policy of Sipp, so that plain robots pay nothing for headings.
#pragma once

#include <algorithm>
#include <cstdint>

#include "planner/core/arena.hpp"
#include "planner/grid/heading.hpp"
#include "planner/search/sipp_node.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A robot that departs at once, in any direction: one state for each cell and safe interval.
class PlainMotion {
 public:
  static constexpr bool kTurns = false;
  using Node = SippNode;
  using Nodes = ArenaVector<Node>;
  struct Heading {};
  struct Headings {};

  PlainMotion(const Agent&, const MotionRules&, const Headings&) {}

  static Heading heading(Cell, Cell) { return {}; }
  static Heading heading(const Node&) { return {}; }
  static Heading start_heading() { return {}; }
  /// When the robot may leave the node in this direction.
  static double ready_s(const Node& node, Heading) { return node.arrival_s; }
  /// A lower bound on the time to add to the travel from the cell to the goal.
  static double standing_s(Cell, Heading) { return 0; }
  /// The earliest known arrival in the node's safe interval with this heading, or any before `before_s`.
  static double known_s(const Nodes& nodes, NodeId id, Heading, double /*before_s*/ = 0) {
    return nodes[id].arrival_s;
  }
  /// What a node gets when it is laid out. `least_s`: the heuristic, not weighted, without turns.
  static void lay_out(Node&, NodeId, double /*least_s*/) {}
  /// The node for an earlier arrival with this heading, which it gets next.
  static NodeId node_for(Nodes&, NodeId id, Heading, double) { return id; }
  static void face(Node&, Heading) {}
  /// Adds the turn to this heading; returns its end.
  static double turn(const Node& at, Heading, Trajectory&) { return at.arrival_s; }
  static void turn_at_goal(const Node&, Trajectory&) {}
};

/// A node of a robot with a heading. Those of one cell and safe interval form a list that begins with the one
/// that was laid out.
struct TurningNode : SippNode {
  double heading_deg = 0;
  double least_s = 0;      ///< to the goal, as if without turns; not weighted
  NodeId first = kNoNode;  ///< of the list
  NodeId next = kNoNode;
};

/// A robot that turns in place before it moves, or stands for a while. A state is a cell, a safe interval, a
/// heading and an arrival: (heading a, time s) is as good as (heading b, time t) only if s plus the turn from
/// a to b is at most t. An earlier arrival with another heading is not enough.
class TurningMotion {
 public:
  static constexpr bool kTurns = true;
  using Node = TurningNode;
  using Nodes = ArenaVector<Node>;
  using Heading = double;
  using Headings = sipplab::Headings;

  /// All must outlive the searches.
  TurningMotion(const Agent& agent, const MotionRules& rules, const Headings& headings)
      : agent_(&agent),
        rules_(&rules),
        headings_(&headings),
        deg_per_s_(rules.turns ? kHalfTurnDeg * agent.rotation_speed : kForever) {}

  Heading heading(Cell from, Cell to) const { return rules_->turns ? headings_->deg(from, to) : 0; }
  Heading heading(const Node& node) const { return node.heading_deg; }
  Heading start_heading() const { return rules_->turns ? agent_->start_heading_deg : 0; }
  double ready_s(const Node& node, Heading to) const {
    return node.arrival_s + turn_s(node.heading_deg, to) + rules_->wait_before_move_s;
  }
  /// No path to the goal turns less than the straight move there: if all its moves pointed nearer to `now`,
  /// so would their sum, and no direction is more than half a turn away. The goal heading bounds turns
  /// likewise.
  double standing_s(Cell cell, Heading now) const {
    const double last_s = agent_->goal_heading_deg ? turn_s(now, *agent_->goal_heading_deg) : 0.0;
    if (cell == agent_->goal) return last_s;
    return rules_->wait_before_move_s + std::max(turn_s(now, heading(cell, agent_->goal)), last_s);
  }
  double known_s(const Nodes& nodes, NodeId id, Heading heading, double before_s = 0) const {
    if (last_.id == id && last_.heading == heading) return last_.known_s;
    double known_s = kForever;
    for (NodeId at = nodes[id].first; at != kNoNode; at = nodes[at].next) {
      const Node& node = nodes[at];
      if (node.arrival_s >= known_s) continue;  // turns take time
      known_s = std::min(known_s, node.arrival_s + turn_s(node.heading_deg, heading));
      if (known_s < before_s) return known_s;
    }
    last_ = {id, heading, known_s};
    return known_s;
  }
  static void lay_out(Node& node, NodeId id, double least_s) {
    node.first = id;
    node.least_s = least_s;
  }
  NodeId node_for(Nodes& nodes, NodeId id, Heading heading, double to_goal_s) const {
    last_.id = kNoNode;
    const NodeId first = nodes[id].first;
    if (nodes[first].arrival_s < kForever) {
      id = static_cast<NodeId>(nodes.size());
      Node node = nodes[first];
      node.arrival_s = kForever;
      nodes[first].next = id;
      nodes.push_back(node);
    }
    nodes[id].heading_deg = heading;
    nodes[id].to_goal_s = to_goal_s;
    return id;
  }
  static void face(Node& node, Heading heading) { node.heading_deg = heading; }
  double turn(const Node& at, Heading to, Trajectory& trajectory) const {
    const double end_s = at.arrival_s + turn_s(at.heading_deg, to);
    if (end_s > at.arrival_s) {
      trajectory.motions.push_back({at.arrival_s, end_s, at.cell(), at.cell(), to});
    }
    return end_s;
  }
  void turn_at_goal(const Node& at, Trajectory& trajectory) const {
    if (agent_->goal_heading_deg) turn(at, *agent_->goal_heading_deg, trajectory);
  }

 private:
  double turn_s(double from_deg, double to_deg) const { return turn_deg(from_deg, to_deg) / deg_per_s_; }

  const Agent* agent_;
  const MotionRules* rules_;
  const Headings* headings_;
  double deg_per_s_;  ///< turns take no time if there are none
  /// The last answer of known_s(), while it holds: of a lazy successor it is asked twice.
  struct Known {
    NodeId id = kNoNode;
    Heading heading = 0;
    double known_s = 0;
  };
  mutable Known last_;
};

}  // namespace sipplab
