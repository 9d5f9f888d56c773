#include "planner/complete/lacam.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace sipplab {
namespace {

using NodeId = std::uint32_t;
constexpr NodeId kNoNode = UINT32_MAX;

/// Robots on this share of the free cells, or more, do not look for free cells first. With fewer
/// that saves a tenth to a fifth of the flowtime (empty map of 32 x 32 cells, 320 to 880 robots);
/// with 950 robots it costs twice the time of search. They keep places at the rim, too.
constexpr double kCrowdedShare = 0.9;

/// Longest paths after which robots go by plain distances: those that are left then stand in each other's
/// way, and ways around traffic that is over keep them from getting past each other.
constexpr std::uint64_t kGuidedLengths = 2;

/// Searches with cheap rows of pushes before one with others. (Flowtime of 950 robots on the empty map of 32
/// x 32 cells, one to three: 1,068,000, 893,000, 823,000 s.)
constexpr std::size_t kCheapSearches = 3;

/// Steps in which no more robots got to their goals than ever before, after which rows of pushes are those of
/// [PIBT] for the rest of the search.
constexpr std::uint64_t kPatienceSteps = 20;

/// Constraints on one step out of a configuration: this one and those of all ancestors in
/// the configuration's tree of constraints. [LC22], section 3.
struct ConstraintNode {
  std::uint32_t parent = 0;
  std::uint32_t depth = 0;  ///< robots constrained; 0 for the root
  StepConstraint constraint;
};

/// A configuration, and which of its steps were tried.
struct Node {
  Configuration cells;
  /// Steps since each robot was last at its goal: the latest goes first. [PIBT].
  std::vector<std::uint32_t> late_steps;
  NodeId parent = kNoNode;
  std::vector<ConstraintNode> constraints;  ///< breadth first
  std::size_t next_constraint = 0;
};

/// Equal configurations have equal hashes; others seldom do.
std::uint64_t hash_of(const Configuration& cells) {
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio, odd
  std::uint64_t hash = cells.size();
  for (const CellId cell : cells) {
    hash = (hash ^ cell) * kFactor;
    hash ^= hash >> 32;
  }
  return hash;
}

/// Steps. In a crowd robots at the rim stay where they belong for so long before others push
/// them, in one search and in the next by turns. On the empty map of 32 x 32 cells the first is
/// faster with 950 robots, the second with 1,000; 100 is too many with both.
constexpr std::array<std::uint32_t, 2> kCrowdLateAfterSteps = {5, 20};

/// By cell: moves to the nearest cell with less than four neighbours.
std::vector<std::uint32_t> depths_from_rim(const FreeGrid& grid) {
  constexpr std::size_t kAllNeighbours = 4;
  constexpr std::uint32_t kUnseen = UINT32_MAX;
  std::vector<std::uint32_t> depths(grid.size(), kUnseen);
  std::vector<CellId> cells;
  for (CellId cell = 0; cell < grid.size(); ++cell) {
    if (grid.neighbours(cell).size() == kAllNeighbours) continue;
    depths[cell] = 0;
    cells.push_back(cell);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const CellId next : grid.neighbours(cells[i])) {
      if (depths[next] != kUnseen) continue;
      depths[next] = depths[cells[i]] + 1;
      cells.push_back(next);
    }
  }
  return depths;
}

/// Long paths first; in a crowd goals at the rim first: a crowd is put in order from outside to
/// inside, as a sliding puzzle is.
std::vector<RobotId> choosing_order(const FreeGrid& grid, const Configuration& goals,
                                    const std::vector<std::uint32_t>& lengths, bool is_crowded) {
  std::vector<RobotId> robots(goals.size());
  std::iota(robots.begin(), robots.end(), RobotId{0});
  std::stable_sort(robots.begin(), robots.end(),
                   [&](RobotId a, RobotId b) { return lengths[a] > lengths[b]; });
  if (!is_crowded) return robots;
  const std::vector<std::uint32_t> depths = depths_from_rim(grid);
  std::stable_sort(robots.begin(), robots.end(),
                   [&](RobotId a, RobotId b) { return depths[goals[a]] < depths[goals[b]]; });
  return robots;
}

/// One search from the starts.
class Search {
 public:
  /// All must outlive this. Robots follow the guide, if there is one, for so many steps.
  Search(const FreeGrid& grid, const Configuration& starts, const Configuration& goals, Pibt pibt,
         const ChoosingOrder& order, GuidedDistances* guide, std::uint64_t guided_steps)
      : grid_(grid),
        goals_(goals),
        pibt_(std::move(pibt)),
        guide_(guide),
        guided_steps_(guided_steps),
        late_after_steps_(order.late_after_steps),
        ranked_(order.robots),
        order_(order.robots) {
    add_node(starts, std::vector<std::uint32_t>(starts.size(), 0), kNoNode);
  }

