#include "planner/search/turning_search.hpp"

#include <algorithm>
#include <bit>

#include "planner/core/assert.hpp"
#include "planner/grid/heading.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/search/search_budget.hpp"

namespace sipplab {
namespace {

/// Width of a bucket of OPEN, in cells of way; as in SippSearch.
constexpr double kTurningBucketCells = 0.25;

/// What `to_goal_s` needs of an agent, apart from a search.
struct Bound {
  const Agent& agent;
  const TurningOptions& options;

  double turn_s(double from_deg, double to_deg) const {
    if (!options.rules.turns) return 0;
    return turn_deg(from_deg, to_deg) / (kHalfTurnDeg * agent.rotation_speed);
  }

  /// Bodies travel and turn one after the other, so the two bounds add up. Whoever faces
  /// `heading_deg` and goes somewhere else turns at least as far as straight there: ways
  /// whose directions all lie nearer add up to nearer directions, and beyond half a turn
  /// there is none. At the end the goal heading is faced, which bounds turns likewise.
  double operator()(Cell cell, double heading_deg_now) const {
    const double final_turn_s =
        agent.goal_heading_deg ? turn_s(heading_deg_now, *agent.goal_heading_deg) : 0.0;
    if (cell == agent.goal) return final_turn_s;
    const double cells = options.any_angle ? distance(cell, agent.goal)
                                           : neighbourhood_distance(cell, agent.goal, options.connectedness);
    const double first_turn_s =
        options.rules.turns ? turn_s(heading_deg_now, heading_deg(cell, agent.goal)) : 0.0;
    return cells / agent.speed_cells_per_s + options.rules.wait_before_move_s +
           std::max(first_turn_s, final_turn_s);
  }
};

}  // namespace

TurningSearch::TurningSearch(const Instance& instance, TurningOptions options)
    : instance_(instance),
      options_(options),
      bodies_(bodies_of(instance, {options.any_angle, options.connectedness, options.detours})),
      cell_stays_(instance.map.cell_count()) {}

double TurningSearch::lower_bound_s(AgentIndex agent) const {
  const Agent& asked = instance_.agents[agent];
  return Bound{asked, options_}(asked.start, asked.start_heading_deg);
}

Expected<Trajectory, PlanFailure> TurningSearch::plan(AgentIndex agent, ReservationTable& reservations,
                                                      const SearchLimits& limits,
                                                      SearchStatistics& statistics) {
  begin(instance_.agents[agent], reservations);
  const CellStays at_goal = stays_of(agent_->goal);
  const CellStays at_start = stays_of(agent_->start);
  if (at_goal.first == at_goal.last || stays_[at_goal.last - 1].interval.end_s < kForever ||
      at_start.first == at_start.last || stays_[at_start.first].interval.begin_s > 0) {
    return Unexpected{PlanFailure::kNoPath};
  }
  State start;
  start.cell = agent_->start;
  start.heading_deg = agent_->start_heading_deg;
  start.stay_end_s = stays_[at_start.first].interval.end_s;
  add(stays_[at_start.first], start);

  SearchBudget budget(limits);
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.pop_min();
    // No entry has a smaller f, and nobody arrives by steps before f / weight.
    if (entry.f > options_.weight * limits.latest_arrival_s) return Unexpected{PlanFailure::kNoPath};
    const NodeId id = entry.node;
    if (states_[id].dominated) continue;
    if (is_goal(states_[id])) return reconstruct(id);
    if (const auto failure = budget.take_expansion()) return Unexpected{*failure};
    ++statistics.expansions;
    expand(id, statistics);
  }
  return Unexpected{PlanFailure::kNoPath};
}

void TurningSearch::begin(const Agent& agent, ReservationTable& reservations) {
  agent_ = &agent;
  body_ = &bodies_.at(agent.radius_cells);
  if (options_.detours) body_->set_goal(agent.goal);
  reservations_ = &reservations;
  ++search_;
  stays_.clear();
  states_.clear();
  open_.begin(options_.weight * to_goal_s(agent.start, agent.start_heading_deg),
              kTurningBucketCells / agent.speed_cells_per_s);
}

TurningSearch::CellStays TurningSearch::stays_of(Cell cell) {
  CellStays& stays = cell_stays_[instance_.map.index(cell)];
  if (stays.search != search_) {
    stays.search = search_;
    stays.first = static_cast<std::uint32_t>(stays_.size());
    for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
      stays_.push_back({interval, kNoNode});
    }
    stays.last = static_cast<std::uint32_t>(stays_.size());
  }
  return stays;
}

double TurningSearch::turn_s(double from_deg, double to_deg) const {
  return Bound{*agent_, options_}.turn_s(from_deg, to_deg);
}

double TurningSearch::to_goal_s(Cell cell, double heading_deg_now) {
  const double alone_s = Bound{*agent_, options_}(cell, heading_deg_now);
  if (!options_.detours) return alone_s;
  return alone_s + body_->detour_cells(cell) / agent_->speed_cells_per_s;
}

bool TurningSearch::is_goal(const State& state) const {
  return state.cell == agent_->goal && state.stay_end_s == kForever;
}

