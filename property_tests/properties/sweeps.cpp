// Sweeps before a planner runs: which cases and instances there are, and who does what of them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/judge/case_words.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/sweep/case_outcome.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/sweep/run_instance.hpp"
#include "bench/sweep/shard.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "bench/sweep/task_plan.hpp"
#include "db/run_names.hpp"
#include "planner/io/text_file.hpp"
#include "planner/options/option_table.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/texts.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::bench::sweeps_laws {
namespace {

using db::any_flag;
using db::any_whole;

constexpr int kFewer = (kCasesOfHistories + 3) / 4;

template <class T>
T valued(Expected<T, std::string> value) {
  if (!value) RC_FAIL(value.error());
  return std::move(*value);
}

// --- dealing out --------------------------------------------------------------------

/// Cases of some sets of instances, which are not looked into.
ExpandedSweep any_sweep() {
  ExpandedSweep sweep;
  for (auto left = any_whole(1, 3); left > 0; --left) {
    sweep.sets.emplace_back();
    sweep.sets.back().instances.resize(static_cast<std::size_t>(any_whole(0, any_flag() ? 5 : 50)));
  }
  for (auto left = any_whole(0, 5); left > 0; --left) {
    NamedCase named;
    named.name = "case " + std::to_string(left);
    named.parameters.robots = static_cast<std::size_t>(left);
    named.parameters.set =
        static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(sweep.sets.size()) - 1));
    sweep.cases.push_back(std::move(named));
  }
  return sweep;
}

using Plannings = std::multiset<std::tuple<std::string, std::int64_t, std::int64_t>>;

Plannings plannings_of(const ExpandedSweep& sweep) {
  Plannings plannings;
  for (const NamedCase& named : sweep.cases) {
    for (const Planning& planning : named.plannings)
      plannings.emplace(named.name, planning.position, planning.repetition);
  }
  return plannings;
}

Plannings all_of(const ExpandedSweep& sweep, std::int64_t repetitions) {
  Plannings plannings;
  for (const NamedCase& named : sweep.cases) {
    for (std::size_t position = 0; position < sweep.sets[named.parameters.set].instances.size(); ++position) {
      for (std::int64_t repetition = 0; repetition < repetitions; ++repetition) {
        plannings.emplace(named.name, static_cast<std::int64_t>(position), repetition);
      }
    }
  }
  return plannings;
}

/// Whether each instance takes a quarter of a shard's share at most, all its plannings together.
bool instances_are_small(const ExpandedSweep& sweep, std::int64_t repetitions,
                         const std::vector<double>& seconds, std::size_t shards) {
  double total = 0;
  double largest = 0;
  for (std::size_t set = 0; set < sweep.sets.size(); ++set) {
    double one = 0;
    for (std::size_t i = 0; i < sweep.cases.size(); ++i) {
      if (sweep.cases[i].parameters.set == set) one += seconds[i] * static_cast<double>(repetitions);
    }
    const auto instances = static_cast<double>(sweep.sets[set].instances.size());
    total += one * instances;
    if (instances > 0) largest = std::max(largest, one);
  }
  return total > 0 && largest * 4 * static_cast<double>(shards) <= total;
}

