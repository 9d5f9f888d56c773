#include "planner/complete/pibt.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

namespace sipplab {
namespace {

/// What a move costs in a row of pushes. Of the first robot: to stay, to go away from its goal, and what a
/// quarter of a step that it gains is worth; others go before it only if they are pushed, so that these are
/// high.
constexpr std::uint32_t kStayCost = 28;
constexpr std::uint32_t kAwayCost = 120;
constexpr std::uint32_t kGainValue = 4;
constexpr std::uint32_t kMostGainValue = kGainValue * kDearestMoveCost;
/// Of each other one: to move at all, away from its goal, from its goal itself; of every robot: to follow
/// around a corner.
constexpr std::uint32_t kPushedCost = 1;
constexpr std::uint32_t kPushedAwayCost = 2;
constexpr std::uint32_t kPushedHomeCost = 1;
constexpr std::uint32_t kTurnCost = 2;
/// Ties, and choices that are nearly ties, are left to chance, or robots push each other back and forth.
constexpr std::uint64_t kChanceCosts = 4;
constexpr int kChanceBits = 2;

/// Out of a cell, other than to the one that a robot comes from: two robots can pass each other there.
constexpr std::size_t kWaysToPass = 2;

}  // namespace

Pibt::Pibt(const FreeGrid& grid, GoalDistances& distances, bool prefer_free_cells, std::uint64_t seed)
    : grid_(grid),
      distances_(distances),
      prefer_free_cells_(prefer_free_cells),
      random_(seed),
      robot_at_(grid.size(), kNoRobot),
      taken_by_(grid.size(), kNoRobot),
      reached_(grid.size()),
      searched_(grid.size(), 0),
      is_narrow_(grid.size()) {
  for (CellId cell = 0; cell < grid.size(); ++cell) {
    for (const CellId next : grid.neighbours(cell)) {
      // With robots at their goals in all dead ends there.
      std::size_t ways = 0;
      for (const CellId on : grid.neighbours(next)) ways += on != cell && grid.neighbours(on).size() > 1;
      if (ways < kWaysToPass) is_narrow_[cell] = true;
    }
  }
}

StepOutcome Pibt::make_step(const Configuration& now, std::span<const RobotId> order,
                            std::span<const StepConstraint> constraints, Configuration& next) {
  now_ = &now;
  next_ = &next;
  next.assign(now.size(), kNoCell);
  for (RobotId robot = 0; robot < now.size(); ++robot) robot_at_[now[robot]] = robot;

  StepOutcome outcome = assign_all(constraints) ? StepOutcome::kFound : StepOutcome::kContradiction;
  for (std::size_t i = 0; outcome == StepOutcome::kFound && i < order.size(); ++i) {
    if (is_assigned(order[i])) continue;
    if (!(pushes_cheaply_ ? push(order[i]) : move(order[i]))) outcome = StepOutcome::kNotFound;
  }

  for (RobotId robot = 0; robot < now.size(); ++robot) {
    robot_at_[now[robot]] = kNoRobot;
    if (is_assigned(robot)) taken_by_[next[robot]] = kNoRobot;
  }
  return outcome;
}

bool Pibt::assign_all(std::span<const StepConstraint> constraints) {
  for (const StepConstraint& constraint : constraints) {
    if (taken_by_[constraint.cell] != kNoRobot) return false;
    if (closes_ring((*now_)[constraint.robot], constraint.cell)) return false;
    assign(constraint.robot, constraint.cell);
  }
  return true;
}

/// A stack instead of recursion: a row of pushed robots can be as long as there are robots.
bool Pibt::move(RobotId root) {
  choices_.clear();
  choices_.push_back(begin_choice(root));
  while (!choices_.empty()) {
    Choice& choice = choices_.back();
    if (!reserve_candidate(choice)) {
      assign(choice.robot, (*now_)[choice.robot]);  // in vain: the robot that pushed it tries another cell
      choices_.pop_back();
      continue;
    }
    const RobotId pushed = robot_in_the_way(choice);
    if (pushed != kNoRobot) {
      choices_.push_back(begin_choice(pushed));
      continue;
    }
    // The last of the row found a cell, so all of them did.
    for (std::size_t i = choices_.size(); i-- > 0;) pull_swap_partner(choices_[i]);
    return true;
  }
  return false;
}

/// The cheapest row of pushes (Dijkstra 1959): the robot goes to a neighbour, who is there to the next cell,
/// and so on to a cell that is free, or that a robot leaves.
bool Pibt::push(RobotId root) {
  choices_.clear();
  const CellId here = (*now_)[root];
  if (is_narrow_[here] && begin_choice(root).swap_partner != kNoRobot) return move(root);
  std::uint64_t chance = random_.next();
  const auto draw = [&chance] {
    chance = std::rotr(chance, kChanceBits);
    return static_cast<std::uint32_t>(chance % kChanceCosts);
  };
  ++search_;
  ends_.clear();
  least_cost_ = UINT32_MAX;
  if (taken_by_[here] == kNoRobot) add_end({kMostGainValue + kStayCost, here, here});
  for (const CellId cell : grid_.neighbours(here)) {
    const int gained = gain(root, here, cell);
    const std::uint32_t cost = gained > 0 ? kMostGainValue - kGainValue * static_cast<std::uint32_t>(gained)
                                          : kMostGainValue + kAwayCost;
    extend_row(here, kNoCell, here, cell, cost + draw());
  }
  while (!ends_.empty()) {
    std::pop_heap(ends_.begin(), ends_.end(), std::greater<>());
    const RowEnd end = ends_.back();
    ends_.pop_back();
    if (end.cell == here) {
      assign(root, here);
      return true;
    }
    if (reached_[end.cell].cost < end.cost) continue;  // by a cheaper row since
    if (is_free(end.cell)) {
      for (CellId to = end.cell; to != here; to = reached_[to].from) assign(robot_at_[reached_[to].from], to);
      return true;
    }
    const RobotId robot = robot_at_[end.cell];
    const std::uint32_t leaving =
        end.cost + kPushedCost + (end.cell == distances_.goal(robot) ? kPushedHomeCost : 0);
    for (const CellId cell : grid_.neighbours(end.cell)) {
      const std::uint32_t away = gain(robot, end.cell, cell) > 0 ? 0 : kPushedAwayCost;
      extend_row(here, end.from, end.cell, cell, leaving + away + draw());
    }
  }
  return false;
}

/// The robot at `from`, which came from `before`, may go `to` the next cell; `root_cell` is where the row
/// begins.
void Pibt::extend_row(CellId root_cell, CellId before, CellId from, CellId to, std::uint32_t cost) {
  ++cells_seen_;
  if (to == root_cell || taken_by_[to] != kNoRobot) return;
  if (before != kNoCell && is_turn(before, from, to)) cost += kTurnCost;
  if (const RobotId other = robot_at_[to]; other != kNoRobot && is_assigned(other)) {
    if (closes_ring(root_cell, to)) return;
    if (is_turn(from, to, (*next_)[other])) cost += kTurnCost;
  }
  if (cost >= least_cost_ || (searched_[to] == search_ && reached_[to].cost <= cost)) return;
  searched_[to] = search_;
  reached_[to] = {cost, to, from};
  add_end(reached_[to]);
}

void Pibt::add_end(const RowEnd& end) {
  if (end.cell == end.from || is_free(end.cell)) least_cost_ = end.cost;
  ends_.push_back(end);
  std::push_heap(ends_.begin(), ends_.end(), std::greater<>());
}

bool Pibt::is_turn(CellId a, CellId b, CellId c) const {
  const Cell one = grid_.cell(a);
  const Cell middle = grid_.cell(b);
  const Cell other = grid_.cell(c);
  return one.x + other.x != 2 * middle.x || one.y + other.y != 2 * middle.y;
}

Pibt::Choice Pibt::begin_choice(RobotId robot) {
  // By gain; the robot's own cell before those that are farther away. Ties: free cells, then those where it
  // hinders fewer, then chance.
  constexpr unsigned kTieBits = 12;
  constexpr std::uint64_t kTieMask = (1u << kTieBits) - 1;
  constexpr unsigned kSecondBits = 3;
  constexpr auto kMostGain = static_cast<int>(kDearestMoveCost);
  const CellId here = (*now_)[robot];
  cells_seen_ += kMaxCandidates;
  std::uint64_t ties = random_.next();
  Choice choice;
  choice.robot = robot;
  std::array<std::uint32_t, kMaxCandidates> ranks{};
  const auto insert = [&](std::uint32_t rank, CellId cell) {
    std::uint32_t at = choice.count++;
    for (; at > 0 && ranks[at - 1] > rank; --at) {
      ranks[at] = ranks[at - 1];
      choice.candidates[at] = choice.candidates[at - 1];
    }
    ranks[at] = rank;
    choice.candidates[at] = cell;
  };
  const auto rank_of = [](int gain, bool stays) {
    return static_cast<std::uint32_t>(2 * (kMostGain - gain) + (gain < 0 || stays ? 1 : 0)) << kSecondBits;
  };
  insert(rank_of(0, true) << kTieBits, here);
  for (const CellId cell : grid_.neighbours(here)) {
    const std::uint32_t occupied = prefer_free_cells_ && robot_at_[cell] != kNoRobot ? 4 : 0;
    const std::uint32_t rank = rank_of(gain(robot, here, cell), false) + occupied + hindrance(robot, cell);
    insert(rank << kTieBits | static_cast<std::uint32_t>(ties & kTieMask), cell);
    ties >>= kTieBits;
  }

  choice.swap_partner = swap_partner(robot, choice.candidates[0]);
  if (choice.swap_partner != kNoRobot) {
    std::reverse(choice.candidates.begin(), choice.candidates.begin() + choice.count);
  }
  return choice;
}

std::uint32_t Pibt::hindrance(RobotId robot, CellId cell) const {
  if (guide_ == nullptr) return 0;
  std::uint32_t hindered = 0;
  for (const CellId next : grid_.neighbours(cell)) {
    const RobotId other = robot_at_[next];
    hindered += other != kNoRobot && other != robot && gain(other, next, cell) > 0;
  }
  return hindered;
}

bool Pibt::reserve_candidate(Choice& choice) {
  const CellId here = (*now_)[choice.robot];
  while (choice.tried < choice.count) {
    const CellId cell = choice.candidates[choice.tried++];
    if (taken_by_[cell] != kNoRobot || closes_ring(here, cell)) continue;
    assign(choice.robot, cell);
    return true;
  }
  return false;
}

RobotId Pibt::robot_in_the_way(const Choice& choice) const {
  const RobotId other = robot_at_[(*next_)[choice.robot]];
  return other == choice.robot || other == kNoRobot || is_assigned(other) ? kNoRobot : other;
}

/// Follows the moves assigned so far from the wanted cell; a ring is closed where they come
/// back to the robot that wants it. Two robots that change places are the smallest ring.
bool Pibt::closes_ring(CellId from, CellId to) const {
  while (to != from) {
    const RobotId robot = robot_at_[to];
    if (robot == kNoRobot || !is_assigned(robot) || (*next_)[robot] == to) return false;
    to = (*next_)[robot];
    if (to == from) return true;
  }
  return false;
}

/// [LC23]: the partner follows at once, so that the two get out of the narrow place together.
void Pibt::pull_swap_partner(const Choice& choice) {
  const RobotId partner = choice.swap_partner;
  if (partner == kNoRobot || choice.tried != 1 || is_assigned(partner)) return;
  const CellId left = (*now_)[choice.robot];
  if (taken_by_[left] != kNoRobot || closes_ring((*now_)[partner], left)) return;
  assign(partner, left);
}

/// [LC23], "swap_possible_and_required".
RobotId Pibt::swap_partner(RobotId robot, CellId wanted) const {
  const CellId here = (*now_)[robot];
  if (wanted == here || side_steps(here, wanted).paths >= kWaysToPass) return kNoRobot;
  const RobotId opposite = robot_at_[wanted];
  if (opposite != kNoRobot && !is_assigned(opposite) && is_swap_required(robot, opposite, here, wanted) &&
      is_swap_possible(wanted, here)) {
    return opposite;
  }
  // The robot may have to clear the way for one next to it.
  for (const CellId cell : grid_.neighbours(here)) {
    const RobotId beside = robot_at_[cell];
    if (beside == kNoRobot || cell == wanted) continue;
    if (is_swap_required(beside, robot, here, wanted) && is_swap_possible(wanted, here)) return beside;
  }
  return kNoRobot;
}

/// Ways out of the puller's cell other than to the pusher, dead ends whose robot has arrived
/// left out.
Pibt::SideStep Pibt::side_steps(CellId pusher_cell, CellId puller_cell) const {
  SideStep steps;
  for (const CellId cell : grid_.neighbours(puller_cell)) {
    if (cell == pusher_cell) continue;
    const RobotId robot = robot_at_[cell];
    const bool settled = robot != kNoRobot && distances_.goal(robot) == cell;
    if (settled && grid_.neighbours(cell).size() == 1) continue;
    ++steps.paths;
    steps.cell = cell;
  }
  return steps;
}

/// Whether the pusher, following the puller along a narrow place, comes to want its place.
bool Pibt::is_swap_required(RobotId pusher, RobotId puller, CellId pusher_cell, CellId puller_cell) const {
  while (distances_.is_nearer(pusher, pusher_cell, puller_cell)) {
    const SideStep steps = side_steps(pusher_cell, puller_cell);
    if (steps.paths >= kWaysToPass) return false;
    if (steps.paths == 0) break;
    pusher_cell = std::exchange(puller_cell, steps.cell);
  }
  return distances_.is_nearer(puller, puller_cell, pusher_cell) &&
         (pusher_cell == distances_.goal(pusher) || distances_.is_nearer(pusher, pusher_cell, puller_cell));
}

/// Whether the puller, going away from the pusher and pulling it along, comes to a place where the two can
/// pass each other.
bool Pibt::is_swap_possible(CellId pusher_cell, CellId puller_cell) const {
  const CellId begin = pusher_cell;
  while (puller_cell != begin) {
    const SideStep steps = side_steps(pusher_cell, puller_cell);
    if (steps.paths >= kWaysToPass) return true;
    if (steps.paths == 0) return false;
    pusher_cell = std::exchange(puller_cell, steps.cell);
  }
  return false;
}

}  // namespace sipplab
