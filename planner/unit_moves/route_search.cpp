#include "planner/unit_moves/route_search.hpp"

#include <algorithm>

#include "sipplab/error.hpp"

namespace sipplab {

SharedDistances::SharedDistances(const FreeGrid& grid, const std::vector<CellId>& starts,
                                 const std::vector<CellId>& goals)
    : distances_(grid, goals), starts_(starts) {
  moves_.reserve(starts.size());
  for (RobotId robot = 0; robot < starts.size(); ++robot) {
    const auto moves = distances_.first_distance(robot, starts[robot]);
    PLANNER_ASSERT(moves.has_value());
    moves_.push_back(static_cast<Tick>(*moves));
  }
}

RouteSearch::RouteSearch(const UnitMoves& moves, SharedDistances& distances)
    : moves_(moves), distances_(distances), gaps_(moves.grid().size()), reached_in_(moves.grid().size(), 0) {}

std::optional<Route> RouteSearch::find(RobotId robot, const Timetable& others, Tick latest,
                                       std::uint64_t most_expansions) {
  const CellId goal = distances_.goal(robot);
  const auto at_goal = others.stays(goal);
  if (distances_.least_arrival(robot) > latest) return std::nullopt;
  if (!at_goal.empty() && at_goal.back().departure + moves_.least_lag() > latest) return std::nullopt;
  SharedDistances::OfRobot distances = distances_.of(robot);
  begin();
  least_ = distances_.least_arrival(robot);
  reach({distances_.start(robot), 0, 0, distances_.moves(robot), kNoNode}, others);
  const std::uint64_t last = expansions_ + most_expansions;
  for (NodeId id = pop(); id != kNoNode; id = pop()) {
    const Node& node = nodes_[id];
    if (best_[gaps_[node.cell] + node.gap] != id)
      continue;  // an earlier arrival was found after this was queued
    if (node.cell == goal && node.gap == at_goal.size()) return route_to(id);
    if (++expansions_ > last) return std::nullopt;
    expand(id, others, distances, latest);
  }
  return std::nullopt;
}

void RouteSearch::begin() {
  nodes_.clear();
  best_.clear();
  for (std::vector<NodeId>& bucket : open_) bucket.clear();
  bucket_ = 0;
  ++search_;
}

void RouteSearch::expand(NodeId id, const Timetable& others, SharedDistances::OfRobot& distances,
                         Tick latest) {
  const Node from = nodes_[id];
  const Stay& next = others.borders(from.cell)[from.gap + 1];
  const auto is_nearer = distances.nearer_than(from.cell);
  const Tick begin = from.arrival + kMoveTicks;
  for (Direction direction = 0; direction < kDirections; ++direction) {
    const CellId cell = moves_.next(from.cell, direction);
    if (cell == kNoCell) continue;
    const Tick left = from.left + (is_nearer(cell) ? -1 : 1);
    const Tick end =
        std::min(latest - left * kMoveTicks, next.arrival - moves_.lag(direction, next.entered) + kMoveTicks);
    if (end < begin) continue;
    // In each gap the earliest arrival, if the robot can go on before the next one comes.
    const Stay* const borders = others.borders(cell);
    const auto last_gap = static_cast<std::uint32_t>(others.stays(cell).size());
    auto gap = static_cast<std::uint32_t>(others.first_from(cell, begin + moves_.least_lag()));
    for (; gap <= last_gap; ++gap) {
      const Stay& before = borders[gap];
      const Tick arrival = std::max(begin, before.departure + moves_.lag(before.left, direction));
      if (arrival > end) break;
      if (arrival + moves_.least_lag() <= borders[gap + 1].arrival) {
        reach({cell, gap, arrival, left, id}, others);
      }
    }
  }
}

void RouteSearch::reach(const Node& node, const Timetable& others) {
  if (reached_in_[node.cell] != search_) {
    reached_in_[node.cell] = search_;
    gaps_[node.cell] = static_cast<std::uint32_t>(best_.size());
    best_.resize(best_.size() + others.stays(node.cell).size() + 1, kNoNode);
  }
  NodeId& best = best_[gaps_[node.cell] + node.gap];
  if (best != kNoNode && nodes_[best].arrival <= node.arrival) return;
  best = static_cast<NodeId>(nodes_.size());
  nodes_.push_back(node);
  ++generations_;
  push(best, node.arrival + node.left * kMoveTicks);
}

void RouteSearch::push(NodeId id, Tick estimate) {
  const auto bucket = static_cast<std::size_t>((estimate - least_) / kBucketTicks);
  if (bucket >= open_.size()) open_.resize(bucket + 1);
  open_[bucket].push_back(id);
}

RouteSearch::NodeId RouteSearch::pop() {
  while (bucket_ < open_.size() && open_[bucket_].empty()) ++bucket_;
  if (bucket_ == open_.size()) return kNoNode;
  const NodeId id = open_[bucket_].back();
  open_[bucket_].pop_back();
  return id;
}

Route RouteSearch::route_to(NodeId id) const {
  Route route;
  for (; id != kNoNode; id = nodes_[id].parent) route.push_back({nodes_[id].cell, nodes_[id].arrival});
  std::reverse(route.begin(), route.end());
  return route;
}

}  // namespace sipplab