  LacamResult run(const LacamLimits& limits) {
    LacamResult result;
    result.status = search(limits);
    if (result.status == LacamStatus::kSolved) result.steps = path_to(stack_.back());
    result.steps_tried = steps_tried_;
    result.cells_seen = pibt_.cells_seen();
    result.configurations = nodes_.size();
    return result;
  }

 private:
  LacamStatus search(const LacamLimits& limits) {
    Configuration next;
    while (!stack_.empty()) {
      const NodeId id = stack_.back();
      if (nodes_[id].cells == goals_) return LacamStatus::kSolved;
      if (nodes_[id].next_constraint == nodes_[id].constraints.size()) {
        stack_.pop_back();  // all of its steps were tried
        continue;
      }
      if (is_at_limit(limits)) return LacamStatus::kLimit;
      ++steps_tried_;
      sort_robots(id);
      pibt_.follow(steps_tried_ <= guided_steps_ ? guide_ : nullptr);
      pibt_.push_cheaply(limits.push_cheaply && makes_progress(nodes_[id].cells));
      Node& node = nodes_[id];
      const auto entry = static_cast<std::uint32_t>(node.next_constraint++);
      const StepOutcome outcome = pibt_.make_step(node.cells, order_, constraints_of(node, entry), next);
      if (outcome != StepOutcome::kContradiction) add_children(node, entry);
      if (outcome != StepOutcome::kFound) continue;
      const NodeId known = find_node(next);
      if (known != kNoNode) {
        stack_.push_back(known);  // go on from there: [LC22], section 3.3
      } else {
        add_node(next, lateness_after(node, next), id);
      }
    }
    return LacamStatus::kUnsolvable;
  }

  /// Whether it ever got more robots to their goals within the last steps.
  bool makes_progress(const Configuration& cells) {
    std::size_t arrived = 0;
    for (RobotId robot = 0; robot < cells.size(); ++robot) arrived += cells[robot] == goals_[robot];
    is_stuck_ = is_stuck_ || steps_tried_ > best_at_ + kPatienceSteps;
    if (arrived > most_arrived_ || best_at_ == 0) {
      most_arrived_ = arrived;
      best_at_ = steps_tried_;
    }
    return !is_stuck_;
  }

  bool is_at_limit(const LacamLimits& limits) const {
    return steps_tried_ >= limits.max_steps || memory_bytes_ > limits.max_memory_bytes || limits.is_over();
  }

  /// Puts the robots of a configuration in the order in which they choose.
  void sort_robots(NodeId id) {
    if (std::exchange(sorted_for_, id) == id) return;
    const std::vector<std::uint32_t>& late_steps = nodes_[id].late_steps;
    lateness_.clear();
    for (const std::uint32_t steps : late_steps) lateness_.push_back(steps / late_after_steps_);
    // By counting, the latest first.
    const std::uint32_t latest =
        lateness_.empty() ? 0 : *std::max_element(lateness_.begin(), lateness_.end());
    places_.assign(latest + 2, 0);
    for (const std::uint32_t late : lateness_) ++places_[latest - late + 1];
    std::partial_sum(places_.begin(), places_.end(), places_.begin());
    for (const RobotId robot : ranked_) order_[places_[latest - lateness_[robot]]++] = robot;
  }

  /// Adds the children of an entry of the tree of constraints: one for each cell that the
  /// next robot in order can be in.
  void add_children(Node& node, std::uint32_t entry) {
    const std::uint32_t depth = node.constraints[entry].depth;
    if (depth == order_.size()) return;
    const RobotId robot = order_[depth];
    const CellId here = node.cells[robot];
    const std::size_t before = node.constraints.size();
    for (const CellId cell : grid_.neighbours(here)) {
      node.constraints.push_back({entry, depth + 1, {robot, cell}});
    }
    node.constraints.push_back({entry, depth + 1, {robot, here}});
    memory_bytes_ += (node.constraints.size() - before) * sizeof(ConstraintNode);
  }

  std::vector<StepConstraint> constraints_of(const Node& node, std::uint32_t entry) const {
    std::vector<StepConstraint> constraints;
    while (node.constraints[entry].depth > 0) {
      constraints.push_back(node.constraints[entry].constraint);
      entry = node.constraints[entry].parent;
    }
    return constraints;
  }

  std::vector<std::uint32_t> lateness_after(const Node& node, const Configuration& next) const {
    std::vector<std::uint32_t> late_steps = node.late_steps;
    for (RobotId robot = 0; robot < next.size(); ++robot) {
      late_steps[robot] = next[robot] == goals_[robot] ? 0 : late_steps[robot] + 1;
    }
    return late_steps;
  }

