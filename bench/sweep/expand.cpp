#include "bench/sweep/expand.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "bench/sweep/adversarial.hpp"
#include "planner/core/try.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/io/case_codec.hpp"
#include "sipplab/solve.hpp"

namespace sipplab::bench {
namespace {

/// Each of the options with each value.
std::vector<PlannerOptions> with_each(const std::vector<PlannerOptions>& all, const OptionValues& values) {
  std::vector<PlannerOptions> result;
  for (const PlannerOptions& options : all) {
    for (const std::string& text : values.texts) values.option->set(result.emplace_back(options), text);
  }
  return result;
}

/// The block with what the user replaced, and the limits of the suite.
SuiteBlock replaced(SuiteBlock block, const SweepRequest& request) {
  if (request.map) block.map = *request.map;
  const bool chooses = request.suite != nullptr && request.suite->fitting_maps;
  if (!request.robots.empty() && !chooses) block.robots = request.robots;
  if (!request.robots.empty() && chooses) {
    std::erase_if(block.robots, [&request](std::size_t robots) {
      return std::find(request.robots.begin(), request.robots.end(), robots) == request.robots.end();
    });
  }
  if (!request.radii_cells.empty()) block.bodies.radii_cells = request.radii_cells;
  if (!request.speeds_cells_per_s.empty()) block.bodies.speeds_cells_per_s = request.speeds_cells_per_s;
  if (request.random_seeds) block.random_seeds = *request.random_seeds;
  for (PlannerOptions& options : block.planners) {
    if (request.suite == nullptr) break;
    options.time_limit_s = request.suite->time_limit_s;
    options.max_restarts = request.suite->max_restarts;
  }
  for (const OptionValues& values : request.values) {
    const auto dimension = std::find_if(block.dimensions.begin(), block.dimensions.end(),
                                        [&](const OptionValues& own) { return own.option == values.option; });
    if (dimension != block.dimensions.end()) {
      *dimension = values;
    } else {
      block.planners = with_each(block.planners, values);
    }
  }
  return block;
}

/// What LaCAM has no use for gets one value, so that cases are not planned
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
    for (const PreparedInstance& prepared : sweep.sets[named.parameters.set].instances) {
      if (!prepared.broken.empty()) continue;
      if (const auto line = find_beyond(prepared.instance, named.parameters.options)) {
        return prepared.row.name + ": " + *line;
      }
    }
  }
  return std::nullopt;
}

class Expansion {
 public:
  explicit Expansion(const SweepRequest& request) : request_(request) {}

  /// Adds the cases of a block on one set of instances; cases that are there already
  /// (blocks overlap once dimensions are replaced) are left out.
  void add_cases(const SuiteBlock& block, std::size_t set) {
    std::vector<PlannerOptions> all = block.planners;
    for (const OptionValues& dimension : block.dimensions) all = with_each(all, dimension);
    for (const PlannerOptions& options : all) add_seeds(block, set, without_idle_choices(options));
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
    auto set = SIPPLAB_TRY(generate_set(block.map, robots, count, request_.seed, block.bodies));
    generated_.emplace_back(block.map, block.bodies);
    return add_set(std::move(set));
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
    auto loaded = SIPPLAB_TRY(load_sets(folder.string(), {.robots = {robots}, .count = count}));
    add_notes(loaded.notes);
    archived_.emplace_back(folder, add_set(std::move(loaded.sets.front())));
    return std::optional(archived_.back().second);
  }

  void add_notes(const std::vector<std::string>& notes) {
    sweep_.notes.insert(sweep_.notes.end(), notes.begin(), notes.end());
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
      SweepCase parameters{
          instances.environment,  instances.map_spec,          instances.name, instances.robots,
          instances.radius_cells, instances.speed_cells_per_s, options,        set,
          request_.command};
      const std::string name = case_name(parameters, seeds > 1);
      add_case(name, std::move(parameters));
    }
  }

  /// Names leave out limits and how instances were made: cases that differ in these alone are told apart by
  /// them. One that is there already is left out.
  void add_case(std::string name, SweepCase parameters) {
    std::vector<std::size_t>& namesakes = namesakes_[name];
    const db::CaseInfo row = case_row(parameters);
    for (const std::size_t other : namesakes) {
      if (case_row(sweep_.cases[other].parameters) == row) return;
    }
    namesakes.push_back(sweep_.cases.size());
    if (namesakes.size() > 1) name += what_differs(sweep_.cases[namesakes.front()].parameters, parameters);
    sweep_.cases.push_back({std::move(name), std::move(parameters)});
  }

  /// "/time-limit:2": those of its limits and instances that are not as those of the first of that name.
  static std::string what_differs(const SweepCase& first, const SweepCase& parameters) {
    std::string words;
    for (const Option& option : option_rows()) {
      const std::string text = option.get(parameters.options);
      if (option.group == OptionGroup::kLimits && text != option.get(first.options))
        words += std::string("/") + option.name + ":" + text;
    }
    if (parameters.instance_set != first.instance_set) words += "/" + parameters.instance_set;
    std::replace(words.begin(), words.end(), ' ', '/');
    return words;
  }

  const SweepRequest& request_;
  ExpandedSweep sweep_;
  std::map<std::string, std::vector<std::size_t>> namesakes_;  ///< cases by what case_name() says
  std::vector<std::pair<std::string, Bodies>> generated_;      ///< map and robots of each generated set
  std::vector<std::pair<std::filesystem::path, std::size_t>> archived_;
};