void everything_is_dealt_out_once() {
  const ExpandedSweep sweep = any_sweep();
  const auto repetitions = any_whole(1, 3);
  const auto count = static_cast<std::size_t>(any_whole(1, 9));
  const auto seed = static_cast<std::uint64_t>(any_whole(0, 99));
  const auto kind = any_whole(0, 2);
  std::map<std::string, double> seconds_of;
  std::vector<double> seconds;
  for (const NamedCase& named : sweep.cases) {
    seconds.push_back(kind == 0 ? 0 : kind == 1 ? 1 : static_cast<double>(any_whole(0, 20)));
    seconds_of[named.name] = seconds.back();
  }
  const Plannings all = all_of(sweep, repetitions);
  RC_ASSERT(planning_count(sweep, repetitions) == all.size());
  ExpandedSweep whole = sweep;
  deal_all(whole, repetitions);
  RC_ASSERT(plannings_of(whole) == all);
  RC_ASSERT(whole.cases.size() == sweep.cases.size());
  const bool by_instance = instances_are_small(sweep, repetitions, seconds, count);
  std::map<std::pair<std::size_t, std::int64_t>, std::size_t> shard_of;  // of an instance
  // All shards together.
  Plannings together;
  double total = 0;
  double most = 0;
  double least = std::numeric_limits<double>::infinity();
  double last_of_most = 0;  // the shortest planning of the shard that has the most to do
  std::size_t largest = 0;
  std::size_t smallest = all.size();
  for (std::size_t index = 0; index < count; ++index) {
    ExpandedSweep part = sweep;
    deal(part, repetitions, {index, count}, seed, seconds);
    ExpandedSweep again = sweep;
    deal(again, repetitions, {index, count}, seed, seconds);
    RC_ASSERT(plannings_of(part) == plannings_of(again));
    const Plannings mine = plannings_of(part);
    std::set<std::string> names;
    double load = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (const NamedCase& named : part.cases) {
      RC_ASSERT(names.insert(named.name).second);
      RC_ASSERT(!named.plannings.empty());
      for (const Planning& planning : named.plannings) {
        const auto lies = shard_of.emplace(std::pair(named.parameters.set, planning.position), index).first;
        if (by_instance) RC_ASSERT(lies->second == index);
      }
      load += seconds_of[named.name] * static_cast<double>(named.plannings.size());
      shortest = std::min(shortest, seconds_of[named.name]);
    }
    together.insert(mine.begin(), mine.end());
    total += load;
    if (load > most) {
      most = load;
      last_of_most = shortest;
    }
    least = std::min(least, load);
    largest = std::max(largest, mine.size());
    smallest = std::min(smallest, mine.size());
  }
  RC_ASSERT(together == all);
  // The longest first, each to whom has the least: the last that the busiest got made it the busiest.
  if (!by_instance) RC_ASSERT(most - least <= last_of_most + 1e-9);
  if (!by_instance && kind < 2) RC_ASSERT(largest - smallest <= 1);
  if (by_instance) RC_ASSERT(most - least <= total / static_cast<double>(count) / 4 + 1e-9);
  RC_CLASSIFY(by_instance && count > 1, "by instance");
  RC_CLASSIFY(all.size() % count != 0, "does not divide");
}

void shards_are_read_as_written() {
  const std::string text =
      any_flag() ? std::to_string(any_whole(0, 12)) + "/" + std::to_string(any_whole(0, 12)) : *any_text();
  const auto shard = parse_shard(text);
  std::optional<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t index = 1; index <= 12; ++index) {
    for (std::size_t count = index; count <= 12; ++count) {
      if (text == std::to_string(index) + "/" + std::to_string(count)) expected = {index - 1, count};
    }
  }
  RC_ASSERT(shard.has_value() == expected.has_value());
  if (!shard) return;
  RC_ASSERT(shard->index == expected->first);
  RC_ASSERT(shard->count == expected->second);
}

void plans_of_tasks_are_read_as_written() {
  const ScratchFolder folder;
  TaskPlan plan;
  plan.sweep = *any_text();
  plan.tasks = static_cast<std::size_t>(any_whole(1, 1000));
  plan.plannings = any_whole(0, 1 << 30);
  plan.suite = *any_text();
  plan.options = *any_text();
  plan.binary_hash = *any_text();
  plan.folder = *any_text();
  for (auto left = any_whole(0, 3); left > 0; --left) plan.arguments.push_back(*any_text());
  for (auto left = any_whole(0, 3); left > 0; --left) plan.seconds.push_back(*any_real_between(0, 100));
  RC_ASSERT(!write_task_plan(folder.path(), plan).has_value());
  const TaskPlan read = valued(read_task_plan(folder.path()));
  RC_ASSERT(read.sweep == plan.sweep);
  RC_ASSERT(read.tasks == plan.tasks);
  RC_ASSERT(read.plannings == plan.plannings);
  RC_ASSERT(read.suite == plan.suite);
  RC_ASSERT(read.options == plan.options);
  RC_ASSERT(read.binary_hash == plan.binary_hash);
  RC_ASSERT(read.folder == plan.folder);
  RC_ASSERT(read.arguments == plan.arguments);
  RC_ASSERT(read.seconds == plan.seconds);
}

