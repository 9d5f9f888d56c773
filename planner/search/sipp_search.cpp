#include "planner/search/sipp_search.hpp"

#include <algorithm>
#include <bit>

#include "planner/core/assert.hpp"
#include "planner/grid/neighbourhood.hpp"

namespace sipplab {
namespace {

/// Width of a bucket of OPEN, in cells of way: small enough that few entries are sorted for
/// nothing, wide enough that few buckets are empty.
constexpr double kBucketCells = 0.03;

/// Seconds. Sums of durations along a way fall short of the straight one by roundings, at most by so much.
constexpr double kSoonerS = 1e-6;

/// Expansions between two looks at the clock; one takes some microseconds.
constexpr std::uint64_t kExpansionsPerClockCheck = 64;

}  // namespace

SippSearch::SippSearch(const Instance& instance, SippOptions options)
    : instance_(instance),
      options_(options),
      bodies_(bodies_of(instance, {options.any_angle, options.connectedness, options.detours})),
      cell_nodes_(arena_),
      nodes_(arena_),
      open_(arena_) {
  cell_nodes_.assign(instance.map.cell_count(), CellNodes{});
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
  nodes_[at_start.first].reach(kNoNode, 0, 0);
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
  if (options_.detours) body_->set_goal(agent_->goal);
  reservations_ = &reservations;
  ++search_;
  nodes_.clear();
  shot_blocker_ = way_blocker_ = ReservationTable::kNoDisk;
  open_.begin(options_.weight * heuristic_s(agent_->start), kBucketCells / agent_->speed_cells_per_s);
}

const SippSearch::CellNodes& SippSearch::lay_out(Cell cell) {
  CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
  nodes.search = search_;
  nodes.first = static_cast<NodeId>(nodes_.size());
  SippNode node;
  node.to_goal_s = options_.weight * heuristic_s(cell);
  node.x = static_cast<std::int16_t>(cell.x);
  node.y = static_cast<std::int16_t>(cell.y);
  const double soonest_s = travel_s(agent_->start, cell) - kSoonerS;
  for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
    if (interval.end_s < soonest_s) continue;  // nobody comes in time
    node.interval = interval;
    nodes_.push_back(node);
  }
  nodes.last = static_cast<NodeId>(nodes_.size());
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
  return seconds(cells);
}

double SippSearch::travel_s(Cell from, Cell to) const { return seconds(distance(from, to)); }

bool SippSearch::is_overtaken(const OpenList::Entry& entry) const {
  const double known_s = nodes_[entry.node].arrival_s;
  if (entry.arrival_s != known_s || !entry.is_promise()) return entry.arrival_s > known_s;
  // By steps along a straight line one may arrive sooner, by a rounding, and that way is kept.
  return entry.parent == kNoNode || !is_on_the_way(entry.parent, entry.from, entry.node);
}

bool SippSearch::is_goal(const SippNode& node) const {
  return node.cell() == agent_->goal && node.interval.end_s == kForever;
}

void SippSearch::expand(NodeId id, SearchStatistics& statistics) {
  const Cell here = nodes_[id].cell();
  const NodeId parent = options_.any_angle ? nodes_[id].parent : kNoNode;
  const Cell there = parent == kNoNode ? here : nodes_[parent].cell();
  const std::span<const Cell> steps = neighbourhood(options_.connectedness);
  std::uint32_t clear = body_->clear_steps(here, instance_.map.index(here));
  for (; clear != 0; clear &= clear - 1) {
    const auto step = static_cast<std::size_t>(std::countr_zero(clear));
    const Cell cell{here.x + steps[step].x, here.y + steps[step].y};
    const auto [search, first, last] = nodes_of(cell);
    const SippNode& near = nodes_[id];
    const double step_s = step_lengths_[step] / agent_->speed_cells_per_s;
    const double by_step_s = near.arrival_s + step_s;
    NodeId from = kNoNode;  // straight to the cell
    double straight_s = step_s;
    double soonest_s = by_step_s;
    double latest_s = near.interval.end_s + step_s;
    NodeId target = first;
    if (parent != kNoNode && there != cell) {
      // By the triangle inequality nobody arrives sooner than straight from the parent, seen or not.
      const SippNode& far = nodes_[parent];
      const double far_s = travel_s(there, cell);
      const double far_soonest_s = far.arrival_s + far_s;
      const double far_latest_s = std::max(latest_s, far.interval.end_s + far_s);
      while (target != last && !nodes_[target].may_gain(far_soonest_s)) ++target;
      if (target == last || nodes_[target].interval.begin_s > far_latest_s) continue;
      if (body_->line_of_sight.is_clear(there, cell)) {
        from = parent;
        straight_s = far_s;
        soonest_s = far_soonest_s;
        latest_s = far_latest_s;
      }
    }
    for (; target != last && nodes_[target].interval.begin_s <= latest_s; ++target) {
      const SippNode& node = nodes_[target];
      double sooner_s = soonest_s;
      if (from != kNoNode && node.knows_way_from(from, nodes_[from])) {
        sooner_s = std::min(std::max(sooner_s, node.way_departure_s + straight_s), by_step_s);
      }
      if (node.may_gain(sooner_s))
        offer(id, from, target, std::max(sooner_s, node.interval.begin_s), statistics);
    }
  }
}

