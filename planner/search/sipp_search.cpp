#include "planner/search/sipp_search.hpp"

#include <algorithm>
#include <bit>

#include "planner/core/assert.hpp"
#include "planner/grid/neighbourhood.hpp"

namespace sipplab {
namespace {

/// Width of a bucket of OPEN, in cells of way: small enough that few entries are sorted for
/// nothing, wide enough that few buckets are empty.
constexpr double kBucketCells = 0.1;

/// Expansions between two looks at the clock; one takes some microseconds.
constexpr std::uint64_t kExpansionsPerClockCheck = 64;

}  // namespace

SippSearch::SippSearch(const Instance& instance, SippOptions options)
    : instance_(instance),
      options_(options),
      bodies_(bodies_of(instance, {options.any_angle, options.connectedness, options.detours})),
      cell_nodes_(instance.map.cell_count()) {
  for (const Cell step : neighbourhood(options.connectedness)) step_lengths_.push_back(norm(centre(step)));
}

Expected<Trajectory, PlanFailure> SippSearch::plan(AgentIndex agent, ReservationTable& reservations,
                                                   const SearchLimits& limits, SearchStatistics& statistics) {
  begin(agent, reservations);
  const CellNodes at_goal = nodes_of(agent_->goal);
  const CellNodes at_start = nodes_of(agent_->start);
  if (at_goal.first == at_goal.last || nodes_[at_goal.last - 1].interval.end_s < kForever ||
      at_start.first == at_start.last || nodes_[at_start.first].interval.begin_s > 0) {
    return Unexpected{PlanFailure::kNoPath};
  }
  if (nodes_[at_goal.last - 1].interval.begin_s > limits.latest_arrival_s) {
    return Unexpected{PlanFailure::kNoPath};
  }
  nodes_[at_start.first].arrival_s = 0;
  open_.push(at_start.first, f(nodes_[at_start.first]), 0);

  const std::uint64_t expansions_before = statistics.expansions;
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.pop_min();
    const NodeId id = entry.node;
    // No entry has a smaller f, and nobody arrives by steps before f / weight.
    if (entry.f > options_.weight * limits.latest_arrival_s) return Unexpected{PlanFailure::kNoPath};
    if (is_overtaken(entry)) continue;
    if (entry.is_promise()) {
      if (!relax(entry.from, entry.parent, id, statistics)) continue;
      // Kept to the letter, the promise makes its node the next one of OPEN at once.
      if (f(nodes_[id]) > entry.f) {
        open_.push(id, f(nodes_[id]), nodes_[id].arrival_s);
        continue;
      }
    }
    if (is_goal(nodes_[id])) return finish(id);
    if (statistics.expansions - expansions_before >= limits.max_expansions) {
      return Unexpected{PlanFailure::kExpansionLimit};
    }
    if (statistics.expansions % kExpansionsPerClockCheck == 0 && limits.is_over()) {
      return Unexpected{PlanFailure::kTimeLimit};
    }
    ++statistics.expansions;
    if (options_.any_angle && options_.direct_shot && shoot(id, statistics)) {
      return finish(at_goal.last - 1);
    }
    expand(id, statistics);
  }
  return Unexpected{PlanFailure::kNoPath};
}

double SippSearch::lower_bound_s(AgentIndex agent) const {
  const Agent& asked = instance_.agents[agent];
  const double cells = options_.any_angle
                           ? distance(asked.start, asked.goal)
                           : neighbourhood_distance(asked.start, asked.goal, options_.connectedness);
  return cells / asked.speed_cells_per_s;
}

void SippSearch::begin(AgentIndex agent, ReservationTable& reservations) {
  agent_ = &instance_.agents[agent];
  body_ = &bodies_.at(agent_->radius_cells);
  if (options_.detours) body_->set_goal(agent_->goal, agent_->start);
  reservations_ = &reservations;
  ++search_;
  nodes_.clear();
  straight_ways_.clear();
  shot_blocker_ = ReservationTable::kNoDisk;
  open_.begin(options_.weight * heuristic_s(agent_->start), kBucketCells / agent_->speed_cells_per_s);
}