/// What is known counts, and what is not is guessed in the scale of what is.
void expected_times_are_in_one_scale() {
  ExpandedSweep sweep = any_sweep();
  for (std::size_t i = 0; i < sweep.cases.size(); ++i) sweep.cases[i].parameters.robots = 8 * (i + 1);
  const db::NewHistory history;
  db::Sweep run;
  run.info.uuid = db::new_uuid();
  run.info.suite = "smoke";
  run.info.machine = db::machine_number(1);
  run.info.build = db::build_number(1);
  std::map<std::size_t, double> known;
  for (std::size_t i = 0; i < sweep.cases.size(); ++i) {
    if (any_flag()) continue;
    double sum = 0;
    const auto plannings = any_whole(1, 3);
    for (std::int64_t k = 0; k < plannings; ++k) {
      db::Planned planned{case_row(sweep.cases[i].parameters), db::instance_number(static_cast<int>(k)), {}};
      planned.row.planning_time_ns = any_whole(1, 50) * 1'000'000;
      planned.row.position = k;
      sum += static_cast<double>(planned.row.planning_time_ns) / 1e9;
      run.plannings.push_back(planned);
    }
    known[i] = sum / static_cast<double>(plannings);
  }
  db::record(history.path(), run);
  db::Database database = history.open();
  const auto seconds = db::must(expected_seconds(sweep, &database));
  const auto guesses = db::must(expected_seconds(sweep, nullptr));
  double measured_s = 0;
  double guessed_s = 0;
  for (const auto& [i, mean] : known) {
    measured_s += mean;
    guessed_s += expected_seconds(sweep.cases[i].parameters);
  }
  RC_ASSERT(seconds.size() == sweep.cases.size());
  for (std::size_t i = 0; i < sweep.cases.size(); ++i) {
    const double guess = expected_seconds(sweep.cases[i].parameters);
    RC_ASSERT(guesses[i] == guess);
    if (i > 0) RC_ASSERT(guess > guesses[i - 1]);  // more robots take longer
    const double expected = known.count(i) > 0 ? known[i]
                            : known.empty()    ? guess
                                               : guess * measured_s / guessed_s;
    RC_ASSERT(std::abs(seconds[i] - expected) <= 1e-9 * expected);
  }
}

/// A sweep that is resumed does what its run lacks, and shows what that holds.
void what_is_recorded_is_left_out() {
  ExpandedSweep sweep = any_sweep();
  for (NamedCase& named : sweep.cases) named.parameters.environment = "empty";
  const auto repetitions = any_whole(1, 3);
  deal(sweep, repetitions, {0, static_cast<std::size_t>(any_whole(1, 2))}, 1,
       std::vector<double>(sweep.cases.size(), 1));
  const ExpandedSweep before = sweep;
  std::vector<db::RecordedCase> recorded;
  for (const NamedCase& named : sweep.cases) {
    if (any_whole(0, 3) == 0) continue;
    db::RecordedCase& one = recorded.emplace_back();
    one.parameters = case_row(named.parameters);
    std::set<Planning> taken;
    for (auto left = any_whole(0, 8); left > 0; --left) {
      const Planning planning{any_whole(0, 5), any_whole(0, repetitions)};
      if (!taken.insert(planning).second) continue;
      db::ResultRow& row = one.rows.emplace_back(db::any_result());
      row.position = planning.position;
      row.repetition = planning.repetition;
    }
  }
  leave_out(sweep, recorded);
  RC_ASSERT(sweep.cases.size() == before.cases.size());
  std::size_t left = 0;
  for (std::size_t i = 0; i < sweep.cases.size(); ++i) {
    const auto known = std::find_if(recorded.begin(), recorded.end(), [&](const db::RecordedCase& one) {
      return one.parameters == case_row(sweep.cases[i].parameters);
    });
    std::vector<Planning> missing;
    std::int64_t there = 0;
    std::int64_t solved = 0;
    for (const Planning& planning : before.cases[i].plannings) {
      const db::ResultRow* found = nullptr;
      for (std::size_t k = 0; known != recorded.end() && k < known->rows.size(); ++k) {
        const db::ResultRow& row = known->rows[k];
        if (row.position == planning.position && row.repetition == planning.repetition) found = &row;
      }
      if (found == nullptr) missing.push_back(planning);
      there += found != nullptr;
      solved += found != nullptr && found->status == db::ResultStatus::kSolved;
    }
    RC_ASSERT(sweep.cases[i].plannings == missing);
    RC_ASSERT(sweep.cases[i].outcome.results() == there);
    RC_ASSERT(sweep.cases[i].outcome.solved() == solved);
    left += missing.size();
    RC_CLASSIFY(there > 0 && !missing.empty(), "some of a case are there");
  }
  RC_ASSERT(count_left(sweep) == left);
}

/// As many tasks as keep each within its time, and no more.
void tasks_take_as_long_as_asked() {
  const ExpandedSweep sweep = any_sweep();
  const auto repetitions = any_whole(1, 3);
  std::vector<double> seconds;
  double all_s = 0;
  for (const NamedCase& named : sweep.cases) {
    seconds.push_back(static_cast<double>(any_whole(0, 4000)));
    all_s += seconds.back() * static_cast<double>(repetitions) *
             static_cast<double>(sweep.sets[named.parameters.set].instances.size());
  }
  RC_ASSERT(seconds_of_all(sweep, repetitions, seconds) == all_s);  // whole numbers
  const auto per_task_s = static_cast<double>(any_whole(1, 60));
  const std::size_t tasks = tasks_for(all_s, per_task_s);
  RC_ASSERT(tasks >= 1u && tasks <= 1000u);
  if (tasks < 1000) RC_ASSERT(all_s <= per_task_s * static_cast<double>(tasks));
  if (tasks > 1) RC_ASSERT(all_s > per_task_s * static_cast<double>(tasks - 1));
  RC_CLASSIFY(tasks == 1000u, "as many as an array has");
}