void SippSearch::offer(NodeId from, NodeId parent, NodeId id, double arrival_s,
                       SearchStatistics& statistics) {
  if (options_.lazy_evaluation) {
    open_.push_promise(id, arrival_s + nodes_[id].to_goal_s, arrival_s, from, parent);
  } else if (relax(from, parent, id, statistics)) {
    open_.push(id, f(nodes_[id]), nodes_[id].arrival_s);
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
  const Cell first = nodes_[parent].cell();
  const Cell middle = nodes_[from].cell();
  const Cell last = nodes_[id].cell();
  const std::int64_t cross = std::int64_t{middle.x - first.x} * (last.y - middle.y) -
                             std::int64_t{middle.y - first.y} * (last.x - middle.x);
  const std::int64_t dot = std::int64_t{middle.x - first.x} * (last.x - middle.x) +
                           std::int64_t{middle.y - first.y} * (last.y - middle.y);
  return cross == 0 && dot > 0;
}

bool SippSearch::arrive_straight(NodeId parent, NodeId id) {
  const SippNode& origin = nodes_[parent];
  SippNode& target = nodes_[id];
  const double known_s = target.knows_way_from(parent, origin) ? target.way_departure_s : 0;
  double departure_s = 0;
  const bool arrived = arrive(parent, id, known_s, Tie::kKeep, &way_blocker_, departure_s);
  if (departure_s > 0) {
    target.way_from = parent;
    target.way_version = origin.version;
    target.way_departure_s = departure_s;
  }
  return arrived;
}

bool SippSearch::arrive(NodeId from, NodeId id, double known_s, Tie tie,
                        ReservationTable::DiskId* likely_blocker, double& departure_s) {
  const SippNode& origin = nodes_[from];
  SippNode& target = nodes_[id];
  const Vec2 begin = centre(origin.cell());
  const Vec2 end = centre(target.cell());
  const double cells = norm(end - begin);
  const double duration_s = seconds(cells);
  const double from_s = std::max({origin.arrival_s, target.interval.begin_s - duration_s, known_s});
  const double until_s =
      std::min({origin.interval.end_s, target.interval.end_s - duration_s, target.arrival_s - duration_s});
  if (from_s > until_s) return false;
  const Move move(Displacement(begin, end, {(end.x - begin.x) / cells, (end.y - begin.y) / cells}, cells),
                  agent_->speed_cells_per_s);
  departure_s = earliest_departure(move, from_s, until_s, likely_blocker);
  if (departure_s > until_s || departure_s == kForever) {
    departure_s = until_s;  // how much later depends on who is met first
    return false;
  }
  const double arrival_s = std::max(departure_s + duration_s, target.interval.begin_s);
  if (arrival_s > target.arrival_s || (arrival_s == target.arrival_s && tie == Tie::kKeep)) return false;
  target.reach(from, departure_s, arrival_s);
  return true;
}

bool SippSearch::shoot(NodeId id, SearchStatistics& statistics) {
  const SippNode& origin = nodes_[id];
  SippNode& goal = nodes_[nodes_of(agent_->goal).last - 1];
  if (origin.cell() == agent_->goal || !body_->line_of_sight.is_clear(origin.cell(), agent_->goal))
    return false;
  const Move move(Displacement(centre(origin.cell()), centre(agent_->goal)), agent_->speed_cells_per_s);
  const double departure_s = std::max(origin.arrival_s, goal.interval.begin_s - move.duration);
  if (departure_s > origin.interval.end_s) return false;
  if (earliest_departure(move, departure_s, departure_s, &shot_blocker_) > departure_s) return false;
  ++statistics.generations;
  goal.departure_s = departure_s;
  goal.arrival_s = std::max(departure_s + move.duration, goal.interval.begin_s);
  goal.parent = id;
  return true;
}

double SippSearch::earliest_departure(const Move& move, double from_s, double until_s,
                                      ReservationTable::DiskId* likely_blocker) {
  return options_.indexed_reservations
             ? reservations_->earliest_departure(move, agent_->radius_cells, from_s, until_s, likely_blocker)
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
      } else if (nodes_[before].cell() == node.cell() ||
                 !body_->line_of_sight.is_clear(nodes_[before].cell(), node.cell()) ||
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
      trajectory.motions.back().to = to.cell();
      continue;
    }
    if (waits) trajectory.motions.push_back({from.arrival_s, to.departure_s, from.cell(), from.cell()});
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell(), to.cell()});
    left = way[i - 1];
  }
  return trajectory;
}

}  // namespace sipplab
