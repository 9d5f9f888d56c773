#include "bench/sweep/expand.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "bench/sweep/adversarial.hpp"
#include "planner/complete/complete_planner.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/io/case_codec.hpp"

namespace sipplab::bench {
namespace {

template <class T>
void replace_unless_empty(std::vector<T>& dimension, const std::vector<T>& replacement) {
  if (!replacement.empty()) dimension = replacement;
}

/// The block with the dimensions that the user replaced.
SuiteBlock replaced(SuiteBlock block, const SweepRequest& request) {
  if (request.map) block.map = *request.map;
  replace_unless_empty(block.robots, request.robots);
  replace_unless_empty(block.ssi_s, request.ssi_s);
  replace_unless_empty(block.reschedules, request.reschedules);
  replace_unless_empty(block.orders, request.orders);
  if (!request.connectedness.empty()) {
    PlannerMode mode = block.planners.front();
    block.planners.clear();
    for (const int k : request.connectedness) {
      mode.connectedness = k;
      block.planners.push_back(mode);
    }
  }
  if (!request.weights.empty()) {
    const std::vector<PlannerMode> modes = std::exchange(block.planners, {});
    for (PlannerMode mode : modes) {
      for (const double weight : request.weights) {
        mode.weight = weight;
        block.planners.push_back(mode);
      }
    }
  }
  if (request.refinement) block.refinement = *request.refinement;
  if (request.random_seeds) block.random_seeds = *request.random_seeds;
  for (PlannerMode& planner : block.planners) {
    planner.any_angle = request.any_angle.value_or(planner.any_angle);
    planner.method = request.method.value_or(planner.method);
    planner.fallback = request.fallback.value_or(planner.fallback);
  }
  if (request.change_rules) {
    for (PlannerMode& planner : block.planners) request.change_rules(planner.rules);
  }
  return block;
}

/// Options of which only the limits count: the suite's, or what the user set.
PlannerOptions limits_of(const SweepRequest& request) {
  PlannerOptions limits;
  if (request.suite != nullptr) {
    limits.time_limit_s = request.suite->time_limit_s;
    limits.max_restarts = request.suite->max_restarts;
  }
  limits.time_limit_s = request.time_limit_s.value_or(limits.time_limit_s);
  limits.max_restarts = request.max_restarts.value_or(limits.max_restarts);
  limits.max_expansions = request.max_expansions.value_or(limits.max_expansions);
  return limits;
}

/// What the complete planner has no use for gets one value, so that cases are not planned
/// twice under two names.
PlannerOptions without_idle_choices(PlannerOptions options) {
  if (options.method != Method::kComplete) return options;
  const PlannerOptions defaults;
  options.order = defaults.order;
  options.rescheduling = Rescheduling::kNone;
  options.any_angle = false;
  options.connectedness = kMinConnectedness;
  options.weight = defaults.weight;
  options.fallback = Fallback::kNone;
  return options;
}

/// Why a case cannot be planned, in one line.
std::optional<std::string> find_unplannable(const ExpandedSweep& sweep) {
  for (const NamedCase& named : sweep.cases) {
    const PlannerOptions& options = named.parameters.options;
    if (auto line = find_beyond_refinement(options, named.parameters.refinement)) return line;
    if (options.method != Method::kComplete && options.fallback != Fallback::kComplete) continue;
    for (const PreparedInstance& prepared : sweep.sets[named.parameters.set].instances) {
      const std::optional<InstanceError> error = find_beyond_complete(prepared.instance, options.rules);
      if (error) return prepared.row.name + ": " + error->what + ", expected " + error->expected;
    }
  }
  return std::nullopt;
}

class Expansion {
 public:
  explicit Expansion(const SweepRequest& request) : request_(request) {}

  /// Adds the cases of a block on one set of instances; cases that are there already
  /// (blocks overlap once dimensions are replaced) are left out.
  void add_cases(const SuiteBlock& block, std::size_t set, const PlannerOptions& limits) {
    for (const PlannerMode& planner : block.planners) {
      for (const InitialOrder order : block.orders) {
        for (const Rescheduling rescheduling : block.reschedules) {
          for (const double ssi_s : block.ssi_s) {
            PlannerOptions options = limits;
            options.order = order;
            options.rescheduling = rescheduling;
            options.ssi_s = ssi_s;
            options.any_angle = planner.any_angle;
            options.connectedness = planner.connectedness;
            options.weight = planner.weight;
            options.rules = planner.rules;
            options.method = planner.method;
            options.fallback = planner.fallback;
            add_seeds(block, set, without_idle_choices(options));
          }
        }
      }
    }
  }

  std::size_t add_set(InstanceSet set) {
    sweep_.sets.push_back(std::move(set));
    return sweep_.sets.size() - 1;
  }

  /// The set of a map, bodies and a number of robots, made when it is first asked for.
  Expected<std::size_t, std::string> generated_set(const SuiteBlock& block, std::size_t robots,
                                                   std::uint64_t count) {
    for (std::size_t i = 0; i < generated_.size(); ++i) {
      const auto& [map, bodies] = generated_[i];
      if (map == block.map && bodies == block.bodies && sweep_.sets[i].robots == robots) return i;
    }
    Expected<InstanceSet, std::string> set =
        generate_set(block.map, robots, count, request_.seed, block.bodies);
    if (!set) return Unexpected{set.error()};
    generated_.emplace_back(block.map, block.bodies);
    return add_set(std::move(*set));
  }