/// Every other option stays, in its place; a value may be an argument of its own or follow a '='.
void options_are_taken_out_with_their_values() {
  std::vector<std::string> arguments = {"bench"};
  std::vector<std::string> expected = {"bench"};
  for (auto left = any_whole(0, 6); left > 0; --left) {
    const bool goes = any_flag();
    const std::string name = goes ? (any_flag() ? "--db" : "--tasks") : (any_flag() ? "--dbx" : "--task");
    std::vector<std::string> words = {name, std::to_string(left)};
    if (any_flag()) words = {name + "=" + std::to_string(left)};
    arguments.insert(arguments.end(), words.begin(), words.end());
    if (!goes) expected.insert(expected.end(), words.begin(), words.end());
  }
  RC_ASSERT(arguments_without(arguments, {"--db", "--tasks"}) == expected);
}

void tasks_are_what_their_programs_said() {
  const ScratchFolder folder;
  const auto tasks = static_cast<std::size_t>(any_whole(0, 9));
  std::vector<std::size_t> done;
  std::vector<std::size_t> missing;
  std::vector<std::pair<std::size_t, int>> failed;
  for (std::size_t task = 1; task <= tasks; ++task) {
    // A signal that asks to stop is none of the task's own; SIGKILL is what ends one that takes too much
    // memory.
    const std::vector<std::pair<int, char>> kEnds = {
        {0, 'd'}, {1, 'f'}, {70, 'f'}, {130, 'm'}, {143, 'm'}, {138, 'm'}, {137, 'f'}, {139, 'f'}, {-1, 'm'}};
    const auto [code, end] =
        kEnds[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(kEnds.size()) - 1))];
    if (code >= 0)
      RC_ASSERT(!write_file(exit_file(folder.path(), task).string(), std::to_string(code) + "\n"));
    // Whoever ended well and left no results is as if it had not run.
    const bool has_results = any_flag();
    if (has_results) RC_ASSERT(!write_file(task_database(folder.path(), task).string(), "results"));
    if (end == 'd' && has_results) done.push_back(task);
    if (end == 'm' || (end == 'd' && !has_results)) missing.push_back(task);
    if (end == 'f') failed.emplace_back(task, code);
  }
  const TaskStates states = states_of(folder.path(), tasks);
  RC_ASSERT(states.done == done);
  RC_ASSERT(states.missing == missing);
  RC_ASSERT(states.failed == failed);
}

/// Read back they are the same numbers, in as few parts as there are gaps.
void ranges_name_all_numbers() {
  std::set<std::size_t> numbers;
  for (auto left = any_whole(0, 9); left > 0; --left)
    numbers.insert(static_cast<std::size_t>(any_whole(1, 14)));
  const std::string text = ranges({numbers.begin(), numbers.end()});
  std::set<std::size_t> read;
  std::size_t parts = 0;
  for (std::size_t at = 0; at < text.size(); ++parts) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const std::size_t dash = part.find('-');
    const std::size_t last = std::stoul(dash == std::string::npos ? part : part.substr(dash + 1));
    if (dash != std::string::npos) RC_ASSERT(last > std::stoul(part));
    for (std::size_t number = std::stoul(part); number <= last; ++number) {
      RC_ASSERT(read.insert(number).second);
    }
    at = end + 1;
  }
  RC_ASSERT(read == numbers);
  std::size_t runs = 0;
  for (const std::size_t number : numbers) runs += numbers.contains(number - 1) ? 0U : 1U;
  RC_ASSERT(parts == runs);
}

// --- cases --------------------------------------------------------------------------

/// Options that are set and read as texts.
const std::vector<std::pair<std::string, std::vector<std::string>>> kValues = {
    {"ssi", {"0", "2.5", "inf"}},
    {"reschedule", {"none", "random", "ejection"}},
    {"order", {"fifo", "random"}},
    {"any-angle", {"yes", "no"}},
    {"connectedness", {"2", "3"}},
    {"weight", {"1", "1.5"}},
    {"max-expansions", {"100", "200"}},
    {"time-limit", {"1", "2"}},
    {"max-restarts", {"0", "3"}},
    {"turns", {"no", "yes"}},
    {"seed", {"1", "7"}}};