SippSearch::CellNodes SippSearch::nodes_of(Cell cell) {
  CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
  if (nodes.search != search_) {
    nodes.search = search_;
    nodes.first = static_cast<NodeId>(nodes_.size());
    const double to_goal_s = options_.weight * heuristic_s(cell);
    for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
      nodes_.push_back({interval, kForever, 0, to_goal_s, cell, kNoNode});
    }
    straight_ways_.resize(nodes_.size());
    nodes.last = static_cast<NodeId>(nodes_.size());
  }
  return nodes;
}

double SippSearch::heuristic_s(Cell cell) {
  const double line_s = lower_bound_s(cell, agent_->goal);
  // The start is expanded first whatever it says, and is often the only one.
  if (!options_.detours || cell == agent_->start) return line_s;
  return line_s + body_->detour_cells(cell) / agent_->speed_cells_per_s;
}

double SippSearch::lower_bound_s(Cell from, Cell to) const {
  const double cells =
      options_.any_angle ? distance(from, to) : neighbourhood_distance(from, to, options_.connectedness);
  return cells / agent_->speed_cells_per_s;
}

double SippSearch::travel_s(Cell from, Cell to) const {
  return distance(from, to) / agent_->speed_cells_per_s;
}

bool SippSearch::is_overtaken(const OpenList::Entry& entry) const {
  const double known_s = nodes_[entry.node].arrival_s;
  if (entry.arrival_s != known_s || !entry.is_promise()) return entry.arrival_s > known_s;
  // By steps along a straight line one may arrive sooner, by a rounding, and that way is kept.
  return entry.parent == kNoNode || !is_on_the_way(entry.parent, entry.from, entry.node);
}

bool SippSearch::is_goal(const SippNode& node) const {
  return node.cell == agent_->goal && node.interval.end_s == kForever;
}

void SippSearch::expand(NodeId id, SearchStatistics& statistics) {
  const Cell here = nodes_[id].cell;
  const NodeId parent = options_.any_angle ? nodes_[id].parent : kNoNode;
  const std::span<const Cell> steps = neighbourhood(options_.connectedness);
  std::uint32_t clear = body_->clear_steps(here, instance_.map.index(here));
  for (; clear != 0; clear &= clear - 1) {
    const auto step = static_cast<std::size_t>(std::countr_zero(clear));
    const Cell cell{here.x + steps[step].x, here.y + steps[step].y};
    const bool straight = parent != kNoNode && nodes_[parent].cell != cell &&
                          body_->line_of_sight.is_clear(nodes_[parent].cell, cell);
    offer(id, straight ? parent : kNoNode, cell, step_lengths_[step] / agent_->speed_cells_per_s, statistics);
  }
}

void SippSearch::offer(NodeId from, NodeId parent, Cell cell, double step_s, SearchStatistics& statistics) {
  const CellNodes targets = nodes_of(cell);
  const SippNode& near = nodes_[from];
  const SippNode& far = nodes_[parent == kNoNode ? from : parent];
  const double straight_s = parent == kNoNode ? step_s : travel_s(far.cell, cell);
  const double latest_s = std::max(near.interval.end_s + step_s, far.interval.end_s + straight_s);
  for (NodeId id = targets.first; id != targets.last; ++id) {
    const SippNode& target = nodes_[id];
    if (target.interval.begin_s > latest_s) return;
    // By the triangle inequality nobody arrives sooner than straight from the parent.
    double soonest_s = far.arrival_s + straight_s;
    if (const StraightWay& way = straight_ways_[id];
        way.from == parent && parent != kNoNode && way.from_arrival_s == far.arrival_s) {
      soonest_s = std::min(std::max(soonest_s, way.departure_s + straight_s), near.arrival_s + step_s);
    }
    const double arrival_s = std::max(soonest_s, target.interval.begin_s);
    if (arrival_s > target.interval.end_s || arrival_s >= target.arrival_s) continue;
    if (options_.lazy_evaluation) {
      open_.push_promise(id, arrival_s + target.to_goal_s, arrival_s, from, parent);
    } else if (relax(from, parent, id, statistics)) {
      open_.push(id, f(target), target.arrival_s);
    }
  }
}