Expected<ExpandedSweep, std::string> expand_folders(const SweepRequest& request) {
  const SuiteBlock block = replaced({}, request);
  Expansion expansion(request);
  const auto one = [](const std::vector<double>& values) {
    return values.empty() ? std::nullopt : std::optional(values.front());
  };
  const FolderRequest wanted{request.robots, request.count, one(request.radii_cells),
                             one(request.speeds_cells_per_s), request.strict};
  std::set<std::pair<std::string, std::size_t>> seen;
  for (const std::string& folder : request.folders) {
    auto loaded = SIPPLAB_TRY(load_sets(folder, wanted));
    expansion.add_notes(loaded.notes);
    for (InstanceSet& set : loaded.sets) {
      if (!seen.emplace(set.environment, set.robots).second) {
        return Unexpected{folder + ": a second set " + set.environment + " with " +
                          std::to_string(set.robots) +
                          " robots, expected folders that differ in their last two names"};
      }
      expansion.add_cases(block, expansion.add_set(std::move(set)));
    }
  }
  return expansion.take();
}

/// Each case with the options that it came with.
ExpandedSweep expand_adversarial(const SweepRequest& request) {
  Expansion expansion(request);
  for (const db::EmbeddedText& adversarial : adversarial_cases()) {
    std::optional<PlanCase> plan_case = decode_case(adversarial.text);
    if (!plan_case || find_error(plan_case->instance)) continue;  // a test sees to it that all are read
    SuiteBlock block;
    block.planners = {plan_case->options};
    block.planners.front().max_expansions = UINT64_MAX;
    const std::size_t set = expansion.add_set(
        single_instance_set("adversarial-" + std::string(adversarial.name), std::move(plan_case->instance)));
    expansion.add_cases(replaced(std::move(block), request), set);
  }
  return expansion.take();
}

/// A flag that the suite does not take, in one line.
std::optional<std::string> find_idle_flag(const SweepRequest& request) {
  const Suite& suite = *request.suite;
  const std::pair<const char*, bool> of_instances[] = {{"--robots", !request.robots.empty()},
                                                       {"--count", request.count.has_value()},
                                                       {"--radius", !request.radii_cells.empty()},
                                                       {"--speed", !request.speeds_cells_per_s.empty()}};
  if (request.map && (suite.adversarial_cases || suite.fitting_maps)) {
    return "--map: suite " + suite.name + " has maps of its own, expected another suite";
  }
  for (const auto& [flag, given] : of_instances) {
    if (given && suite.adversarial_cases) {
      return std::string(flag) + ": suite " + suite.name +
             " has instances of its own, expected another suite";
    }
  }
  if (!suite.fitting_maps) return std::nullopt;
  std::set<std::size_t> known;
  for (const SuiteBlock& block : suite.blocks) known.insert(block.robots.begin(), block.robots.end());
  for (const std::size_t robots : request.robots) {
    if (known.count(robots) != 0) continue;
    return fmt::format("--robots {}: suite {} has maps for {}, expected some of these", robots, suite.name,
                       fmt::join(known, ", "));
  }
  return std::nullopt;
}

Expected<ExpandedSweep, std::string> expand_all(const SweepRequest& request) {
  if (request.suite == nullptr && (request.radii_cells.size() > 1 || request.speeds_cells_per_s.size() > 1)) {
    return Unexpected{std::string("several radii or speeds for the robots of files, expected one")};
  }
  if (request.suite == nullptr) return expand_folders(request);
  if (const auto line = find_idle_flag(request)) return Unexpected{*line};
  if (request.suite->adversarial_cases) return expand_adversarial(request);
  const Suite& suite = *request.suite;
  Expansion expansion(request);
  for (const SuiteBlock& original : suite.blocks) {
    const SuiteBlock block = replaced(original, request);
    for (const std::size_t robots : block.robots) {
      const std::uint64_t count = request.count.value_or(suite.instances);
      if (request.archive) {
        const auto set = SIPPLAB_TRY(expansion.archived_set(block.map, robots, count));
        if (set) expansion.add_cases(block, *set);
        continue;
      }
      const auto set = SIPPLAB_TRY(expansion.generated_set(block, robots, count));
      expansion.add_cases(block, set);
    }
  }
  return expansion.take();
}

}  // namespace

Expected<ExpandedSweep, std::string> expand(const SweepRequest& request) {
  auto sweep = SIPPLAB_TRY(expand_all(request));
  if (const auto line = find_unplannable(sweep)) return Unexpected{*line};
  return sweep;
}

}  // namespace sipplab::bench