std::vector<OptionValues> any_values(std::size_t most, bool seeds) {
  std::vector<OptionValues> values;
  std::set<std::string> taken;
  for (auto left = any_whole(0, static_cast<std::int64_t>(most)); left > 0; --left) {
    const auto& [name, texts] = kValues[static_cast<std::size_t>(
        any_whole(0, static_cast<std::int64_t>(kValues.size()) - (seeds ? 1 : 2)))];
    if (!taken.insert(name).second) continue;
    OptionValues one{find_option(name), texts};
    RC_ASSERT(one.option != nullptr);
    one.texts.resize(static_cast<std::size_t>(any_whole(1, static_cast<std::int64_t>(texts.size()))));
    values.push_back(std::move(one));
  }
  return values;
}

std::string all_options(const PlannerOptions& options) {
  std::string text;
  for (const Option& option : option_rows())
    text += std::string(option.name) + "=" + option.get(options) + " ";
  return text;
}

std::vector<PlannerOptions> each_with_each(std::vector<PlannerOptions> all, const OptionValues& values) {
  std::vector<PlannerOptions> made;
  for (const PlannerOptions& options : all) {
    for (const std::string& text : values.texts) {
      made.push_back(options);
      RC_ASSERT(values.option->set(made.back(), text));
    }
  }
  return made;
}

/// Every element of the product of each block is a case, once.
void suites_are_products() {
  Suite suite;
  suite.name = "drawn";
  suite.instances = static_cast<std::uint64_t>(any_whole(1, 2));
  suite.time_limit_s = 20;
  suite.max_restarts = 10;
  for (auto left = any_whole(1, 2); left > 0; --left) {
    SuiteBlock block;
    block.map = any_flag() ? "empty:5x4" : "empty:4x6";
    block.robots = any_flag() ? std::vector<std::size_t>{1, 2} : std::vector<std::size_t>{2};
    block.dimensions = any_values(2, false);
    block.random_seeds = static_cast<std::uint64_t>(any_whole(1, 2));
    if (any_whole(0, 2) == 0) block.bodies.radii_cells = {any_flag() ? 0.25 : 0.3};
    suite.blocks.push_back(std::move(block));
  }
  SweepRequest request;
  request.suite = &suite;
  request.seed = static_cast<std::uint64_t>(any_whole(1, 3));
  if (any_flag()) request.robots = {1, 3};
  if (any_flag()) request.count = static_cast<std::uint64_t>(any_whole(1, 3));
  if (any_flag()) request.values = any_values(2, false);
  if (any_flag()) request.random_seeds = static_cast<std::uint64_t>(any_whole(1, 2));

  std::set<std::string> expected;
  for (const SuiteBlock& block : suite.blocks) {
    std::vector<PlannerOptions> all = {PlannerOptions{}};
    all[0].time_limit_s = suite.time_limit_s;
    all[0].max_restarts = suite.max_restarts;
    // What is asked for replaces what the suite has.
    std::set<const Option*> replaced;
    for (const OptionValues& values : request.values) {
      replaced.insert(values.option);
      all = each_with_each(std::move(all), values);
    }
    for (const OptionValues& values : block.dimensions) {
      if (replaced.count(values.option) == 0) all = each_with_each(std::move(all), values);
    }
    for (const std::size_t robots : request.robots.empty() ? block.robots : request.robots) {
      for (PlannerOptions options : all) {
        const bool random =
            options.rescheduling == Rescheduling::kRandom || options.order == InitialOrder::kRandom;
        for (std::uint64_t k = 0; k < (random ? request.random_seeds.value_or(block.random_seeds) : 1); ++k) {
          options.seed = request.seed + k;
          expected.insert(block.map + " " + std::to_string(robots) + " " +
                          std::to_string(block.bodies.radii_cells[0]) + " " + all_options(options));
        }
      }
    }
  }
  const auto sweep = expand(request);
  if (!sweep) RC_DISCARD("does not go together");
  std::set<std::string> found;
  std::set<std::string> names;
  for (const NamedCase& named : sweep->cases) {
    const InstanceSet& set = sweep->sets[named.parameters.set];
    RC_LOG() << named.name << '\n';
    RC_ASSERT(names.insert(named.name).second);
    RC_ASSERT(set.instances.size() == request.count.value_or(suite.instances));
    RC_ASSERT(set.robots == named.parameters.robots);
    for (const PreparedInstance& prepared : set.instances)
      RC_ASSERT(prepared.instance.agents.size() == named.parameters.robots);
    found.insert(named.parameters.map_spec + " " + std::to_string(named.parameters.robots) + " " +
                 std::to_string(named.parameters.radius_cells) + " " + all_options(named.parameters.options));
  }
  for (const std::string& one : expected) {
    if (found.count(one) == 0) RC_LOG() << "missing: " << one << '\n';
  }
  RC_ASSERT(found == expected);
}

