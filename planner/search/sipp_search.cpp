// SIPP in twenty lines. A state is a cell with one of its safe intervals, the maximal closed spans of time in
// which the robot may stay there. The earliest arrival in an interval is the best, since a robot that comes
// early can wait. So A* searches a small graph although time is continuous: g is the arrival, h a lower bound
// on the time to the goal, and OPEN is ordered by f = g + weight * h.
//
// Successors are lazy. An expanded node offers its neighbours with the arrival that no obstacle delays. The
// reservation table is asked for the earliest safe departure only when such an entry is popped. If the
// arrival is as early as offered, the node is expanded at once; otherwise it is queued again with its true
// arrival. Most entries are never popped.
//
// In any-angle search a node also offers each neighbour straight from its own parent [YA17]. If both moves
// arrive together, the one from the nearer node is kept. Each expanded node tries the straight move to the
// goal (the goal shot): nothing in OPEN has a smaller f, so a shot that is not delayed ends the search. If a
// disk blocks the shot, cells beside the place where the two meet are offered; if the map does, the next
// turning point of a shortest path. Such a leg is one more successor, and replaces many steps.
//
// Guaranteed, with h a lower bound on paths by steps: the robot arrives no later than `weight` times the
// earliest arrival by steps alone, since each state of that earliest path is offered no later than on it.
// Every path found is safe against all that is reserved, contacts included. Same input, same path.
// Differs from [YA17]: departure times are exact, not tried in steps.
//
// Robots with headings have more states (motion.hpp); the search is the same.
#include "planner/search/sipp_search.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "planner/grid/neighbourhood.hpp"
#include "planner/search/detours.hpp"
#include "planner/search/sipp_tightening.hpp"

namespace sipplab {
namespace {

/// Width of a bucket of OPEN, in cells of travel: small enough that few entries are sorted for nothing, wide
/// enough that few buckets are empty.
constexpr double kBucketCells = 0.03;

/// In any-angle search without turns the heuristic is stretched by this factor, but never beyond the lower
/// bound on paths by steps: the guarantee for these stays, and fewer nodes are expanded. (Trials on the
/// paper's instances, beside 1.05 without legs: 1.05, 1.07 and 1.1 expand 0.72, 0.62 and 0.53 times as many
/// nodes on the empty map with 64 robots, for -0.13, -0.06 and +0.01 % of flowtime, and 0.97, 0.92 and 0.80
/// times as many in the warehouse with 16, for 0, 0 and +0.2 %.)
constexpr double kStretch = 1.07;

/// Disks for which legs are offered in one search. In a crowd more of them find no way either.
constexpr int kMostDisksPassed = 16;

/// Seconds. By rounding, durations along a path may sum to less than the straight one, at most by this.
constexpr double kSoonerS = 1e-6;

/// Expansions between two looks at the clock; an expansion takes some microseconds.
constexpr std::uint64_t kExpansionsPerLook = 64;

}  // namespace

template <class Motion>
Sipp<Motion>::Sipp(const Instance& instance, SippOptions options)
    : instance_(instance),
      options_(options),
      bodies_(bodies_of(instance, {options.any_angle, options.connectedness, options.static_distances})),
      motion_(Agent{}, options_.rules, headings_),
      cell_nodes_(arena_),
      nodes_(arena_),
      open_(arena_) {
  cell_nodes_.assign(instance.map.cell_count(), CellNodes{});
  for (const Cell step : neighbourhood(options.connectedness)) step_lengths_.push_back(norm(centre(step)));
}

template <class Motion>
Expected<Trajectory, PlanFailure> Sipp<Motion>::plan(AgentIndex agent, Reservations& reservations,
                                                     const SearchLimits& limits,
                                                     SearchStatistics& statistics) {
  statistics_ = &statistics;
  auto* const table = dynamic_cast<ReservationTable*>(&reservations);  // no virtual calls in the loop
  PLANNER_ASSERT(table != nullptr);
  begin(instance_.agents[agent], *table);
  const CellNodes goals = nodes_of(agent_->goal);
  const CellNodes starts = nodes_of(agent_->start);
  if (goals.first == goals.last || starts.first == starts.last) return Unexpected{PlanFailure::kNoPath};
  const SafeInterval& rest = nodes_[goals.last - 1].interval;
  if (rest.end_s < kForever || rest.begin_s > limits.latest_arrival_s ||
      nodes_[starts.first].interval.begin_s > 0) {
    return Unexpected{PlanFailure::kNoPath};
  }
  const Heading heading = motion_.start_heading();
  const NodeId start = motion_.node_for(nodes_, starts.first, heading, to_goal_s(starts.first, heading));
  nodes_[start].reach(kNoNode, 0, 0);
  open_.push(start, f(nodes_[start]), 0);

  const std::uint64_t expansions_before = statistics.expansions;
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.pop_min();
    // No entry has a smaller f, and no path by steps arrives before f / weight.
    if (entry.f > options_.weight * limits.latest_arrival_s) return Unexpected{PlanFailure::kNoPath};
    if (is_overtaken(entry)) continue;
    NodeId id = entry.node;
    if (entry.is_lazy()) {
      id = evaluate(entry.from, entry.parent, entry.node);
      if (id == kNoNode) continue;
      if (f(nodes_[id]) > entry.f) {
        open_.push(id, f(nodes_[id]), nodes_[id].arrival_s);
        continue;
      }
    }
    if (is_goal(nodes_[id])) return finish(id);
    const std::uint64_t expansions = statistics.expansions - expansions_before;
    if (expansions >= limits.max_expansions) return Unexpected{PlanFailure::kExpansionLimit};
    if (expansions % kExpansionsPerLook == 0 && limits.is_over()) return Unexpected{PlanFailure::kTimeLimit};
    ++statistics.expansions;
    if (const NodeId goal = shoot(id, id == start || entry.is_leg()); goal != kNoNode) {
      if constexpr (!Motion::kTurns) return finish(goal);
      open_.push(goal, f(nodes_[goal]), nodes_[goal].arrival_s);  // turns may come first, or last
    }
    expand(id);
  }
  return Unexpected{PlanFailure::kNoPath};
}

