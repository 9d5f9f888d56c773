#include "planner/search/sipp_search.hpp"

#include <algorithm>

#include "planner/core/assert.hpp"
#include "planner/grid/neighbourhood.hpp"

namespace sipplab {
namespace {

/// Expansions between two looks at the clock; one takes some microseconds.
constexpr std::uint64_t kExpansionsPerClockCheck = 64;

}  // namespace

SippSearch::SippSearch(const Instance& instance, SippOptions options)
    : instance_(instance), options_(options), cell_nodes_(instance.map.cell_count()) {
  for (const Agent& agent : instance.agents) {
    const auto known = std::find_if(lines_of_sight_.begin(), lines_of_sight_.end(), [&](const auto& other) {
      return other->radius_cells() == agent.radius_cells;
    });
    if (known == lines_of_sight_.end()) {
      lines_of_sight_.push_back(std::make_unique<LineOfSight>(instance.map, agent.radius_cells));
      line_of_sight_of_.push_back(lines_of_sight_.back().get());
    } else {
      line_of_sight_of_.push_back(known->get());
    }
  }
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
  nodes_[at_start.first].arrival_s = 0;
  open_.push(at_start.first, f(nodes_[at_start.first]), 0);

  const std::uint64_t expansions_before = statistics.expansions;
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.pop_min();
    const NodeId id = entry.node;
    if (entry.is_promise()) {
      if (!relax(entry.from, entry.parent, id, statistics)) continue;
      // Kept to the letter, the promise makes its node the next one of OPEN at once.
      if (f(nodes_[id]) > entry.f) {
        open_.push(id, f(nodes_[id]), nodes_[id].arrival_s);
        continue;
      }
    } else if (entry.arrival_s > nodes_[id].arrival_s) {
      continue;  // an earlier arrival was found after this was queued
    }
    if (is_goal(nodes_[id])) return reconstruct(id);
    if (statistics.expansions - expansions_before >= limits.max_expansions) {
      return Unexpected{PlanFailure::kExpansionLimit};
    }
    if (limits.deadline && statistics.expansions % kExpansionsPerClockCheck == 0 &&
        std::chrono::steady_clock::now() >= *limits.deadline) {
      return Unexpected{PlanFailure::kTimeLimit};
    }
    ++statistics.expansions;
    if (options_.any_angle && options_.direct_shot && shoot(id, statistics)) {
      return reconstruct(at_goal.last - 1);
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
  line_of_sight_ = line_of_sight_of_[agent];
  reservations_ = &reservations;
  ++search_;
  nodes_.clear();
  open_.clear();
}

SippSearch::CellNodes SippSearch::nodes_of(Cell cell) {
  CellNodes& nodes = cell_nodes_[instance_.map.index(cell)];
  if (nodes.search != search_) {
    nodes.search = search_;
    nodes.first = static_cast<NodeId>(nodes_.size());
    for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
      nodes_.push_back({cell, interval, kForever, 0, kNoNode});
    }
    nodes.last = static_cast<NodeId>(nodes_.size());
  }
  return nodes;
}

double SippSearch::lower_bound_s(Cell from, Cell to) const {
  const double cells =
      options_.any_angle ? distance(from, to) : neighbourhood_distance(from, to, options_.connectedness);
  return cells / agent_->speed_cells_per_s;
}

double SippSearch::travel_s(Cell from, Cell to) const {
  return distance(from, to) / agent_->speed_cells_per_s;
}

double SippSearch::f(const SippNode& node) const {
  return node.arrival_s + lower_bound_s(node.cell, agent_->goal);
}

bool SippSearch::is_goal(const SippNode& node) const {
  return node.cell == agent_->goal && node.interval.end_s == kForever;
}

void SippSearch::expand(NodeId id, SearchStatistics& statistics) {
  const Cell here = nodes_[id].cell;
  for (const Cell step : neighbourhood(options_.connectedness)) {
    const Cell cell{here.x + step.x, here.y + step.y};
    if (!line_of_sight_->is_legal(cell) || !line_of_sight_->is_clear(here, cell)) continue;
    const NodeId parent = options_.any_angle ? nodes_[id].parent : kNoNode;
    const bool straight = parent != kNoNode && nodes_[parent].cell != cell &&
                          line_of_sight_->is_clear(nodes_[parent].cell, cell);
    offer(id, straight ? parent : kNoNode, cell, statistics);
  }
}

void SippSearch::offer(NodeId from, NodeId parent, Cell cell, SearchStatistics& statistics) {
  const CellNodes targets = nodes_of(cell);
  // By the triangle inequality nobody arrives sooner than straight from the parent.
  const SippNode& near = nodes_[from];
  const SippNode& far = nodes_[parent == kNoNode ? from : parent];
  const double soonest_s = far.arrival_s + travel_s(far.cell, cell);
  const double latest_s = std::max(near.interval.end_s + travel_s(near.cell, cell),
                                   far.interval.end_s + travel_s(far.cell, cell));
  const double to_goal_s = lower_bound_s(cell, agent_->goal);
  for (NodeId id = targets.first; id != targets.last; ++id) {
    const SippNode& target = nodes_[id];
    if (target.interval.begin_s > latest_s) return;
    const double arrival_s = std::max(soonest_s, target.interval.begin_s);
    if (arrival_s > target.interval.end_s || arrival_s >= target.arrival_s) continue;
    if (options_.lazy_evaluation) {
      open_.push_promise(id, arrival_s + to_goal_s, arrival_s, from, parent);
    } else if (relax(from, parent, id, statistics)) {
      open_.push(id, f(target), target.arrival_s);
    }
  }
}

bool SippSearch::relax(NodeId from, NodeId parent, NodeId id, SearchStatistics& statistics) {
  const bool straight = parent != kNoNode && arrive(parent, id, Tie::kKeep);
  // Of two ways that arrive together the one over the nearer node is kept: it leaves the
  // cells behind it sooner (trials on the paper's warehouse: 1 % less flowtime).
  const bool stepwise = arrive(from, id, straight ? Tie::kReplace : Tie::kKeep);
  if (!straight && !stepwise) return false;
  ++statistics.generations;
  return true;
}

bool SippSearch::arrive(NodeId from, NodeId id, Tie tie) {
  const SippNode& origin = nodes_[from];
  SippNode& target = nodes_[id];
  const Move move(Displacement(centre(origin.cell), centre(target.cell)), agent_->speed_cells_per_s);
  // Departures that reach this interval, and among them those that improve on it.
  const double from_s = std::max(origin.arrival_s, target.interval.begin_s - move.duration);
  const double until_s = std::min(
      {origin.interval.end_s, target.interval.end_s - move.duration, target.arrival_s - move.duration});
  if (from_s > until_s) return false;
  const double departure_s = earliest_departure(move, from_s, until_s);
  if (departure_s > until_s || departure_s == kForever) return false;
  const double arrival_s = std::max(departure_s + move.duration, target.interval.begin_s);
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
  if (origin.cell == agent_->goal || !line_of_sight_->is_clear(origin.cell, agent_->goal)) return false;
  const Move move(Displacement(centre(origin.cell), centre(agent_->goal)), agent_->speed_cells_per_s);
  const double departure_s = origin.arrival_s;
  if (departure_s + move.duration < goal.interval.begin_s) return false;
  if (earliest_departure(move, departure_s, departure_s) > departure_s) return false;
  ++statistics.generations;
  goal.departure_s = departure_s;
  goal.arrival_s = departure_s + move.duration;
  goal.parent = id;
  return true;
}

double SippSearch::earliest_departure(const Move& move, double from_s, double until_s) {
  return options_.indexed_reservations
             ? reservations_->earliest_departure(move, agent_->radius_cells, from_s, until_s)
             : reservations_->earliest_departure_plain(move, agent_->radius_cells, from_s, until_s);
}

Trajectory SippSearch::reconstruct(NodeId goal) const {
  std::vector<NodeId> way;
  for (NodeId id = goal; id != kNoNode; id = nodes_[id].parent) way.push_back(id);
  std::reverse(way.begin(), way.end());
  Trajectory trajectory{agent_->start, {}};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const SippNode& from = nodes_[way[i - 1]];
    const SippNode& to = nodes_[way[i]];
    if (to.departure_s > from.arrival_s) {
      trajectory.motions.push_back({from.arrival_s, to.departure_s, from.cell, from.cell});
    }
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell, to.cell});
  }
  return trajectory;
}

}  // namespace sipplab