/// An instance of a set is that of its seed and index, however many others there are; its row says what it
/// is.
void sets_hold_what_they_say() {
  const auto width = any_whole(2, 7);
  const auto height = any_whole(2, 7);
  const std::string spec =
      any_flag() ? "empty:" + std::to_string(width) + "x" + std::to_string(height)
                 : "random:" + std::to_string(width + 4) + "x" + std::to_string(height + 4) + ":0.2";
  const auto robots = static_cast<std::size_t>(any_whole(1, 2));
  const auto count = static_cast<std::uint64_t>(any_whole(1, 3));
  const auto seed = static_cast<std::uint64_t>(any_whole(1, 9));
  Bodies bodies;
  if (any_flag()) bodies.radii_cells = {0.25, 0.5};
  if (any_flag()) bodies.speeds_cells_per_s = {2};
  const auto made = generate_set(spec, robots, count, seed, bodies);
  if (!made) RC_DISCARD("does not fit");
  RC_ASSERT(made->instances.size() == count);
  RC_ASSERT(made->robots == robots);
  RC_ASSERT(made->map_spec == spec);
  std::set<double> radii;
  for (std::uint64_t index = 0; index < count; ++index) {
    const PreparedInstance& prepared = made->instances[index];
    GeneratorOptions options;
    options.agents = robots;
    options.seed = seed;
    options.index = index;
    options.radii_cells = bodies.radii_cells;
    options.speeds_cells_per_s = bodies.speeds_cells_per_s;
    const auto alone = generate_instance(*parse_map_spec(spec), options);
    RC_ASSERT(content_hash(prepared.instance) == content_hash(*alone));
    RC_ASSERT(prepared.row.content_hash == content_hash(*alone));
    RC_ASSERT(prepared.row.robots == static_cast<std::int64_t>(robots));
    RC_ASSERT(prepared.row.width_cells == alone->map.width());
    RC_ASSERT(prepared.row.height_cells == alone->map.height());
    std::int64_t blocked = 0;
    for (std::int32_t y = 0; y < alone->map.height(); ++y) {
      for (std::int32_t x = 0; x < alone->map.width(); ++x) blocked += alone->map.is_blocked({x, y}) ? 1 : 0;
    }
    RC_ASSERT(prepared.row.blocked_cells == blocked);
    RC_ASSERT(prepared.row.name.find(" index:" + std::to_string(index)) != std::string::npos);
    for (const Agent& agent : alone->agents) radii.insert(agent.radius_cells);
    // From a map of another shape another hash; the map alone does not know the robots.
    if (index > 0 && spec[0] == 'e') RC_ASSERT(prepared.row.map_hash == made->instances[0].row.map_hash);
    RC_ASSERT(prepared.row.map_hash != prepared.row.content_hash);
  }
  RC_ASSERT(made->radius_cells == (radii.size() == 1 ? *radii.begin() : 0));
  RC_ASSERT(made->speed_cells_per_s == bodies.speeds_cells_per_s[0]);
}

/// A folder's files in natural order, one set for each number of robots.
void folders_are_read_in_order() {
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path() / "some" / "folder";
  std::filesystem::create_directories(folder);
  std::map<std::size_t, std::vector<std::string>> by_robots;  // hashes
  const auto files = static_cast<int>(any_whole(1, 12));
  std::vector<Instance> instances;
  for (int number = 1; number <= files; ++number) {
    GeneratorOptions options;
    options.agents = static_cast<std::size_t>(any_whole(1, 2));
    options.index = static_cast<std::uint64_t>(number);
    instances.push_back(*generate_instance(*parse_map_spec("empty:5x4"), options));
    RC_ASSERT(!write_file((folder / (std::to_string(number) + ".xml")).string(),
                          write_instance_xml(instances.back())));
  }
  FolderRequest request;
  if (any_flag()) request.count = static_cast<std::uint64_t>(any_whole(1, 12));
  if (any_flag()) request.robots = {1};
  const std::size_t taken = std::min<std::size_t>(instances.size(), request.count.value_or(instances.size()));
  for (std::size_t i = 0; i < taken; ++i) {
    Instance instance = instances[i];
    if (!request.robots.empty()) instance.agents.resize(1);
    by_robots[instance.agents.size()].push_back(content_hash(instance));
  }
  const LoadedSets loaded = valued(load_sets(folder.string(), request));
  RC_ASSERT(loaded.sets.size() == by_robots.size());
  for (const InstanceSet& set : loaded.sets) {
    std::vector<std::string> hashes;
    for (const PreparedInstance& prepared : set.instances) {
      hashes.push_back(prepared.row.content_hash);
      RC_ASSERT(prepared.row.width_cells == 5);
      RC_ASSERT(prepared.row.height_cells == 4);
      RC_ASSERT(prepared.row.robots == static_cast<std::int64_t>(set.robots));
    }
    RC_ASSERT(hashes == by_robots.at(set.robots));
    RC_ASSERT(set.environment == "some/folder");
    RC_ASSERT(set.map_spec == "files");
  }
}