template <class Motion>
double Sipp<Motion>::lower_bound_s(AgentIndex agent) const {
  const Agent& asked = instance_.agents[agent];
  const Motion motion(asked, options_.rules, headings_);
  return line_cells(asked.start, asked.goal) / asked.speed_cells_per_s +
         motion.standing_s(asked.start, motion.start_heading());
}

template <class Motion>
void Sipp<Motion>::begin(const Agent& agent, ReservationTable& reservations) {
  agent_ = &agent;
  motion_ = Motion(agent, options_.rules, headings_);
  moving_radius_ = agent.radius_cells + options_.rules.inflate_distance_cells;
  body_ = &bodies_.at(agent.radius_cells);
  if (options_.static_distances) body_->set_goal(agent.goal, agent.start);
  reservations_ = &reservations;
  ++search_;
  nodes_.clear();
  disks_passed_ = 0;
  shot_blocker_ = edge_blocker_ = ReservationTable::kNoDisk;
  const double least_s = heuristic_s(agent.start) + motion_.standing_s(agent.start, motion_.start_heading());
  open_.begin(options_.weight * least_s, kBucketCells / agent.speed_cells_per_s);
}

template <class Motion>
const typename Sipp<Motion>::CellNodes& Sipp<Motion>::lay_out(Cell cell) {
  CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
  nodes.search = search_;
  nodes.first = static_cast<NodeId>(nodes_.size());
  Node node;
  const double least_s = heuristic_s(cell);
  node.to_goal_s = options_.weight * least_s;
  node.x = static_cast<std::int16_t>(cell.x);
  node.y = static_cast<std::int16_t>(cell.y);
  const double soonest_s = seconds(distance(agent_->start, cell)) - kSoonerS;
  for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
    if (interval.end_s < soonest_s) continue;  // no arrival in time
    node.interval = interval;
    motion_.lay_out(node, static_cast<NodeId>(nodes_.size()), least_s);
    nodes_.push_back(node);
  }
  nodes.last = static_cast<NodeId>(nodes_.size());
  return nodes;
}