  void add_node(const Configuration& cells, std::vector<std::uint32_t> late_steps, NodeId parent) {
    const auto id = static_cast<NodeId>(nodes_.size());
    nodes_.push_back({cells, std::move(late_steps), parent, {ConstraintNode{}}, 0});
    ids_.emplace(hash_of(cells), id);
    stack_.push_back(id);
    memory_bytes_ += sizeof(Node) + 2 * cells.size() * sizeof(CellId);
  }

  NodeId find_node(const Configuration& cells) const {
    const auto [begin, end] = ids_.equal_range(hash_of(cells));
    for (auto it = begin; it != end; ++it) {
      if (nodes_[it->second].cells == cells) return it->second;
    }
    return kNoNode;
  }

  std::vector<Configuration> path_to(NodeId id) {
    std::vector<Configuration> steps;
    for (; id != kNoNode; id = nodes_[id].parent) steps.push_back(std::move(nodes_[id].cells));
    std::reverse(steps.begin(), steps.end());
    return steps;
  }

  const FreeGrid& grid_;
  const Configuration& goals_;
  Pibt pibt_;
  GuidedDistances* guide_;
  std::uint64_t guided_steps_;
  std::uint32_t late_after_steps_;
  std::vector<RobotId> ranked_;  ///< of robots that are equally late the first goes first
  std::vector<RobotId> order_;
  std::vector<std::uint32_t> lateness_;  ///< by robot
  std::vector<std::uint32_t> places_;    ///< by how much earlier than the latest: the next one in order_
  NodeId sorted_for_ = kNoNode;
  std::deque<Node> nodes_;
  std::unordered_multimap<std::uint64_t, NodeId> ids_;  ///< by hash of the configuration
  std::vector<NodeId> stack_;
  std::uint64_t steps_tried_ = 0;
  std::size_t most_arrived_ = 0;
  std::uint64_t best_at_ = 0;  ///< steps tried when so many had arrived
  bool is_stuck_ = false;
  std::size_t memory_bytes_ = 0;
};

}  // namespace

Lacam::Lacam(const FreeGrid& grid, Configuration starts, Configuration goals, const TimeLimits& limits)
    : grid_(grid), starts_(std::move(starts)), goals_(std::move(goals)), distances_(grid, goals_) {
  std::vector<std::uint32_t> lengths;
  for (RobotId robot = 0; robot < starts_.size() && !known_; ++robot) {
    const auto length = distances_.first_distance(robot, starts_[robot]);
    lengths.push_back(length.value_or(0));
    if (!length || limits.is_over()) known_ = length ? LacamStatus::kLimit : LacamStatus::kUnsolvable;
  }
  if (known_ || starts_.empty()) return;
  longest_ = *std::max_element(lengths.begin(), lengths.end());
  all_lengths_ = std::accumulate(lengths.begin(), lengths.end(), std::uint64_t{0});
  order_.robots = choosing_order(grid_, goals_, lengths, is_crowded());
  const MoveCosts costs = traffic_costs(grid_, starts_, goals_, limits);
  if (limits.is_over()) known_ = LacamStatus::kLimit;
  if (!known_) guide_.emplace(grid_, goals_, costs);
}

bool Lacam::is_crowded() const {
  return static_cast<double>(starts_.size()) >= kCrowdedShare * static_cast<double>(grid_.size());
}

LacamResult Lacam::search(std::uint64_t seed, const LacamLimits& limits) {
  LacamResult result;
  if (known_) {
    result.status = *known_;
    return result;
  }
  Random seeds(seed);
  std::uint64_t patience = std::max(limits.least_patience_steps, limits.patience_lengths * longest_);
  for (std::size_t search = 0;; ++search) {
    if (is_crowded()) order_.late_after_steps = kCrowdLateAfterSteps[search % kCrowdLateAfterSteps.size()];
    const std::uint64_t left = limits.max_steps - result.steps_tried;
    LacamLimits attempt = limits;
    attempt.max_steps = std::min(left, patience);
    const LacamResult before = std::move(result);
    // By turns: with cheap rows of pushes, with those of [PIBT], and by plain distances, too.
    const std::size_t cheap = limits.push_cheaply ? kCheapSearches : 0;
    const std::size_t turn = search % (cheap + 2);
    attempt.push_cheaply = turn < cheap;
    GuidedDistances* const guide = guide_ && turn <= cheap ? &*guide_ : nullptr;
    result = Search(grid_, starts_, goals_, Pibt(grid_, distances_, !is_crowded(), seeds.next()), order_,
                    guide, kGuidedLengths * longest_)
                 .run(attempt);
    const bool impatient = result.status == LacamStatus::kLimit && result.steps_tried == patience;
    result.steps_tried += before.steps_tried;
    result.cells_seen += before.cells_seen;
    if (!impatient || patience == left || limits.is_over()) return result;
    patience *= 2;
  }
}

}  // namespace sipplab
