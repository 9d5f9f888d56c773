// SIPP in twenty lines. A state is a cell together with one of its safe intervals, the maximal closed spans
// of time in which the robot may stay there; of all arrivals in one interval the earliest is the best, since
// whoever comes early can wait. So A* runs over a small graph although time is continuous: g is the arrival,
// h the time to the goal at least, and OPEN is ordered by f = g + weight * h.
//
// Successors are lazy. An expanded node offers its neighbours with the arrival that no obstacle delays; only
// when such an entry comes up is the reservation table asked for the earliest safe departure. If the arrival
// is as early as offered the node is expanded at once, else it is queued again with what it is worth. Most
// entries never come up.
//
// At any angle a node also offers each neighbour straight from its own parent [YA17]. Of two ways that arrive
// together the one over the nearer node is kept. From each expanded node the goal is tried straight (the goal
// shot): nothing in OPEN is smaller than its f, so a shot that is not delayed ends the search.
//
// What is guaranteed, with h a lower bound on ways by steps: nobody arrives later than `weight` times the
// earliest arrival by steps alone, for each state of the earliest way by steps is offered no later than on
// it. Ways that are found are safe against all that is reserved, contacts included. Same input, same way.
// Departures from [YA17]: they are exact, not tried in steps.
//
// Robots with headings have more states (motion.hpp); the search is the same.
#include "planner/search/sipp_search.hpp"

#include <algorithm>
#include <bit>

#include "planner/grid/neighbourhood.hpp"