  /// The set of the archive for a map and a number of robots, read when it is first asked
  /// for; none where the archive has no such folder.
  Expected<std::optional<std::size_t>, std::string> archived_set(const std::string& map, std::size_t robots,
                                                                 std::uint64_t count) {
    const std::filesystem::path folder =
        std::filesystem::path(*request_.archive) / map.substr(0, map.find(':')) / std::to_string(robots);
    for (const auto& [read, set] : archived_) {
      if (read == folder) return std::optional(set);
    }
    if (!std::filesystem::is_directory(folder) || std::filesystem::is_empty(folder)) {
      return std::optional<std::size_t>();
    }
    Expected<std::vector<InstanceSet>, std::string> sets = load_sets(folder.string(), {robots}, count);
    if (!sets) return Unexpected{sets.error()};
    if (sets->empty()) return std::optional<std::size_t>();
    archived_.emplace_back(folder, add_set(std::move(sets->front())));
    return std::optional(archived_.back().second);
  }

  ExpandedSweep take() { return std::move(sweep_); }

 private:
  void add_seeds(const SuiteBlock& block, std::size_t set, PlannerOptions options) {
    const bool random =
        options.rescheduling == Rescheduling::kRandom || options.order == InitialOrder::kRandom;
    const std::uint64_t seeds = random ? block.random_seeds : 1;
    for (std::uint64_t k = 0; k < seeds; ++k) {
      options.seed = request_.seed + k;
      const InstanceSet& instances = sweep_.sets[set];
      SweepCase parameters{instances.environment,
                           instances.map_spec,
                           instances.name,
                           instances.robots,
                           instances.radius_cells,
                           instances.speed_cells_per_s,
                           options,
                           set,
                           block.refinement,
                           request_.command};
      std::string name = case_name(parameters, seeds > 1);
      if (names_.insert(name).second) sweep_.cases.push_back({std::move(name), std::move(parameters)});
    }
  }

  const SweepRequest& request_;
  ExpandedSweep sweep_;
  std::set<std::string> names_;
  std::vector<std::pair<std::string, Bodies>> generated_;  ///< map and robots of each generated set
  std::vector<std::pair<std::filesystem::path, std::size_t>> archived_;
};

Expected<ExpandedSweep, std::string> expand_folders(const SweepRequest& request) {
  const PlannerOptions defaults;
  SuiteBlock block;
  block.ssi_s = {defaults.ssi_s};
  block.reschedules = {defaults.rescheduling};
  block = replaced(std::move(block), request);
  Expansion expansion(request);
  std::set<std::pair<std::string, std::size_t>> seen;
  for (const std::string& folder : request.folders) {
    Expected<std::vector<InstanceSet>, std::string> sets = load_sets(folder, request.robots, request.count);
    if (!sets) return Unexpected{sets.error()};
    for (InstanceSet& set : *sets) {
      if (!seen.emplace(set.environment, set.robots).second) {
        return Unexpected{folder + ": a second set " + set.environment + " with " +
                          std::to_string(set.robots) +
                          " robots, expected folders that differ in their last two names"};
      }
      expansion.add_cases(block, expansion.add_set(std::move(set)), limits_of(request));
    }
  }
  return expansion.take();
}

/// Each case with the options that it came with.
ExpandedSweep expand_adversarial(const SweepRequest& request) {
  Expansion expansion(request);
  for (const AdversarialCase& adversarial : adversarial_cases()) {
    std::optional<PlanCase> plan_case = decode_case(adversarial.text);
    if (!plan_case || find_error(plan_case->instance)) continue;  // a test sees to it that all are read
    const PlannerOptions& options = plan_case->options;
    SuiteBlock block;
    block.ssi_s = {options.ssi_s};
    block.reschedules = {options.rescheduling};
    block.orders = {options.order};
    block.planners = {{options.any_angle, options.connectedness, options.rules, options.method,
                       options.fallback, options.weight}};
    const std::size_t set = expansion.add_set(
        single_instance_set("adversarial-" + std::string(adversarial.name), std::move(plan_case->instance)));
    expansion.add_cases(replaced(std::move(block), request), set, limits_of(request));
  }
  return expansion.take();
}

Expected<ExpandedSweep, std::string> expand_all(const SweepRequest& request) {
  if (request.suite == nullptr) return expand_folders(request);
  if (request.suite->adversarial_cases) return expand_adversarial(request);
  const Suite& suite = *request.suite;
  Expansion expansion(request);
  for (const SuiteBlock& original : suite.blocks) {
    const SuiteBlock block = replaced(original, request);
    for (const std::size_t robots : block.robots) {
      const std::uint64_t count = request.count.value_or(suite.instances);
      if (request.archive) {
        const auto set = expansion.archived_set(block.map, robots, count);
        if (!set) return Unexpected{set.error()};
        if (*set) expansion.add_cases(block, **set, limits_of(request));
        continue;
      }
      const Expected<std::size_t, std::string> set = expansion.generated_set(block, robots, count);
      if (!set) return Unexpected{set.error()};
      expansion.add_cases(block, *set, limits_of(request));
    }
  }
  return expansion.take();
}

}  // namespace

Expected<ExpandedSweep, std::string> expand(const SweepRequest& request) {
  Expected<ExpandedSweep, std::string> sweep = expand_all(request);
  if (!sweep) return sweep;
  if (const auto line = find_unplannable(*sweep)) return Unexpected{*line};
  return sweep;
}

}  // namespace sipplab::bench