PlannerOptions any_options() {
  PlannerOptions options;
  for (const OptionValues& values : any_values(6, true))
    RC_ASSERT(values.option->set(options, values.texts.back()));
  return options;
}

/// The row of the history keeps every option; another option makes another row.
void rows_keep_all_options() {
  SweepCase one;
  one.environment = "empty";
  one.map_spec = "empty:5x4";
  one.options = any_options();
  const db::CaseInfo row = case_row(one);
  const PlannerOptions back = options_of(row);
  for (const Option& option : option_rows()) {
    if (history_key(option).empty()) continue;
    RC_LOG() << option.name << '\n';
    RC_ASSERT(option.get(back) == option.get(one.options));
    // Each in turn with another value.
    for (const auto& [name, texts] : kValues) {
      if (name != option.name) continue;
      for (const std::string& text : texts) {
        SweepCase other = one;
        option.set(other.options, text);
        RC_ASSERT((case_row(other) == row) == (option.get(other.options) == option.get(one.options)));
      }
    }
  }
  // And what a person is told to type gives them back.
  PlannerOptions typed;
  const std::string flags = option_flags(one.options);
  std::size_t at = 0;
  while ((at = flags.find("--", at)) != std::string::npos) {
    const std::size_t end = std::min(flags.find(" --", at), flags.size());
    std::string name = flags.substr(at + 2, std::min(flags.find(' ', at), end) - at - 2);
    std::string text = flags.find(' ', at) < end
                           ? flags.substr(flags.find(' ', at) + 1, end - flags.find(' ', at) - 1)
                           : "yes";
    if (name.substr(0, 3) == "no-" && find_option(name) == nullptr) {
      name = name.substr(3);
      text = "no";
    }
    RC_LOG() << flags << '\n';
    const Option* option = find_option(name);
    RC_ASSERT(option != nullptr);
    RC_ASSERT(option->set(typed, text));
    at = end;
  }
  RC_ASSERT(all_options(typed) == all_options(one.options));
}

/// In a comparison, too, cases that differ have names of their own.
void cases_have_names_of_their_own() {
  std::vector<db::CaseInfo> rows;
  for (auto left = any_whole(1, 5); left > 0; --left) {
    SweepCase one;
    one.environment = any_flag() ? "empty" : "some/folder";
    one.map_spec = any_flag() ? "empty:5x4" : "files";
    one.instance_set = any_flag() ? "generated/seed:1" : "generated/seed:2";
    one.robots = static_cast<std::size_t>(any_whole(1, 2));
    one.radius_cells = any_flag() ? 0.5 : 0.25;
    for (const OptionValues& values : any_values(2, true))
      values.option->set(one.options, values.texts.back());
    // A place is a map, or a folder.
    if (one.map_spec != "files") one.environment = "empty";
    const db::CaseInfo row = case_row(one);
    if (std::find(rows.begin(), rows.end(), row) == rows.end()) rows.push_back(row);
  }
  const std::vector<std::string> names = case_words(rows);
  RC_ASSERT(names.size() == rows.size());
  RC_ASSERT(std::set<std::string>(names.begin(), names.end()).size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RC_LOG() << names[i] << '\n';
    RC_ASSERT(names[i].find(std::to_string(rows[i].robots) + " robots") != std::string::npos);
  }
}

// --- results ------------------------------------------------------------------------

void outcomes_are_sums() {
  CaseOutcome outcome;
  std::vector<db::ResultRow> rows;
  for (auto left = any_whole(0, 6); left > 0; --left) {
    rows.push_back(db::any_result());
    outcome.add(rows.back());
  }
  const auto mean = [&rows](const auto& value, bool solved_only) -> std::optional<double> {
    double sum = 0;
    double count = 0;
    for (const db::ResultRow& row : rows) {
      if (solved_only && row.status != db::ResultStatus::kSolved) continue;
      sum += value(row);
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
  };
  const auto counted = [&rows](db::ResultStatus status) {
    return std::count_if(rows.begin(), rows.end(),
                         [status](const auto& row) { return row.status == status; });
  };
  const auto close = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) < 1e-9);
  };
  const auto seconds = [](const db::ResultRow& row) {
    return static_cast<double>(row.planning_time_ns) / 1e9;
  };
  RC_ASSERT(outcome.results() == static_cast<std::int64_t>(rows.size()));
  RC_ASSERT(outcome.solved() == counted(db::ResultStatus::kSolved));
  RC_ASSERT(outcome.limited() == counted(db::ResultStatus::kLimit));
  RC_ASSERT(outcome.invalid() == counted(db::ResultStatus::kInvalid));
  RC_ASSERT(
      close(outcome.success_rate(),
            mean([](const auto& row) { return row.status == db::ResultStatus::kSolved ? 1.0 : 0.0; }, false)
                .value_or(0)));
  RC_ASSERT(close(outcome.mean_planning_s(), mean(seconds, false).value_or(0)));
  RC_ASSERT(close(outcome.mean_tries(),
                  mean([](const auto& row) { return static_cast<double>(row.tries); }, false).value_or(0)));
  RC_ASSERT(
      close(outcome.mean_expansions(),
            mean([](const auto& row) { return static_cast<double>(row.expansions); }, false).value_or(0)));
  RC_ASSERT(close(outcome.mean_solved_planning_s(), mean(seconds, true)));
  RC_ASSERT(close(outcome.mean_makespan_s(), mean([](const auto& row) { return *row.makespan_s; }, true)));
  RC_ASSERT(close(outcome.mean_flowtime_s(), mean([](const auto& row) { return *row.flowtime_s; }, true)));
}