template <class Motion>
double Sipp<Motion>::heuristic_s(Cell cell) {
  const double line = line_cells(cell, agent_->goal);
  // The start is expanded first in any case, and is often the only node.
  if (!options_.static_distances || cell == agent_->start) return seconds(line);
  const double excess = body_->excess_cells(cell);
  if (!options_.any_angle) return seconds(line + excess);
  return seconds(std::min((Motion::kTurns ? 1 : kStretch) * (line + excess),
                          body_->least_steps_cells(cell, agent_->goal, excess)));
}

template <class Motion>
bool Sipp<Motion>::is_overtaken(const OpenList::Entry& entry) const {
  const Node& node = nodes_[entry.node];
  const auto known_with = [&](Heading heading) {
    return motion_.known_s(nodes_, entry.node, heading, entry.arrival_s);
  };
  if (!entry.is_lazy()) return entry.arrival_s > known_with(motion_.heading(node));
  const double known_s = known_with(heading_of(nodes_[entry.from], node));
  if (entry.arrival_s != known_s) return entry.arrival_s > known_s;
  // Steps along a straight line may arrive sooner by rounding, and are then kept.
  return entry.parent == kNoNode || !lies_between(nodes_[entry.parent], nodes_[entry.from], node);
}

template <class Motion>
bool Sipp<Motion>::lies_between(const Node& first, const Node& middle, const Node& last) {
  const std::int32_t x = middle.x - first.x, y = middle.y - first.y;
  const std::int32_t next_x = last.x - middle.x, next_y = last.y - middle.y;
  return std::int64_t{x} * next_y == std::int64_t{y} * next_x &&
         std::int64_t{x} * next_x + std::int64_t{y} * next_y > 0;
}

template <class Motion>
typename Sipp<Motion>::Edge Sipp<Motion>::edge(NodeId from, Cell to, double cells) const {
  const Node& node = nodes_[from];
  const double travel_s = seconds(cells);
  const Heading heading = motion_.heading(node.cell(), to);
  return {from, heading, travel_s, motion_.ready_s(node, heading) + travel_s, node.interval.end_s + travel_s};
}

template <class Motion>
void Sipp<Motion>::expand(NodeId id) {
  const Cell here = nodes_[id].cell();
  const NodeId parent = options_.any_angle ? nodes_[id].parent : kNoNode;
  const Cell there = parent == kNoNode ? here : nodes_[parent].cell();
  const std::span<const Cell> steps = neighbourhood(options_.connectedness);
  std::uint32_t clear = body_->clear_steps(here, instance_.map.index(here));
  for (; clear != 0; clear &= clear - 1) {
    const auto index = static_cast<std::size_t>(std::countr_zero(clear));
    const Cell cell{here.x + steps[index].x, here.y + steps[index].y};
    const CellNodes& targets = nodes_of(cell);
    const Edge step = edge(id, cell, step_lengths_[index]);
    if (parent == kNoNode || there == cell) {
      offer(step, kNoNode, targets.first, targets.last);
      continue;
    }
    Edge straight = edge(parent, cell, distance(there, cell));
    if constexpr (Motion::kTurns) {
      // The two arrive with different headings: each is a separate successor.
      offer(step, kNoNode, targets.first, targets.last);
      if (body_->line_of_sight.is_clear(there, cell)) {
        offer(straight, kNoNode, targets.first, targets.last);
      }
    } else {
      // By the triangle inequality the step is never sooner than the straight move, clear or not.
      straight.latest_s = std::max(step.latest_s, straight.latest_s);
      NodeId target = targets.first;
      while (target != targets.last && !may_gain(target, straight.heading, straight.soonest_s)) ++target;
      if (target == targets.last || nodes_[target].interval.begin_s > straight.latest_s) continue;
      if (body_->line_of_sight.is_clear(there, cell)) {
        straight.from = id;
        straight.step_soonest_s = step.soonest_s;
        offer(straight, parent, target, targets.last);
      } else {
        offer(step, kNoNode, target, targets.last);
      }
    }
  }
}