bool SippSearch::relax(NodeId from, NodeId parent, NodeId id, SearchStatistics& statistics) {
  // Of two ways that arrive together the one over the nearer node is kept: it leaves the
  // cells behind it sooner (trials on the paper's warehouse: 1 % less flowtime).
  bool improved = false;
  if (parent == kNoNode) {
    improved = arrive_by_step(from, id, Tie::kKeep);
  } else if (is_on_the_way(parent, from, id)) {
    improved = arrive_by_step(from, id, Tie::kKeep);
    // Without a wait the step is as good as the straight way.
    const SippNode& target = nodes_[id];
    const bool at_once = improved && target.departure_s == nodes_[from].arrival_s;
    if (!at_once) improved = arrive_straight(parent, id) || improved;
  } else {
    improved = arrive_straight(parent, id);
    improved = arrive_by_step(from, id, improved ? Tie::kReplace : Tie::kKeep) || improved;
  }
  if (improved) ++statistics.generations;
  return improved;
}

bool SippSearch::is_on_the_way(NodeId parent, NodeId from, NodeId id) const {
  const Cell first = nodes_[parent].cell;
  const Cell middle = nodes_[from].cell;
  const Cell last = nodes_[id].cell;
  const std::int64_t cross = std::int64_t{middle.x - first.x} * (last.y - middle.y) -
                             std::int64_t{middle.y - first.y} * (last.x - middle.x);
  const std::int64_t dot = std::int64_t{middle.x - first.x} * (last.x - middle.x) +
                           std::int64_t{middle.y - first.y} * (last.y - middle.y);
  return cross == 0 && dot > 0;
}

bool SippSearch::arrive_straight(NodeId parent, NodeId id) {
  const SippNode& origin = nodes_[parent];
  const SippNode& target = nodes_[id];
  StraightWay& known = straight_ways_[id];
  const double duration_s = travel_s(origin.cell, target.cell);
  double from_s = std::max(origin.arrival_s, target.interval.begin_s - duration_s);
  if (known.from == parent && known.from_arrival_s == origin.arrival_s) {
    from_s = std::max(from_s, known.departure_s);
  }
  const double until_s = latest_departure_s(origin, target, duration_s);
  if (from_s > until_s) return false;
  const Move move(Displacement(centre(origin.cell), centre(target.cell)), agent_->speed_cells_per_s);
  const double departure_s = earliest_departure(move, from_s, until_s);
  known = {parent, origin.arrival_s, departure_s};
  return departure_s <= until_s && arrive(parent, id, departure_s, duration_s, Tie::kKeep);
}

bool SippSearch::arrive_by_step(NodeId from, NodeId id, Tie tie) {
  const SippNode& origin = nodes_[from];
  const SippNode& target = nodes_[id];
  const double duration_s = travel_s(origin.cell, target.cell);
  const double from_s = std::max(origin.arrival_s, target.interval.begin_s - duration_s);
  const double until_s = latest_departure_s(origin, target, duration_s);
  if (from_s > until_s) return false;
  const Move move(Displacement(centre(origin.cell), centre(target.cell)), agent_->speed_cells_per_s);
  const double departure_s = earliest_departure(move, from_s, until_s);
  return departure_s <= until_s && arrive(from, id, departure_s, duration_s, tie);
}

double SippSearch::latest_departure_s(const SippNode& origin, const SippNode& target,
                                      double duration_s) const {
  return std::min({origin.interval.end_s, target.interval.end_s - duration_s, target.arrival_s - duration_s});
}

bool SippSearch::arrive(NodeId from, NodeId id, double departure_s, double duration_s, Tie tie) {
  SippNode& target = nodes_[id];
  if (departure_s == kForever) return false;
  const double arrival_s = std::max(departure_s + duration_s, target.interval.begin_s);
  if (arrival_s > target.arrival_s || (arrival_s == target.arrival_s && tie == Tie::kKeep)) return false;
  target.arrival_s = arrival_s;
  target.departure_s = departure_s;
  target.parent = from;
  return true;
}