void TurningSearch::expand(NodeId id, SearchStatistics& statistics) {
  const Cell here = states_[id].cell;
  const NodeId parent = options_.any_angle ? states_[id].parent : kNoNode;
  if (options_.any_angle) shoot(id, statistics);
  const std::span<const Cell> steps = neighbourhood(options_.connectedness);
  std::uint32_t clear = body_->clear_steps(here, instance_.map.index(here));
  for (; clear != 0; clear &= clear - 1) {
    const Cell step = steps[static_cast<std::size_t>(std::countr_zero(clear))];
    const Cell cell{here.x + step.x, here.y + step.y};
    // First from here: of two ways that arrive together the one over the nearer state
    // is kept, which leaves the cells behind it sooner.
    reach(id, cell, statistics);
    if (parent != kNoNode && states_[parent].cell != cell &&
        body_->line_of_sight.is_clear(states_[parent].cell, cell)) {
      reach(parent, cell, statistics);
    }
  }
}

void TurningSearch::shoot(NodeId from, SearchStatistics& statistics) {
  const Cell here = states_[from].cell;
  if (here == agent_->goal || !body_->line_of_sight.is_clear(here, agent_->goal)) return;
  reach(from, agent_->goal, stays_of(agent_->goal).last - 1, 0, statistics);
}

void TurningSearch::reach(NodeId from, Cell cell, SearchStatistics& statistics) {
  const CellStays targets = stays_of(cell);
  for (std::uint32_t stay = targets.first; stay != targets.last; ++stay) {
    reach(from, cell, stay, kForever, statistics);
  }
}

void TurningSearch::reach(NodeId from, Cell cell, std::uint32_t stay_index, double latest_departure_s,
                          SearchStatistics& statistics) {
  const State& origin = states_[from];
  Stay& stay = stays_[stay_index];
  const Move move(Displacement(centre(origin.cell), centre(cell)), agent_->speed_cells_per_s);
  const double direction_deg = heading_deg(origin.cell, cell);
  const double ready_s =
      origin.arrival_s + turn_s(origin.heading_deg, direction_deg) + options_.rules.wait_before_move_s;
  const double from_s = std::max(ready_s, stay.interval.begin_s - move.duration);
  const double until_s = std::min(
      {origin.stay_end_s, stay.interval.end_s - move.duration, std::max(latest_departure_s, ready_s)});
  if (from_s > until_s) return;
  const double soonest_s = std::max(from_s + move.duration, stay.interval.begin_s);
  if (is_dominated(stay, direction_deg, soonest_s)) return;
  const double departure_s = reservations_->earliest_departure(
      move, agent_->radius_cells + options_.rules.inflate_distance_cells, from_s, until_s);
  if (departure_s > until_s || departure_s == kForever) return;
  const double arrival_s = std::max(departure_s + move.duration, stay.interval.begin_s);
  if (is_dominated(stay, direction_deg, arrival_s)) return;

  ++statistics.generations;
  add(stay, {cell, direction_deg, arrival_s, departure_s, from, kNoNode, stay.interval.end_s, false});
}

bool TurningSearch::is_dominated(const Stay& stay, double heading_deg_now, double arrival_s) const {
  for (NodeId id = stay.first; id != kNoNode; id = states_[id].next) {
    const State& other = states_[id];
    if (other.arrival_s <= arrival_s &&
        other.arrival_s + turn_s(other.heading_deg, heading_deg_now) <= arrival_s) {
      return true;
    }
  }
  return false;
}

void TurningSearch::add(Stay& stay, const State& state) {
  for (NodeId* link = &stay.first; *link != kNoNode;) {
    State& other = states_[*link];
    if (state.arrival_s + turn_s(state.heading_deg, other.heading_deg) <= other.arrival_s) {
      other.dominated = true;
      *link = other.next;
    } else {
      link = &other.next;
    }
  }
  const auto id = static_cast<NodeId>(states_.size());
  states_.push_back(state);
  states_.back().next = stay.first;
  stay.first = id;
  const double ahead_s = options_.weight * to_goal_s(state.cell, state.heading_deg);
  open_.push(id, state.arrival_s + ahead_s, state.arrival_s);
}

Trajectory TurningSearch::reconstruct(NodeId goal) const {
  std::vector<NodeId> way;
  for (NodeId id = goal; id != kNoNode; id = states_[id].parent) way.push_back(id);
  std::reverse(way.begin(), way.end());
  Trajectory trajectory{agent_->start, {}};
  const auto turn = [&](const State& at, double to_deg) {
    const double end_s = at.arrival_s + turn_s(at.heading_deg, to_deg);
    if (end_s > at.arrival_s) {
      trajectory.motions.push_back({at.arrival_s, end_s, at.cell, at.cell, to_deg});
    }
    return end_s;
  };
  for (std::size_t i = 1; i < way.size(); ++i) {
    const State& from = states_[way[i - 1]];
    const State& to = states_[way[i]];
    const double turned_s = turn(from, to.heading_deg);
    if (to.departure_s > turned_s) {
      trajectory.motions.push_back({turned_s, to.departure_s, from.cell, from.cell});
    }
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell, to.cell});
  }
  const State& last = states_[goal];
  if (agent_->goal_heading_deg) turn(last, *agent_->goal_heading_deg);
  return trajectory;
}

}  // namespace sipplab