template <class Motion>
void Sipp<Motion>::offer(const Edge& edge, NodeId parent, NodeId target, NodeId last) {
  const NodeId asked = Motion::kTurns ? edge.from : parent;
  for (; target != last && nodes_[target].interval.begin_s <= edge.latest_s; ++target) {
    const Node& node = nodes_[target];
    double soonest_s = edge.soonest_s;
    if (asked != kNoNode && node.knows_edge_from(asked, nodes_[asked])) {
      soonest_s = std::min(std::max(soonest_s, node.edge_departure_s + edge.travel_s), edge.step_soonest_s);
    }
    if (!may_gain(target, edge.heading, soonest_s)) continue;
    soonest_s = std::max(soonest_s, node.interval.begin_s);
    open_.push_lazy(target, soonest_s + to_goal_s(target, edge.heading), soonest_s, edge.from, parent);
  }
}

template <class Motion>
NodeId Sipp<Motion>::evaluate(NodeId from, NodeId parent, NodeId id) {
  if (from == parent || Motion::kTurns) {  // with headings each move is a successor of its own
    const NodeId reached = arrive_straight(from, id);
    if (reached != kNoNode) ++statistics_->generations;
    return reached;
  }
  // If both moves arrive together, the one from the nearer node is kept: it leaves the cells behind it sooner
  // (trials on the paper's warehouse: 1 % less flowtime).
  const bool between = parent != kNoNode && lies_between(nodes_[parent], nodes_[from], nodes_[id]);
  NodeId reached = kNoNode;
  if (parent != kNoNode && !between) reached = arrive_straight(parent, id);
  const NodeId by_step = arrive_by_step(from, id, reached == kNoNode ? Tie::kKeep : Tie::kReplace);
  if (by_step != kNoNode) reached = by_step;
  // Without a wait the step is as good as the straight move.
  if (between && (by_step == kNoNode || nodes_[by_step].departure_s != nodes_[from].arrival_s)) {
    if (const NodeId straight = arrive_straight(parent, id); straight != kNoNode) reached = straight;
  }
  if (reached != kNoNode) ++statistics_->generations;
  return reached;
}

template <class Motion>
NodeId Sipp<Motion>::arrive_straight(NodeId from, NodeId id) {
  const std::uint16_t version = nodes_[from].version;
  const Node& target = nodes_[id];
  const double known_s = target.knows_edge_from(from, nodes_[from]) ? target.edge_departure_s : 0;
  double departure_s = 0;
  const NodeId reached = arrive(from, id, known_s, Tie::kKeep, &edge_blocker_, departure_s);
  if (departure_s > 0) nodes_[id].know_edge_from(from, version, departure_s);
  return reached;
}

template <class Motion>
NodeId Sipp<Motion>::arrive(NodeId from, NodeId id, double known_s, Tie tie,
                            ReservationTable::DiskId* likely_blocker, double& departure_s) {
  const Heading heading = heading_of(nodes_[from], nodes_[id]);
  const double arrived_s = motion_.known_s(nodes_, id, heading);
  double arrival_s = 0;
  if (!leg(nodes_[from], nodes_[id], known_s, arrived_s, likely_blocker, departure_s, arrival_s) ||
      (arrival_s == arrived_s && tie == Tie::kKeep)) {
    return kNoNode;
  }
  const NodeId reached = motion_.node_for(nodes_, id, heading, to_goal_s(id, heading));
  nodes_[reached].reach(from, departure_s, arrival_s);
  return reached;
}