/// A planning that a limit ends says which: it ran out of what it was given.
void the_limit_that_struck_is_named() {
  PlanCase plan_case = *any_case();
  plan_case.options.time_limit_s = std::numeric_limits<double>::infinity();
  plan_case.options.max_expansions = static_cast<std::uint64_t>(any_whole(1, 200));
  plan_case.options.max_restarts = static_cast<std::uint64_t>(any_whole(0, 3));
  const db::ResultRow row = run_instance(plan_case.instance, plan_case.options);
  RC_ASSERT((row.status == db::ResultStatus::kLimit) == !row.limit.empty());
  if (row.limit == "expansions") RC_ASSERT(row.expansions >= plan_case.options.max_expansions);
  if (row.limit == "restarts") {
    RC_ASSERT(row.tries > plan_case.options.max_restarts);
    RC_ASSERT(row.expansions < plan_case.options.max_expansions);
  }
  RC_ASSERT(row.limit != "time");
  RC_ASSERT(row.valid.value_or(false) == (row.status == db::ResultStatus::kSolved));
  RC_ASSERT(row.makespan_s.has_value() == (row.status == db::ResultStatus::kSolved));
  // With nothing to spare the clock is named.
  plan_case.options.max_expansions = UINT64_MAX;
  plan_case.options.max_restarts = UINT64_MAX;
  PlanResult late;
  late.status = PlanStatus::kLimit;
  late.planning_seconds = plan_case.options.time_limit_s = 3;
  RC_ASSERT(described(plan_case.options, late).limit == "time");
  late.made_by = Method::kComplete;
  RC_ASSERT(described(plan_case.options, late).limit == "time");
  late.planning_seconds = 2;
  RC_ASSERT(described(plan_case.options, late).limit == "memory");
  RC_ASSERT(described(plan_case.options, late).planning_time_ns == 2'000'000'000);
  RC_CLASSIFY(row.limit == "expansions", "expansions");
  RC_CLASSIFY(row.limit == "restarts", "restarts");
}

const PropertyRoom room("sweeps", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("all shards together do everything once, and each as much as the others",
                     everything_is_dealt_out_once);
  passed &= property("a shard is I/N with I from 1 to N, and nothing else", shards_are_read_as_written);
  passed &= property("a plan of tasks is read as it was written", plans_of_tasks_are_read_as_written, kFewer);
  passed &= property("expected times are those of the history, and guesses in their scale",
                     expected_times_are_in_one_scale, kFewer / 2);
  passed &= property("a sweep that is resumed does what its run lacks, and shows what that holds",
                     what_is_recorded_is_left_out);
  passed &= property("as many tasks as keep each within its time, and no more", tasks_take_as_long_as_asked);
  passed &= property("options are taken out of a command line with their values",
                     options_are_taken_out_with_their_values);
  passed &= property("a task is done, failed or missing by what its program said",
                     tasks_are_what_their_programs_said);
  passed &= property("ranges name all numbers, each run once", ranges_name_all_numbers);
  passed &= property("a suite is the product of its dimensions, each case once", suites_are_products, kFewer);
  passed &= property("a generated set holds the instances of its seed, and says what they are",
                     sets_hold_what_they_say, kFewer);
  passed &=
      property("a folder is read in natural order, by numbers of robots", folders_are_read_in_order, kFewer);
  passed &= property("the row of a case keeps every option", rows_keep_all_options, kFewer);
  passed &= property("cases that differ have names of their own", cases_have_names_of_their_own);
  passed &= property("an outcome is the sum of its results", outcomes_are_sums);
  passed &= property("the limit that struck is named", the_limit_that_struck_is_named);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::sweeps_laws
