// Protected starts; see start_safe_check.hpp.
#include "planner/validator/start_safe_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "planner/validator/place_buckets.hpp"

namespace sipplab {
namespace {

/// Cells. Rounding of places by which starts are looked up.
constexpr double kLookupMarginCells = 1e-6;

struct GuardedSpan {
  double begin_s = 0;
  double end_s = -1;  // before begin_s: empty
};

/// The parts of [begin_s, end_s] at which a motion is at least `radius_cells` from a
/// place: the squared distance is a parabola in time, and the time between its two
/// crossings of radius^2 is left out.
std::array<GuardedSpan, 2> time_outside(const LinearMotion& motion, Vec2 place, double radius_cells,
                                        double begin_s, double end_s) {
  const Vec2 apart = motion.at(begin_s) - place;
  const double squared_speed = squared_norm(motion.velocity_cells_per_s);
  if (!(squared_speed > 0)) {
    if (norm(apart) >= radius_cells) return {GuardedSpan{begin_s, end_s}, GuardedSpan{}};
    return {};
  }
  const double nearest_s = begin_s - dot(apart, motion.velocity_cells_per_s) / squared_speed;
  const double off_line = cross(apart, motion.velocity_cells_per_s);
  const double squared_half_s =
      (radius_cells * radius_cells - off_line * off_line / squared_speed) / squared_speed;
  if (!(squared_half_s > 0)) return {GuardedSpan{begin_s, end_s}, GuardedSpan{}};
  const double half_s = std::sqrt(squared_half_s);
  return {GuardedSpan{begin_s, std::min(end_s, nearest_s - half_s)},
          GuardedSpan{std::max(begin_s, nearest_s + half_s), end_s}};
}

/// All starts, in buckets.
class StartLookup {
 public:
  explicit StartLookup(const Instance& instance, const std::vector<BodyTrack>& robots, double bucket_cells,
                       double extent_cells)
      : grid_(bucket_cells, extent_cells, 4 * robots.size() + 1), buckets_(grid_.bucket_count()) {
    for (AgentIndex i = 0; i < robots.size(); ++i) {
      const Vec2 start = centre(instance.agents[i].start);
      grid_.for_each(grid_.around(start, start, robots[i].radius_cells),
                     [&](std::size_t bucket) { buckets_[bucket].push_back(i); });
    }
  }

  /// Calls visit(agent) for each start whose disk may be within `reach_cells` of the
  /// box around a and b; for some of them more than once.
  template <class Visit>
  void for_each_near(Vec2 a, Vec2 b, double reach_cells, Visit visit) const {
    grid_.for_each(grid_.around(a, b, reach_cells), [&](std::size_t bucket) {
      for (const AgentIndex agent : buckets_[bucket]) visit(agent);
    });
  }

 private:
  BucketGrid grid_;
  std::vector<std::vector<AgentIndex>> buckets_;
};

}  // namespace

std::vector<StartIntrusion> check_start_safe_intervals(const Instance& instance,
                                                       const std::vector<BodyTrack>& robots,
                                                       const std::vector<AgentIndex>& order, double ssi_s,
                                                       double tolerance_cells, std::size_t max_intrusions) {
  std::vector<std::size_t> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;

  const Surroundings within = surroundings(instance.map, kMaxRadiusCells);
  const double step_cells = choose_step_cells(robots, within, 0);
  if (!(step_cells > 0)) return {};  // bodies without size intrude nowhere
  const StartLookup starts(instance, robots, step_cells,
                           std::max(within.high.x - within.low.x, within.high.y - within.low.y));

  std::map<std::pair<AgentIndex, AgentIndex>, Approach> closest;
  for (const MotionStep& step : cut_into_steps(robots, within, step_cells)) {
    if (step.begin_s > ssi_s) break;
    const AgentIndex agent = step.body;
    const LinearMotion& motion = robots[agent].motions[step.motion];
    const double end_s = std::min(step.end_s, ssi_s);
    starts.for_each_near(
        motion.at(step.begin_s), motion.at(end_s), robots[agent].radius_cells + kLookupMarginCells,
        [&](AgentIndex other) {
          if (rank[other] <= rank[agent]) return;
          const double contact_cells = robots[agent].radius_cells + robots[other].radius_cells;
          const Vec2 start = centre(instance.agents[other].start);
          const auto look_at = [&](double from_s, double to_s) {
            if (!(from_s <= to_s)) return;
            const Approach approach = closest_approach(motion, start, from_s, to_s);
            if (approach.distance_cells >= contact_cells - tolerance_cells) return;
            const auto found = closest.find({agent, other});
            if (found != closest.end()) {
              if (approach.distance_cells < found->second.distance_cells) found->second = approach;
            } else if (closest.size() < max_intrusions) {
              closest.emplace(std::pair(agent, other), approach);
            }
          };
          if (std::isinf(ssi_s)) {
            const Vec2 goal = centre(instance.agents[agent].goal);
            for (const GuardedSpan& part : time_outside(motion, goal, contact_cells, step.begin_s, end_s)) {
              look_at(part.begin_s, part.end_s);
            }
          } else {
            look_at(step.begin_s, end_s);
          }
        });
  }

  std::vector<StartIntrusion> intrusions;
  for (const auto& [pair, approach] : closest) {
    const double contact_cells = robots[pair.first].radius_cells + robots[pair.second].radius_cells;
    intrusions.push_back({pair.first, pair.second, approach.time_s, contact_cells - approach.distance_cells});
  }
  return intrusions;
}

}  // namespace sipplab