template <class Motion>
bool Sipp<Motion>::leg(const Node& from, const Node& to, double known_s, double latest_s,
                       ReservationTable::DiskId* likely_blocker, double& departure_s, double& arrival_s) {
  const Vec2 begin = centre(from.cell());
  const Vec2 end = centre(to.cell());
  const double cells = norm(end - begin);
  const double duration_s = seconds(cells);
  const double from_s =
      std::max({motion_.ready_s(from, heading_of(from, to)), to.interval.begin_s - duration_s, known_s});
  const double until_s =
      std::min({from.interval.end_s, to.interval.end_s - duration_s, latest_s - duration_s});
  if (from_s > until_s) return false;
  const Move move(Displacement(begin, end, {(end.x - begin.x) / cells, (end.y - begin.y) / cells}, cells),
                  agent_->speed_cells_per_s);
  departure_s = reservations_->earliest_departure(move, moving_radius_, from_s, until_s, likely_blocker);
  if (departure_s > until_s || departure_s == kForever) {
    departure_s = until_s;  // how much later depends on the disk met first
    return false;
  }
  arrival_s = std::max(departure_s + duration_s, to.interval.begin_s);
  return arrival_s <= latest_s;
}

template <class Motion>
NodeId Sipp<Motion>::shoot(NodeId id, bool after_leg) {
  const NodeId goal = nodes_of(agent_->goal).last - 1;
  const Node& origin = nodes_[id];
  if (!options_.any_angle || origin.cell() == agent_->goal) return kNoNode;
  if (!body_->line_of_sight.is_clear(origin.cell(), agent_->goal)) {
    if (after_leg && options_.static_distances) offer_leg(id, body_->turning_point(origin.cell()));
    return kNoNode;
  }
  const double rest_s = nodes_[goal].interval.begin_s;
  const Move move(Displacement(centre(origin.cell()), centre(agent_->goal)), agent_->speed_cells_per_s);
  const Heading heading = heading_of(origin, nodes_[goal]);
  const double departure_s = std::max(motion_.ready_s(origin, heading), rest_s - move.duration);
  if (departure_s > origin.interval.end_s) return kNoNode;
  const double arrival_s = std::max(departure_s + move.duration, rest_s);
  if (Motion::kTurns && arrival_s >= motion_.known_s(nodes_, goal, heading)) return kNoNode;
  if (disks_passed_ < kMostDisksPassed) {
    shot_blocker_ = reservations_->blocker(move, moving_radius_, departure_s, shot_blocker_);
    if (shot_blocker_ != ReservationTable::kNoDisk) {
      turn_aside(id, move, departure_s);
      return kNoNode;
    }
  }
  if (reservations_->earliest_departure(move, moving_radius_, departure_s, departure_s, &shot_blocker_) >
      departure_s) {
    return kNoNode;
  }
  ++statistics_->generations;
  const NodeId reached = motion_.node_for(nodes_, goal, heading, to_goal_s(goal, heading));
  nodes_[reached].departure_s = departure_s;
  nodes_[reached].arrival_s = arrival_s;
  nodes_[reached].parent = id;
  return reached;
}

template <class Motion>
void Sipp<Motion>::turn_aside(NodeId id, const Move& move, double departure_s) {
  if (shot_blocker_ >= passed_in_.size()) passed_in_.resize(shot_blocker_ + 1, 0);
  if (std::exchange(passed_in_[shot_blocker_], search_) == search_) return;
  ++disks_passed_;
  const MovingDisk& disk = reservations_->disk(shot_blocker_);
  Detours(move, departure_s, disk, moving_radius_ + disk.radius).for_each([&](Cell cell) {
    if (body_->line_of_sight.is_legal(cell)) offer_leg(id, cell);
  });
}

template <class Motion>
void Sipp<Motion>::offer_leg(NodeId from, Cell to) {
  const Cell here = nodes_[from].cell();
  if (to == here || !body_->line_of_sight.is_clear(here, to)) return;
  const CellNodes& targets = nodes_of(to);
  offer(edge(from, to, distance(here, to)), from, targets.first, targets.last);
}

template class Sipp<PlainMotion>;
template class Sipp<TurningMotion>;

}  // namespace sipplab