bool SippSearch::shoot(NodeId id, SearchStatistics& statistics) {
  const SippNode& origin = nodes_[id];
  const NodeId goal_id = nodes_of(agent_->goal).last - 1;
  SippNode& goal = nodes_[goal_id];
  if (origin.cell == agent_->goal || !body_->line_of_sight.is_clear(origin.cell, agent_->goal)) return false;
  const Move move(Displacement(centre(origin.cell), centre(agent_->goal)), agent_->speed_cells_per_s);
  const double departure_s = std::max(origin.arrival_s, goal.interval.begin_s - move.duration);
  if (departure_s > origin.interval.end_s) return false;
  const double safe_s = options_.indexed_reservations
                            ? reservations_->earliest_departure(move, agent_->radius_cells, departure_s,
                                                                departure_s, &shot_blocker_)
                            : earliest_departure(move, departure_s, departure_s);
  if (safe_s > departure_s) return false;
  ++statistics.generations;
  goal.departure_s = departure_s;
  goal.arrival_s = std::max(departure_s + move.duration, goal.interval.begin_s);
  goal.parent = id;
  return true;
}

double SippSearch::earliest_departure(const Move& move, double from_s, double until_s) {
  return options_.indexed_reservations
             ? reservations_->earliest_departure(move, agent_->radius_cells, from_s, until_s)
             : reservations_->earliest_departure_plain(move, agent_->radius_cells, from_s, until_s);
}

Trajectory SippSearch::finish(NodeId goal) {
  const std::vector<NodeId> way = way_to(goal);
  if (!options_.any_angle || !options_.straighten || options_.weight == 1) return reconstruct(way);
  straighten(way);
  return reconstruct(way_to(goal));
}

std::vector<NodeId> SippSearch::way_to(NodeId goal) const {
  std::vector<NodeId> way;
  for (NodeId id = goal; id != kNoNode; id = nodes_[id].parent) way.push_back(id);
  std::reverse(way.begin(), way.end());
  return way;
}

void SippSearch::straighten(std::span<const NodeId> way) {
  bool is_earlier = false;  // at the node before
  for (const NodeId id : way.subspan(1)) {
    SippNode& node = nodes_[id];
    const double found_s = node.arrival_s;
    if (is_earlier) arrive_straight(node.parent, id);
    for (NodeId bend = node.parent; nodes_[bend].parent != kNoNode; bend = node.parent) {
      const NodeId before = nodes_[bend].parent;
      if (node.departure_s == nodes_[bend].arrival_s && is_on_the_way(before, bend, id)) {
        node.parent = before;
        node.departure_s = nodes_[bend].departure_s;
      } else if (nodes_[before].cell == node.cell ||
                 !body_->line_of_sight.is_clear(nodes_[before].cell, node.cell) ||
                 !arrive_straight(before, id)) {
        break;
      }
    }
    is_earlier = node.arrival_s < found_s;
  }
}

Trajectory SippSearch::reconstruct(std::span<const NodeId> way) const {
  Trajectory trajectory{agent_->start, {}};
  NodeId left = kNoNode;  // where the last motion began
  for (std::size_t i = 1; i < way.size(); ++i) {
    const SippNode& from = nodes_[way[i - 1]];
    const SippNode& to = nodes_[way[i]];
    const bool waits = to.departure_s > from.arrival_s;
    if (options_.any_angle && left != kNoNode && !waits && is_on_the_way(left, way[i - 1], way[i])) {
      trajectory.motions.back().end_s = to.arrival_s;
      trajectory.motions.back().to = to.cell;
      continue;
    }
    if (waits) trajectory.motions.push_back({from.arrival_s, to.departure_s, from.cell, from.cell});
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell, to.cell});
    left = way[i - 1];
  }
  return trajectory;
}

}  // namespace sipplab
