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
  goal_from_s_ = nodes_[at_goal.last - 1].interval.begin_s;
  nodes_[at_start.first].arrival_s = 0;
  open_.push(at_start.first, f(nodes_[at_start.first]), 0);

  std::uint64_t expansions_left = limits.max_expansions;
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.pop_min();
    const NodeId id = entry.node;
    if (entry.arrival_s > nodes_[id].arrival_s) continue;  // an earlier arrival was found since
    if (is_goal(nodes_[id])) return reconstruct(id);
    if (expansions_left-- == 0) return Unexpected{PlanFailure::kExpansionLimit};
    if (limits.deadline && statistics.expansions % kExpansionsPerClockCheck == 0 &&
        std::chrono::steady_clock::now() >= *limits.deadline) {
      return Unexpected{PlanFailure::kTimeLimit};
    }
    ++statistics.expansions;
    if (options_.any_angle && options_.direct_shot && shoot(id, statistics))
      return reconstruct(at_goal.last - 1);
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

double SippSearch::f(const SippNode& node) const {
  return node.arrival_s + lower_bound_s(node.cell, agent_->goal);
}

bool SippSearch::is_goal(const SippNode& node) const {
  return node.cell == agent_->goal && node.interval.end_s == kForever;
}

void SippSearch::expand(NodeId id, SearchStatistics& statistics) {
  const Cell here = nodes_[id].cell;
  const NodeId parent = nodes_[id].parent;
  for (const Cell step : neighbourhood(options_.connectedness)) {
    const Cell cell{here.x + step.x, here.y + step.y};
    if (!line_of_sight_->is_legal(cell) || !line_of_sight_->is_clear(here, cell)) continue;
    relax(id, cell, statistics);
    if (options_.any_angle && parent != kNoNode && nodes_[parent].cell != cell &&
        line_of_sight_->is_clear(nodes_[parent].cell, cell)) {
      relax(parent, cell, statistics);
    }
  }
}

void SippSearch::relax(NodeId from, Cell cell, SearchStatistics& statistics) {
  const CellNodes targets = nodes_of(cell);
  const SippNode origin = nodes_[from];
  const Move move(Displacement(centre(origin.cell), centre(cell)), agent_->speed_cells_per_s);
  double from_s = origin.arrival_s;
  for (NodeId id = targets.first; id != targets.last; ++id) {
    SippNode& target = nodes_[id];
    // Departures that reach this interval, and among them those that improve on it.
    from_s = std::max(from_s, target.interval.begin_s - move.duration);
    if (from_s > origin.interval.end_s) return;
    const double until_s = std::min(origin.interval.end_s, target.interval.end_s - move.duration);
    if (from_s > until_s || from_s + move.duration >= target.arrival_s) continue;
    const double departure_s = earliest_departure(move, from_s, until_s);
    from_s = departure_s;  // earlier ones are unsafe for the later intervals too
    if (departure_s > until_s) continue;
    const double arrival_s = std::max(departure_s + move.duration, target.interval.begin_s);
    if (arrival_s >= target.arrival_s) continue;
    ++statistics.generations;
    target.arrival_s = arrival_s;
    target.departure_s = departure_s;
    target.parent = from;
    open_.push(id, f(target), arrival_s);
  }
}

bool SippSearch::shoot(NodeId id, SearchStatistics& statistics) {
  const SippNode origin = nodes_[id];
  if (origin.cell == agent_->goal || !line_of_sight_->is_clear(origin.cell, agent_->goal)) return false;
  const Move move(Displacement(centre(origin.cell), centre(agent_->goal)), agent_->speed_cells_per_s);
  const double departure_s = std::max(origin.arrival_s, goal_from_s_ - move.duration);
  if (departure_s > origin.interval.end_s) return false;
  if (earliest_departure(move, departure_s, departure_s) > departure_s) return false;
  ++statistics.generations;
  SippNode& goal = nodes_[nodes_of(agent_->goal).last - 1];
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
