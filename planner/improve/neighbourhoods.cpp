#include "planner/improve/neighbourhoods.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sipplab {
namespace {

/// Share of the last gain in a rule's weight.
constexpr double kLearningRate = 0.02;
/// Least weight, the greatest being 1: no rule is given up for good.
constexpr double kLeastWeight = 0.05;
/// Factor by which the greatest gain decays with each iteration.
constexpr double kScaleDecay = 0.999;

/// Seconds added to every robot's delay, so that robots without delay are drawn, too: they
/// may block others.
constexpr double kDelayFloorS = 0.25;

/// Robots that arrive last: the rule draws one of this many.
constexpr std::size_t kLastOnes = 5;

/// Half the side of a window, in cells, and its length, in seconds.
constexpr double kWindowCells = 3;
constexpr double kWindowS = 6;

/// Draws an index by weight. REQUIRES: some weight is above 0.
template <class Weights>
std::size_t draw_by(const Weights& weights, Random& random) {
  const double sum = std::accumulate(std::begin(weights), std::end(weights), 0.0);
  double left = random.unit() * sum;
  std::size_t drawn = 0;
  for (const double weight : weights) {
    left -= weight;
    if (left < 0) break;
    ++drawn;
  }
  return std::min(drawn, std::size(weights) - 1);
}

std::vector<double> delay_weights(const Neighbours& among) {
  std::vector<double> weights;
  for (AgentIndex agent = 0; agent < among.instance.agents.size(); ++agent) {
    const double delay_s = among.plan.trajectory(agent).arrival_s() - among.static_times_s[agent];
    weights.push_back(std::max(delay_s, 0.0) + kDelayFloorS);
  }
  return weights;
}

AgentIndex one_of_the_last(const Neighbours& among, Random& random) {
  std::vector<AgentIndex> agents(among.instance.agents.size());
  std::iota(agents.begin(), agents.end(), AgentIndex{0});
  const std::size_t count = std::min(kLastOnes, agents.size());
  std::partial_sort(agents.begin(), agents.begin() + static_cast<std::ptrdiff_t>(count), agents.end(),
                    [&](AgentIndex a, AgentIndex b) {
                      const double arrival_a_s = among.plan.trajectory(a).arrival_s();
                      const double arrival_b_s = among.plan.trajectory(b).arrival_s();
                      return arrival_a_s != arrival_b_s ? arrival_a_s > arrival_b_s : a < b;
                    });
  return agents[static_cast<std::size_t>(random.below(count))];
}

/// Where a robot is at a given time.
Vec2 place_at(const Trajectory& trajectory, double time_s) {
  for (const TimedMotion& motion : trajectory.motions) {
    if (time_s >= motion.end_s) continue;
    const double share = (time_s - motion.begin_s) / (motion.end_s - motion.begin_s);
    return centre(motion.from) + (centre(motion.to) - centre(motion.from)) * share;
  }
  return centre(trajectory.end());
}

/// Whether a robot comes within the window around a place and a time, by the bounding boxes of
/// its motions: close enough.
bool visits(const Trajectory& trajectory, Vec2 place, double time_s) {
  const auto is_near = [&](Cell from, Cell to) {
    const auto [left, right] = std::minmax(from.x, to.x);
    const auto [top, bottom] = std::minmax(from.y, to.y);
    return left <= place.x + kWindowCells && right >= place.x - kWindowCells &&
           top <= place.y + kWindowCells && bottom >= place.y - kWindowCells;
  };
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s > time_s + kWindowS / 2) return false;
    if (motion.end_s >= time_s - kWindowS / 2 && is_near(motion.from, motion.to)) return true;
  }
  return trajectory.arrival_s() <= time_s + kWindowS / 2 && is_near(trajectory.end(), trajectory.end());
}

/// Fills up with random robots of `others`.
void add_some(std::vector<AgentIndex>& chosen, std::vector<AgentIndex> others, std::size_t most,
              Random& random) {
  random.shuffle(others);
  for (const AgentIndex other : others) {
    if (chosen.size() >= most) return;
    if (std::find(chosen.begin(), chosen.end(), other) == chosen.end()) chosen.push_back(other);
  }
}

/// Fills up with robots drawn by their delay.
void add_delayed(std::vector<AgentIndex>& chosen, const Neighbours& among, std::size_t most, Random& random) {
  std::vector<double> weights = delay_weights(among);
  for (const AgentIndex agent : chosen) weights[agent] = 0;
  while (chosen.size() < std::min(most, weights.size())) {
    chosen.push_back(draw_by(weights, random));
    weights[chosen.back()] = 0;
  }
}

}  // namespace

std::string_view name(RemovalRule rule) {
  switch (rule) {
    case RemovalRule::kCrossing:
      return "crossing";
    case RemovalRule::kLast:
      return "last";
    case RemovalRule::kWindow:
      return "window";
    case RemovalRule::kRandom:
      return "random";
  }
  return "unknown";
}

std::vector<AgentIndex> choose_neighbourhood(RemovalRule rule, const Neighbours& among, std::size_t most,
                                             Random& random) {
  std::vector<AgentIndex> chosen;
  switch (rule) {
    case RemovalRule::kCrossing:
    case RemovalRule::kLast: {
      const AgentIndex first =
          rule == RemovalRule::kLast ? one_of_the_last(among, random) : draw_by(delay_weights(among), random);
      chosen.push_back(first);
      add_some(chosen, among.plan.conflicts(first, among.fastest_paths[first]), most, random);
      break;
    }
    case RemovalRule::kWindow: {
      const AgentIndex first = draw_by(delay_weights(among), random);
      const Trajectory& trajectory = among.plan.trajectory(first);
      const double time_s = random.unit() * trajectory.arrival_s();
      const Vec2 place = place_at(trajectory, time_s);
      std::vector<AgentIndex> visitors;
      for (AgentIndex agent = 0; agent < among.instance.agents.size(); ++agent) {
        if (visits(among.plan.trajectory(agent), place, time_s)) visitors.push_back(agent);
      }
      chosen.push_back(first);
      add_some(chosen, std::move(visitors), most, random);
      break;
    }
    case RemovalRule::kRandom:
      break;
  }
  add_delayed(chosen, among, most, random);
  return chosen;
}

RemovalRule RuleRoulette::draw(Random& random) const {
  return static_cast<RemovalRule>(draw_by(weights_, random));
}

void RuleRoulette::learn(RemovalRule rule, double gain) {
  scale_ = std::max(scale_ * kScaleDecay, gain);
  double& weight = weights_[static_cast<std::size_t>(rule)];
  const double share = scale_ > 0 ? gain / scale_ : 0;
  weight = std::max(weight * (1 - kLearningRate) + share * kLearningRate, kLeastWeight);
}

}  // namespace sipplab
