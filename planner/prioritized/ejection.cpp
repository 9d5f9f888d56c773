#include "planner/prioritized/ejection.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "planner/prioritized/limits.hpp"
#include "planner/prioritized/partial_plan.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

class Ejection {
 public:
  Ejection(const Instance& instance, const PlannerOptions& options, SingleAgentPlanner& planner,
           std::uint64_t most_ejections, Clock::time_point begin)
      : limits_(search_limits(options, begin)),
        max_restarts_(options.max_restarts),
        most_ejections_(most_ejections),
        plan_(instance, options.ssi_s, planner),
        sketch_(instance, options.ssi_s, planner),
        random_(options.seed),
        times_ejected_(instance.agents.size()),
        ejected_by_(instance.agents.size()) {
    std::vector<double> lengths_s;
    for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
      lengths_s.push_back(planner.lower_bound_s(agent));
    }
    order_ = initial_order(options.order, lengths_s, random_);
    waiting_.assign(order_.begin(), order_.end());
    result_.ssi_s = result_.ssi_kept_s = options.ssi_s;
  }

  PlanResult run() {
    while (result_.status == PlanStatus::kFailed && !waiting_.empty() && step()) {
    }
    finish();
    return std::move(result_);
  }

 private:
  using Found = Expected<Trajectory, PlanFailure>;

  Found find(PartialPlan& among, AgentIndex agent) {
    return among.find(agent, left_of(limits_, result_.statistics), result_.statistics);
  }

  /// Plans the next robot. False if that ends the run.
  bool step() {
    const AgentIndex agent = waiting_.front();
    waiting_.pop_front();
    Found found = find(plan_, agent);
    if (found) {
      plan_.insert(agent, std::move(*found));
      return true;
    }
    waiting_.push_front(agent);
    result_.trace.push_back({{}, agent, {}});
    if (found.error() != PlanFailure::kNoPath) return censored();
    if (result_.trace.size() > max_restarts_ || limits_.is_over()) return censored();
    Found forced = find_forced_path(agent);
    if (!forced) return forced.error() == PlanFailure::kNoPath ? false : censored();
    return make_room(agent, std::move(*forced));
  }

  /// A path through all planned robots, except some that it would eject once more: each is held with a
  /// probability that grows with its past ejections by this robot. While there is no such path, half of those
  /// held are let go.
  Found find_forced_path(AgentIndex agent) {
    std::vector<AgentIndex> held;
    for (const auto& [other, times] : ejected_by_[agent]) {
      if (plan_.is_planned(other) && random_.below(times + 1) > 0) held.push_back(other);
    }
    while (true) {
      for (const AgentIndex other : held) sketch_.insert(other, plan_.trajectory(other));
      Found found = find(sketch_, agent);
      for (const AgentIndex other : held) sketch_.take_out(other);
      // Starts of held robots are not protected in the sketch.
      if (found && (held.empty() || plan_.keeps_guarantee(agent, *found))) return found;
      if (!found && (held.empty() || found.error() != PlanFailure::kNoPath)) return found;
      random_.shuffle(held);
      held.resize(held.size() / 2);
    }
  }

  bool censored() {
    result_.status = PlanStatus::kLimit;
    return false;
  }

  /// Takes out those that block the robot and puts back those that need not go.
  bool make_room(AgentIndex agent, Trajectory path) {
    std::vector<AgentIndex> candidates = plan_.conflicts(agent, path);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [this](AgentIndex a, AgentIndex b) { return times_ejected_[a] > times_ejected_[b]; });
    std::vector<PartialPlan::Taken> taken;
    for (const AgentIndex candidate : candidates) taken.push_back(plan_.take_out(candidate));
    std::vector<AgentIndex> ejected;
    for (PartialPlan::Taken& in_the_way : taken) {
      const AgentIndex candidate = in_the_way.agent;
      plan_.put_back(std::move(in_the_way));
      if (plan_.still_fits(agent, path, candidate)) continue;
      Found found = find(plan_, agent);
      if (found) {
        path = std::move(*found);
        continue;
      }
      if (found.error() != PlanFailure::kNoPath) return censored();
      plan_.take_out(candidate);
      ejected.push_back(candidate);
    }
    plan_.insert(agent, std::move(path));
    waiting_.pop_front();
    for (auto next = ejected.rbegin(); next != ejected.rend(); ++next) waiting_.push_front(*next);
    bool may_go_on = true;
    for (const AgentIndex robot : ejected) {
      ++ejected_by_[agent][robot];
      may_go_on &= ++times_ejected_[robot] < most_ejections_;
    }
    result_.trace.back().ejected = std::move(ejected);
    return may_go_on;
  }

  void finish() {
    if (!waiting_.empty()) {
      result_.trace.back().order = std::move(order_);
      return;
    }
    result_.status = PlanStatus::kSolved;
    result_.solution = plan_.solution();
    std::optional<PriorityOrder> order = plan_.order();
    PLANNER_ASSERT(order);
    result_.trace.push_back({order ? std::move(*order) : std::move(order_), std::nullopt, {}});
  }

  SearchLimits limits_;
  std::uint64_t max_restarts_;
  std::uint64_t most_ejections_;
  PartialPlan plan_;
  PartialPlan sketch_;  ///< empty except while a path is forced
  Random random_;
  std::vector<std::uint64_t> times_ejected_;
  std::vector<std::map<AgentIndex, std::uint64_t>> ejected_by_;  ///< by robot: which, and how often
  PriorityOrder order_;                                          ///< the initial one
  std::deque<AgentIndex> waiting_;
  PlanResult result_;
};

}  // namespace

PlanResult plan_by_ejection(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner, std::uint64_t most_ejections) {
  const Clock::time_point begin = Clock::now();
  PlanResult result = Ejection(instance, options, planner, most_ejections, begin).run();
  result.planning_seconds = seconds_since(begin);
  return result;
}

}  // namespace sipplab