namespace sipplab {
namespace {

/// Width of a bucket of OPEN, in cells of way: small enough that few entries are sorted for
/// nothing, wide enough that few buckets are empty.
constexpr double kBucketCells = 0.03;

/// Seconds. Sums of durations along a way fall short of the straight one by roundings, at most by so much.
constexpr double kSoonerS = 1e-6;

/// Expansions between two looks at the clock; one takes some microseconds.
constexpr std::uint64_t kExpansionsPerLook = 64;

}  // namespace

template <class Motion>
Sipp<Motion>::Sipp(const Instance& instance, SippOptions options)
    : instance_(instance),
      options_(options),
      bodies_(bodies_of(instance, {options.any_angle, options.connectedness, options.detours})),
      motion_(Agent{}, options_.rules),
      cell_nodes_(arena_),
      nodes_(arena_),
      open_(arena_) {
  cell_nodes_.assign(instance.map.cell_count(), CellNodes{});
  for (const Cell step : neighbourhood(options.connectedness)) step_lengths_.push_back(norm(centre(step)));
}

template <class Motion>
Expected<Trajectory, PlanFailure> Sipp<Motion>::plan(AgentIndex agent, ReservationTable& reservations,
                                                     const SearchLimits& limits,
                                                     SearchStatistics& statistics) {
  statistics_ = &statistics;
  begin(instance_.agents[agent], reservations);
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
    // No entry has a smaller f, and nobody arrives by steps before f / weight.
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
    if (const NodeId goal = shoot(id); goal != kNoNode) {
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
  const Motion motion(asked, options_.rules);
  return line_cells(asked.start, asked.goal) / asked.speed_cells_per_s +
         motion.standing_s(asked.start, motion.start_heading());
}

template <class Motion>
void Sipp<Motion>::begin(const Agent& agent, ReservationTable& reservations) {
  agent_ = &agent;
  motion_ = Motion(agent, options_.rules);
  moving_radius_ = agent.radius_cells + options_.rules.inflate_distance_cells;
  body_ = &bodies_.at(agent.radius_cells);
  if (options_.detours) body_->set_goal(agent.goal);
  reservations_ = &reservations;
  ++search_;
  nodes_.clear();
  shot_blocker_ = way_blocker_ = ReservationTable::kNoDisk;
  const double least_s = heuristic_s(agent.start) + motion_.standing_s(agent.start, motion_.start_heading());
  open_.begin(options_.weight * least_s, kBucketCells / agent.speed_cells_per_s);
}

template <class Motion>
const typename Sipp<Motion>::CellNodes& Sipp<Motion>::lay_out(Cell cell) {
  CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
  nodes.search = search_;
  nodes.first = static_cast<NodeId>(nodes_.size());
  Node node;
  node.to_goal_s = options_.weight * heuristic_s(cell);
  node.x = static_cast<std::int16_t>(cell.x);
  node.y = static_cast<std::int16_t>(cell.y);
  const double soonest_s = seconds(distance(agent_->start, cell)) - kSoonerS;
  for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
    if (interval.end_s < soonest_s) continue;  // nobody comes in time
    node.interval = interval;
    if constexpr (Motion::kTurns) node.first = static_cast<NodeId>(nodes_.size());
    nodes_.push_back(node);
  }
  nodes.last = static_cast<NodeId>(nodes_.size());
  return nodes;
}

template <class Motion>
double Sipp<Motion>::heuristic_s(Cell cell) {
  const double line_s = seconds(line_cells(cell, agent_->goal));
  // The start is expanded first whatever it says, and is often the only one.
  if (!options_.detours || cell == agent_->start) return line_s;
  return line_s + body_->detour_cells(cell) / agent_->speed_cells_per_s;
}

template <class Motion>
bool Sipp<Motion>::is_overtaken(const OpenList::Entry& entry) const {
  const Node& node = nodes_[entry.node];
  if (!entry.is_lazy()) return entry.arrival_s > motion_.known_s(nodes_, entry.node, motion_.heading(node));
  const double known_s = motion_.known_s(nodes_, entry.node, heading_of(entry.from, entry.node));
  if (entry.arrival_s != known_s) return entry.arrival_s > known_s;
  // By steps along a straight line one may arrive sooner, by a rounding, and that way is kept.
  return entry.parent == kNoNode || !is_on_the_way(entry.parent, entry.from, entry.node);
}

template <class Motion>
bool Sipp<Motion>::is_on_the_way(NodeId parent, NodeId from, NodeId id) const {
  const Cell first = nodes_[parent].cell();
  const Cell middle = nodes_[from].cell();
  const Cell last = nodes_[id].cell();
  const std::int64_t cross = std::int64_t{middle.x - first.x} * (last.y - middle.y) -
                             std::int64_t{middle.y - first.y} * (last.x - middle.x);
  const std::int64_t dot = std::int64_t{middle.x - first.x} * (last.x - middle.x) +
                           std::int64_t{middle.y - first.y} * (last.y - middle.y);
  return cross == 0 && dot > 0;
}

template <class Motion>
typename Sipp<Motion>::Way Sipp<Motion>::way(NodeId from, Cell to, double cells) const {
  const Node& node = nodes_[from];
  const double travel_s = cells / agent_->speed_cells_per_s;
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
    const Way step = way(id, cell, step_lengths_[index]);
    if (parent == kNoNode || there == cell) {
      offer(step, kNoNode, targets.first, targets.last);
      continue;
    }
    Way straight = way(parent, cell, distance(there, cell));
    if constexpr (Motion::kTurns) {
      // The two arrive with two headings: each is a successor of its own.
      offer(step, kNoNode, targets.first, targets.last);
      if (body_->line_of_sight.is_clear(there, cell)) {
        offer(straight, kNoNode, targets.first, targets.last);
      }
    } else {
      // By the triangle inequality nobody arrives sooner than straight from the parent, seen or not.
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
void Sipp<Motion>::offer(const Way& way, NodeId parent, NodeId target, NodeId last) {
  for (; target != last && nodes_[target].interval.begin_s <= way.latest_s; ++target) {
    const Node& node = nodes_[target];
    double soonest_s = way.soonest_s;
    if (parent != kNoNode && node.knows_way_from(parent, nodes_[parent])) {
      soonest_s = std::min(std::max(soonest_s, node.way_departure_s + way.travel_s), way.step_soonest_s);
    }
    if (!may_gain(target, way.heading, soonest_s)) continue;
    soonest_s = std::max(soonest_s, node.interval.begin_s);
    open_.push_lazy(target, soonest_s + to_goal_s(target, way.heading), soonest_s, way.from, parent);
  }
}

template <class Motion>
NodeId Sipp<Motion>::evaluate(NodeId from, NodeId parent, NodeId id) {
  // Of two ways that arrive together the one over the nearer node is kept: it leaves the
  // cells behind it sooner (trials on the paper's warehouse: 1 % less flowtime).
  const bool on_the_way = parent != kNoNode && is_on_the_way(parent, from, id);
  NodeId reached = kNoNode;
  if (parent != kNoNode && !on_the_way) reached = arrive_straight(parent, id);
  const NodeId by_step = arrive_by_step(from, id, reached == kNoNode ? Tie::kKeep : Tie::kReplace);
  if (by_step != kNoNode) reached = by_step;
  // Without a wait the step is as good as the straight way.
  if (on_the_way && (by_step == kNoNode || nodes_[by_step].departure_s != nodes_[from].arrival_s)) {
    if (const NodeId straight = arrive_straight(parent, id); straight != kNoNode) reached = straight;
  }
  if (reached != kNoNode) ++statistics_->generations;
  return reached;
}

template <class Motion>
NodeId Sipp<Motion>::arrive_straight(NodeId parent, NodeId id) {
  const std::uint16_t version = nodes_[parent].version;
  const Node& target = nodes_[id];
  const double known_s = target.knows_way_from(parent, nodes_[parent]) ? target.way_departure_s : 0;
  double departure_s = 0;
  const NodeId reached = arrive(parent, id, known_s, Tie::kKeep, &way_blocker_, departure_s);
  if (departure_s > 0) nodes_[id].know_way_from(parent, version, departure_s);
  return reached;
}

template <class Motion>
NodeId Sipp<Motion>::arrive(NodeId from, NodeId id, double known_s, Tie tie,
                            ReservationTable::DiskId* likely_blocker, double& departure_s) {
  const Node& origin = nodes_[from];
  const Node& target = nodes_[id];
  const Vec2 begin = centre(origin.cell());
  const Vec2 end = centre(target.cell());
  const double cells = norm(end - begin);
  const double duration_s = seconds(cells);
  const Heading heading = heading_of(from, id);
  const double arrived_s = motion_.known_s(nodes_, id, heading);
  const double from_s =
      std::max({motion_.ready_s(origin, heading), target.interval.begin_s - duration_s, known_s});
  const double until_s =
      std::min({origin.interval.end_s, target.interval.end_s - duration_s, arrived_s - duration_s});
  if (from_s > until_s) return kNoNode;
  const Move move(Displacement(begin, end, {(end.x - begin.x) / cells, (end.y - begin.y) / cells}, cells),
                  agent_->speed_cells_per_s);
  departure_s = reservations_->earliest_departure(move, moving_radius_, from_s, until_s, likely_blocker);
  if (departure_s > until_s || departure_s == kForever) {
    departure_s = until_s;  // how much later depends on who is met first
    return kNoNode;
  }
  const double arrival_s = std::max(departure_s + duration_s, target.interval.begin_s);
  if (arrival_s > arrived_s || (arrival_s == arrived_s && tie == Tie::kKeep)) return kNoNode;
  const NodeId reached = motion_.node_for(nodes_, id, heading, to_goal_s(id, heading));
  nodes_[reached].reach(from, departure_s, arrival_s);
  return reached;
}

template <class Motion>
NodeId Sipp<Motion>::shoot(NodeId id) {
  const NodeId goal = nodes_of(agent_->goal).last - 1;
  const Node& origin = nodes_[id];
  if (!options_.any_angle || origin.cell() == agent_->goal ||
      !body_->line_of_sight.is_clear(origin.cell(), agent_->goal)) {
    return kNoNode;
  }
  const double rest_s = nodes_[goal].interval.begin_s;
  const Move move(Displacement(centre(origin.cell()), centre(agent_->goal)), agent_->speed_cells_per_s);
  const Heading heading = heading_of(id, goal);
  const double departure_s = std::max(motion_.ready_s(origin, heading), rest_s - move.duration);
  if (departure_s > origin.interval.end_s) return kNoNode;
  const double arrival_s = std::max(departure_s + move.duration, rest_s);
  if (Motion::kTurns && arrival_s >= motion_.known_s(nodes_, goal, heading)) return kNoNode;
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
Trajectory Sipp<Motion>::finish(NodeId goal) {
  const std::vector<NodeId> way = way_to(goal);
  if (Motion::kTurns || !options_.any_angle || !options_.straighten || options_.weight == 1) {
    return reconstruct(way);
  }
  straighten(way);
  return reconstruct(way_to(goal));
}

template <class Motion>
std::vector<NodeId> Sipp<Motion>::way_to(NodeId goal) const {
  std::vector<NodeId> way;
  for (NodeId id = goal; id != kNoNode; id = nodes_[id].parent) way.push_back(id);
  std::reverse(way.begin(), way.end());
  return way;
}

template <class Motion>
void Sipp<Motion>::straighten(std::span<const NodeId> way) {
  bool is_earlier = false;  // at the node before
  for (const NodeId id : way.subspan(1)) {
    Node& node = nodes_[id];
    const double found_s = node.arrival_s;
    if (is_earlier) arrive_straight(node.parent, id);
    for (NodeId bend = node.parent; nodes_[bend].parent != kNoNode; bend = node.parent) {
      const NodeId before = nodes_[bend].parent;
      if (node.departure_s == nodes_[bend].arrival_s && is_on_the_way(before, bend, id)) {
        node.parent = before;
        node.departure_s = nodes_[bend].departure_s;
      } else if (nodes_[before].cell() == node.cell() ||
                 !body_->line_of_sight.is_clear(nodes_[before].cell(), node.cell()) ||
                 arrive_straight(before, id) == kNoNode) {
        break;
      }
    }
    is_earlier = node.arrival_s < found_s;
  }
}

template <class Motion>
Trajectory Sipp<Motion>::reconstruct(std::span<const NodeId> way) const {
  Trajectory trajectory{agent_->start, {}};
  NodeId left = kNoNode;  // where the last motion began
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Node& from = nodes_[way[i - 1]];
    const Node& to = nodes_[way[i]];
    const double ready_s = motion_.turn(from, motion_.heading(from.cell(), to.cell()), trajectory);
    if (options_.any_angle && left != kNoNode && to.departure_s == from.arrival_s &&
        is_on_the_way(left, way[i - 1], way[i])) {
      trajectory.motions.back().end_s = to.arrival_s;
      trajectory.motions.back().to = to.cell();
      continue;
    }
    if (to.departure_s > ready_s) {
      trajectory.motions.push_back({ready_s, to.departure_s, from.cell(), from.cell()});
    }
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell(), to.cell()});
    left = way[i - 1];
  }
  motion_.turn_at_goal(nodes_[way.back()], trajectory);
  return trajectory;
}

template class Sipp<PlainMotion>;
template class Sipp<TurningMotion>;

}  // namespace sipplab
