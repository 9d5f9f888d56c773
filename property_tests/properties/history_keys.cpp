// What tells rows of the history apart: things that differ in one column alone stay two, wherever they go.
// The columns are those of the schema and of the structs, none is named here.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "db/comparisons.hpp"
#include "db/gate_runs.hpp"
#include "db/merge.hpp"
#include "db/queries.hpp"
#include "db/rows.hpp"
#include "db/run_names.hpp"
#include "db/summaries.hpp"
#include "db/trends.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_keys_laws {
namespace {

/// Histories with a cell for each column of a case: few of them.
constexpr int kManyCells = (kCasesOfHistories + 19) / 20;
constexpr int kFewCells = (kCasesOfHistories + 7) / 8;

// --- one column changed -------------------------------------------------------------

void change(std::string& value) { value += " and more"; }
void change(std::int64_t& value) {
  const bool flag = value == 0 || value == 1;
  value = flag ? 1 - value : value - 1;
}
void change(bool& value) { value = !value; }
void change(double& value) { value = value > 0 ? value / 2 : 0.5; }
void change(Value& value) {
  if (auto* text = std::get_if<std::string>(&value)) change(*text);
  if (auto* whole = std::get_if<std::int64_t>(&value)) change(*whole);
  if (auto* real = std::get_if<double>(&value)) *real = *real == kNoTimeLimit ? 7 : *real + 0.25;
}

constexpr const char* kWithoutColumn = "an_option_of_a_later_release";

CaseInfo whole_case() {
  CaseInfo info = case_number(0);
  info.options[kWithoutColumn] = std::string("value");
  return info;
}

/// Each column, and an option that has none.
std::vector<std::string> columns_of_case() {
  std::vector<std::string> columns;
  const CaseInfo info = whole_case();
  CaseInfo::columns(info, [&columns](const char* name, const auto&) { columns.emplace_back(name); });
  for (const auto& [name, value] : info.options) columns.push_back(name);
  return columns;
}

CaseInfo with_other(CaseInfo info, const std::string& column) {
  CaseInfo::columns(info, [&column](const char* name, auto& value) {
    if (name == column) change(value);
  });
  const auto option = info.options.find(column);
  if (option != info.options.end()) change(option->second);
  return info;
}

/// The case, and one for each of its columns that differs there.
std::vector<CaseInfo> all_neighbours() {
  std::vector<CaseInfo> cases = {whole_case()};
  for (const std::string& column : columns_of_case()) cases.push_back(with_other(whole_case(), column));
  CaseInfo without = whole_case();
  without.options.erase(kWithoutColumn);
  cases.push_back(without);
  return cases;
}

RunInfo info_of(const std::string& uuid, int commit = 1) {
  RunInfo info;
  info.uuid = uuid;
  info.suite = "smoke";
  info.commit = commit_number(commit);
  info.machine = machine_number(1);
  info.build = build_number(1);
  return info;
}

ResultRow timed(std::int64_t planning_time_ns, int position = 0, int repetition = 0) {
  ResultRow row;
  row.status = ResultStatus::kSolved;
  row.valid = true;
  row.makespan_s = 8;
  row.flowtime_s = 64;
  row.position = position;
  row.repetition = repetition;
  row.planning_time_ns = planning_time_ns;
  return row;
}

constexpr std::int64_t kMillisecond = 1'000'000;

/// Those of the cases that `is_wanted`, each planned in as many milliseconds as its number from `base` on.
void record_cases(const std::filesystem::path& file, const RunInfo& info, const std::vector<CaseInfo>& cases,
                  std::int64_t base, const std::function<bool(std::size_t)>& is_wanted) {
  Sweep sweep{info, {}, RunStatus::kFinished};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!is_wanted(i)) continue;
    sweep.plannings.push_back(
        {cases[i], instance_number(0), timed((base + static_cast<std::int64_t>(i)) * kMillisecond)});
  }
  record(file, sweep);
}

std::size_t place_of(const std::vector<CaseInfo>& cases, const CaseInfo& parameters) {
  const auto found = std::find(cases.begin(), cases.end(), parameters);
  RC_ASSERT(found != cases.end());
  return static_cast<std::size_t>(found - cases.begin());
}

/// What a run holds are these cases, each with its own time.
void check_cases(Database& database, const std::string& uuid, const std::vector<CaseInfo>& cases,
                 std::int64_t base, const std::set<std::size_t>& expected) {
  std::set<std::size_t> seen;
  for (const RecordedCase& recorded : must(recorded_cases(database, uuid))) {
    const std::size_t place = place_of(cases, recorded.parameters);
    RC_ASSERT(seen.insert(place).second);
    RC_ASSERT(recorded.rows.size() == 1U);
    RC_ASSERT(recorded.rows.front().planning_time_ns ==
              (base + static_cast<std::int64_t>(place)) * kMillisecond);
  }
  RC_ASSERT(seen == expected);
}

std::set<std::size_t> any_subset(std::size_t size) {
  std::set<std::size_t> subset;
  for (std::size_t i = 0; i < size; ++i) {
    if (any_flag()) subset.insert(i);
  }
  return subset;
}

void cases_stay_apart() {
  const std::vector<CaseInfo> cases = all_neighbours();
  std::set<std::size_t> all;
  for (std::size_t i = 0; i < cases.size(); ++i) all.insert(i);
  const std::set<std::size_t> here = any_subset(cases.size());
  const NewHistory first;
  const NewHistory second;
  const std::string base = new_uuid();
  const std::string head = new_uuid();
  // One run in two files, some of its cases in each; and one more.
  RunInfo part = info_of(base);
  part.planned = static_cast<std::int64_t>(cases.size());
  part.shard = "1/2";
  record_cases(first.path(), part, cases, 100, [&](std::size_t i) { return here.count(i) > 0; });
  part.shard = "2/2";
  record_cases(second.path(), part, cases, 100, [&](std::size_t i) { return here.count(i) == 0; });
  record_cases(second.path(), info_of(head, 2), cases, 300, [](std::size_t) { return true; });
  {
    Database database = first.open();
    check_cases(database, base, cases, 100, here);
    must(merge_into(database, second.path()));
  }
  Database database = first.open();
  check_cases(database, base, cases, 100, all);
  check_cases(database, head, cases, 300, all);
  RC_ASSERT(ask(database, "SELECT count(*) FROM case_") == static_cast<std::int64_t>(cases.size()));

  // Compared, each with itself.
  const auto sides =
      std::pair(must(resolve_side(database, "run:" + base)), must(resolve_side(database, "run:" + head)));
  const auto pairs = must(paired_cells(database, sides.first, sides.second));
  std::set<std::size_t> paired;
  for (const PairedCell& cell : pairs) {
    const std::size_t place = place_of(cases, cell.parameters);
    RC_ASSERT(paired.insert(place).second);
    RC_ASSERT(cell.base_planner.empty());
    RC_ASSERT(cell.results.size() == 1U);
    RC_ASSERT(cell.results.front().base.planning_time_ns ==
              (100 + static_cast<std::int64_t>(place)) * kMillisecond);
    RC_ASSERT(cell.results.front().head.planning_time_ns ==
              (300 + static_cast<std::int64_t>(place)) * kMillisecond);
  }
  RC_ASSERT(paired == all);

  // And in the views, what they took, and in trends.
  std::set<std::pair<std::int64_t, double>> shown;
  for (const CellSummary& cell : must(show_run(database, head)).cells) {
    const double expected = static_cast<double>(300 + place_of(cases, cell.parameters)) / 1000;
    RC_ASSERT(std::abs(cell.mean_planning_time_s.value_or(0) - expected) < 1e-9);
    shown.emplace(cell.case_id, expected);
  }
  RC_ASSERT(shown.size() == cases.size());
  std::set<std::size_t> taken;
  for (const CaseTime& time : must(case_times(database))) {
    const std::size_t place = place_of(cases, time.parameters);
    RC_ASSERT(std::abs(time.mean_planning_time_s - static_cast<double>(200 + place) / 1000) < 1e-9);
    taken.insert(place);
  }
  RC_ASSERT(taken == all);
  TrendQuery query;
  query.metric = find_trend_metric("max-runtime");
  const auto series = must(read_trend(database, query));
  RC_ASSERT(series.size() == cases.size());
  for (const TrendSeries& one : series) {
    RC_ASSERT(one.points.size() == 2U);
    RC_ASSERT(shown.count({one.case_id, one.points[1].value}) == 1U);
    RC_ASSERT(std::abs(one.points[1].value - one.points[0].value - 0.2) < 1e-9);
  }
}

/// A filter by one column finds what has that value, and nothing else.
void filters_find_their_column() {
  const std::vector<CaseInfo> cases = all_neighbours();
  const NewHistory history;
  const std::string uuid = new_uuid();
  record_cases(history.path(), info_of(uuid), cases, 100, [](std::size_t) { return true; });
  Database database = history.open();
  for (const CaseInfo& wanted :
       {cases[0],
        cases[static_cast<std::size_t>(any_whole(1, static_cast<std::int64_t>(cases.size()) - 1))]}) {
    std::map<std::string, std::pair<CaseFilter, std::function<bool(const CaseInfo&)>>> filters;
    CaseFilter plain;
    plain.environment = wanted.environment;
    filters["environment"] = {plain,
                              [&](const CaseInfo& info) { return info.environment == wanted.environment; }};
    plain = {};
    plain.robots = wanted.robots;
    filters["robots"] = {plain, [&](const CaseInfo& info) { return info.robots == wanted.robots; }};
    plain = {};
    plain.map = wanted.map_spec;
    filters["map"] = {plain, [&](const CaseInfo& info) { return info.map_spec == wanted.map_spec; }};
    plain = {};
    plain.planner = wanted.planner;
    filters["planner"] = {plain, [&](const CaseInfo& info) { return info.planner == wanted.planner; }};
    for (const auto& [name, ignored] : whole_case().options) {
      plain = {};
      plain.options[name] = wanted.option(name);
      filters[name] = {plain, [&wanted, option = name](const CaseInfo& info) {
                         return info.option(option) == wanted.option(option);
                       }};
    }
    for (const auto& [name, filter] : filters) {
      TrendQuery query;
      query.metric = find_trend_metric("max-runtime");
      query.cases = filter.first;
      std::multiset<std::int64_t> found;
      for (const TrendSeries& one : must(read_trend(database, query))) {
        found.insert(std::llround(one.points.front().value * 1000));
      }
      std::multiset<std::int64_t> expected;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        if (filter.second(cases[i])) expected.insert(100 + static_cast<std::int64_t>(i));
      }
      RC_LOG() << name << '\n';
      RC_ASSERT(found == expected);
    }
  }
}

/// Noise that calibrations measured, each cell for itself.
void noise_stays_with_its_case() {
  const std::vector<CaseInfo> cases = all_neighbours();
  const NewHistory history;
  Database database = history.open();
  GateRun run = any_gate_run();
  run.calibration = true;
  run.differing = 0;
  run.differences.clear();
  const auto calibrations = any_whole(1, 2);
  for (std::int64_t number = 0; number < calibrations; ++number) {
    run.cells.clear();
    for (std::size_t i = 0; i <= cases.size(); ++i) {
      GateCellRow cell;
      if (i < cases.size()) cell.parameters = cases[i];
      cell.verdict = "equivalent";
      cell.pairs = {static_cast<double>(i), static_cast<double>(i) + 0.25 + static_cast<double>(number)};
      cell.fresh_pairs = {-0.5};
      run.cells.push_back(std::move(cell));
    }
    must(record_gate_run(database, run));
  }
  const auto noise = must(gate_noise(database, {run.machine, run.suite, run.method, run.pair_seconds}));
  RC_ASSERT(noise.size() == cases.size() + 1);
  std::set<std::size_t> seen;
  for (const GateNoise& row : noise) {
    const std::size_t place = row.parameters ? place_of(cases, *row.parameters) : cases.size();
    RC_ASSERT(seen.insert(place).second);
    RC_ASSERT(row.comparisons.size() == static_cast<std::size_t>(calibrations));
    for (std::size_t number = 0; number < row.comparisons.size(); ++number) {
      const std::vector<double> expected = {static_cast<double>(place),
                                            static_cast<double>(place) + 0.25 + static_cast<double>(number)};
      RC_ASSERT(row.comparisons[number] == expected);
    }
  }
}

/// Noise of another kind says nothing: of each part of the kind, alone.
void noise_is_of_one_kind() {
  constexpr int kNewest = 20;
  const NewHistory history;
  Database database = history.open();
  GateRun run = any_gate_run();
  run.calibration = true;
  const GateKind kind{run.machine, run.suite, run.method, run.pair_seconds};
  const auto others = any_whole(0, 6);
  if (others == 0) run.machine.kernel += "x";
  if (others == 1) run.suite += "x";
  if (others == 2) ++run.method;
  if (others == 3) run.pair_seconds *= 2;
  if (others == 4) run.calibration = false;
  const std::string uuid = must(record_gate_run(database, run));
  if (others == 5) must(exclude_run(database, uuid, "noise"));
  RC_ASSERT(must(gate_noise(database, kind)).empty() == (others < 6));
  if (others < 6) return;
  // Of many the newest.
  for (int number = 0; number < kNewest; ++number) {
    run.started_utc = "2027" + second_number(number % 10).substr(4);
    must(record_gate_run(database, run));
  }
  for (const GateNoise& row : must(gate_noise(database, kind))) {
    RC_ASSERT(row.comparisons.size() == static_cast<std::size_t>(kNewest));
  }
}

// --- machines and builds ------------------------------------------------------------

/// One that differs in each member alone.
std::vector<MachineInfo> all_machines() {
  std::vector<MachineInfo> machines(6, machine_number(1));
  change(machines[1].host);
  change(machines[2].cpu_model);
  change(machines[3].cores);
  change(machines[4].memory_bytes);
  change(machines[5].kernel);
  return machines;
}

std::vector<BuildInfo> all_builds() {
  std::vector<BuildInfo> builds(9, build_number(1));
  change(builds[1].compiler);
  change(builds[2].compiler_version);
  change(builds[3].flags);
  change(builds[4].build_type);
  change(builds[5].assertions);
  change(builds[6].sanitizers);
  change(builds[7].binary_hash);
  change(builds[8].dirty);
  return builds;
}

/// Times are compared where machine and kind of build are the same, counts wherever they are from.
void times_belong_to_machine_and_build() {
  const NewHistory history;
  const std::vector<MachineInfo> machines = all_machines();
  const std::vector<BuildInfo> builds = all_builds();
  // Which of these a person would compare: flags, program and uncommitted changes are what is measured.
  std::set<std::tuple<std::string, std::string, std::string, std::string, bool, std::string>> contexts;
  const auto runs = any_whole(2, 6);
  for (std::int64_t i = 0; i < runs; ++i) {
    RunInfo info = info_of(new_uuid(), static_cast<int>(any_whole(1, 3)));
    info.machine = machines[static_cast<std::size_t>(any_whole(0, 5))];
    info.build = builds[static_cast<std::size_t>(any_whole(0, 8))];
    const BuildInfo& build = info.build;
    contexts.emplace(fingerprint(info.machine), build.compiler, build.compiler_version, build.build_type,
                     build.assertions, build.sanitizers);
    record_cases(history.path(), info, {case_number(0)}, 10, [](std::size_t) { return true; });
  }
  Database database = history.open();
  for (const TrendMetric& metric : trend_metrics()) {
    if (!metric.of_case) continue;
    TrendQuery query;
    query.metric = &metric;
    const auto series = must(read_trend(database, query));
    RC_LOG() << metric.name << '\n';
    RC_ASSERT(series.size() == (metric.timed ? contexts.size() : 1U));
    std::int64_t counted = 0;
    for (const TrendSeries& one : series) {
      for (const TrendPoint& point : one.points) counted += point.runs;
    }
    RC_ASSERT(counted == runs);
  }
}

void machines_and_builds_stay_apart() {
  const NewHistory history;
  Database database = history.open();
  std::set<std::int64_t> keys;
  for (int again = 0; again < 2; ++again) {
    for (const MachineInfo& machine : all_machines())
      keys.insert(must(machine_id(database.connection(), machine)));
  }
  RC_ASSERT(keys.size() == all_machines().size());
  keys.clear();
  for (int again = 0; again < 2; ++again) {
    for (const BuildInfo& build : all_builds()) keys.insert(must(build_id(database.connection(), build)));
  }
  RC_ASSERT(keys.size() == all_builds().size());
  // And across two files.
  const NewHistory other;
  {
    Database source = other.open();
    for (const MachineInfo& machine : all_machines()) must(machine_id(source.connection(), machine));
    for (const BuildInfo& build : all_builds()) must(build_id(source.connection(), build));
  }
  const MergeReport report = must(merge_into(database, other.path()));
  RC_ASSERT(report.rows_of("machine") == 0);
  RC_ASSERT(report.rows_of("build") == 0);
}

// --- plannings ----------------------------------------------------------------------

struct Planning {
  int instance = 0;
  int position = 0;
  int repetition = 0;
  std::int64_t number = 0;  ///< of its own
};

/// Of two instances that stand at some of three positions, one or two repetitions.
std::vector<Planning> any_plannings(std::int64_t first) {
  std::vector<Planning> plannings;
  for (int position = 0; position < 3; ++position) {
    const auto instance = static_cast<int>(any_whole(0, 1));
    for (int repetition = 0; repetition < 2; ++repetition) {
      if (any_whole(0, 2) == 0) continue;
      plannings.push_back(
          {instance, position, repetition, first + static_cast<std::int64_t>(plannings.size())});
    }
  }
  return plannings;
}

ResultRow row_of(const Planning& planning) {
  const auto number = static_cast<std::uint64_t>(planning.number);
  ResultRow row = timed(planning.number * kMillisecond, planning.position, planning.repetition);
  row.status = planning.number % 5 == 0 ? ResultStatus::kLimit : ResultStatus::kSolved;
  row.makespan_s = static_cast<double>(planning.number) + 0.5;
  row.flowtime_s = static_cast<double>(planning.number) + 0.25;
  row.tries = 10 + number;
  row.expansions = 20 + number;
  row.generations = 30 + number;
  row.plan_hash = 40 + number;
  row.limit = "limit " + std::to_string(number);
  row.message = "message " + std::to_string(number);
  return row;
}

void check_row(const ResultRow& row, const Planning& planning) {
  const ResultRow expected = row_of(planning);
  RC_ASSERT(row.status == expected.status);
  RC_ASSERT(row.planning_time_ns == expected.planning_time_ns);
  RC_ASSERT(row.makespan_s == expected.makespan_s);
  RC_ASSERT(row.flowtime_s == expected.flowtime_s);
  RC_ASSERT(row.tries == expected.tries);
  RC_ASSERT(row.expansions == expected.expansions);
  RC_ASSERT(row.generations == expected.generations);
  RC_ASSERT(row.plan_hash == expected.plan_hash);
  RC_ASSERT(row.limit == expected.limit);
  RC_ASSERT(row.message == expected.message);
}

/// Each planning of the base with the one of the head that is as far down among those of its instance.
void plannings_are_paired_by_instance_and_turn() {
  const NewHistory history;
  const std::string uuids[] = {new_uuid(), new_uuid()};
  std::vector<Planning> plannings[] = {any_plannings(1), any_plannings(100)};
  for (int side = 0; side < 2; ++side) {
    Sweep sweep{info_of(uuids[side], 1 + side), {}, RunStatus::kFinished};
    if (side == 1 && any_flag()) sweep.info.machine = machine_number(2);
    for (const Planning& planning : plannings[side]) {
      sweep.plannings.push_back({case_number(0), instance_number(planning.instance), row_of(planning)});
    }
    record(history.path(), sweep);
  }
  // Which planning of the head belongs to which of the base.
  const auto turn = [](const std::vector<Planning>& all, const Planning& one) {
    return std::count_if(all.begin(), all.end(), [&one](const Planning& other) {
      return other.instance == one.instance && other.repetition == one.repetition &&
             other.position < one.position;
    });
  };
  std::vector<std::pair<Planning, Planning>> expected;
  for (const Planning& base : plannings[0]) {
    for (const Planning& head : plannings[1]) {
      if (base.instance == head.instance && base.repetition == head.repetition &&
          turn(plannings[0], base) == turn(plannings[1], head)) {
        expected.emplace_back(base, head);
      }
    }
  }
  Database database = history.open();
  const auto cells = must(paired_cells(database, {"", {}, {1}}, {"", {}, {2}}));
  if (plannings[0].empty() || plannings[1].empty()) {
    RC_ASSERT(cells.empty());
    return;
  }
  RC_ASSERT(cells.size() == 1U);
  RC_ASSERT(cells[0].base_run == uuids[0]);
  RC_ASSERT(cells[0].head_run == uuids[1]);
  RC_ASSERT(cells[0].results.size() == expected.size());
  RC_ASSERT(cells[0].base_only == plannings[0].size() - expected.size());
  RC_ASSERT(cells[0].head_only == plannings[1].size() - expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const PairedResult& pair = cells[0].results[i];
    RC_ASSERT(pair.instance == instance_number(expected[i].first.instance).name);
    RC_ASSERT(pair.instance_hash == instance_number(expected[i].first.instance).content_hash);
    RC_ASSERT(pair.base.position == expected[i].first.position);
    RC_ASSERT(pair.base.repetition == expected[i].first.repetition);
    check_row(pair.base, expected[i].first);
    check_row(pair.head, expected[i].second);
  }
  const bool same_machine = ask(database, "SELECT count(DISTINCT machine_id) FROM run") == 1;
  RC_ASSERT(cells[0].same_machine == same_machine);
  RC_ASSERT(cells[0].same_program);
}

// --- which cells are compared -------------------------------------------------------

constexpr const char* kRules[] = {"turns", "wait_before_move_s", "inflate_distance_cells", "inflate_time_s"};

struct Side {
  std::vector<CaseInfo> cases;
  std::vector<std::set<int>> instances;  ///< of each
};

/// Cases that differ in one column or two, each with some instances.
Side any_side(const std::vector<std::string>& columns) {
  Side side;
  for (auto left = any_whole(1, 3); left > 0; --left) {
    CaseInfo info = whole_case();
    for (auto changes = any_whole(0, 2); changes > 0; --changes) {
      info = with_other(
          info,
          columns[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(columns.size()) - 1))]);
    }
    if (std::find(side.cases.begin(), side.cases.end(), info) != side.cases.end()) continue;
    side.cases.push_back(info);
    side.instances.push_back({static_cast<int>(any_whole(0, 2)), static_cast<int>(any_whole(0, 2))});
  }
  return side;
}

using CasePairs = std::set<std::pair<std::size_t, std::size_t>>;

/// Pairs those of both sides that have just one partner, which has just them.
void pair_only_ones(const Side& base, const Side& head,
                    const std::function<bool(std::size_t, std::size_t)>& are_alike, CasePairs& pairs) {
  const auto is_free = [&](std::size_t i, bool of_base) {
    return std::none_of(pairs.begin(), pairs.end(),
                        [&](const auto& pair) { return (of_base ? pair.first : pair.second) == i; });
  };
  CasePairs found;
  for (std::size_t i = 0; i < base.cases.size(); ++i) {
    for (std::size_t j = 0; j < head.cases.size(); ++j) {
      if (is_free(i, true) && is_free(j, false) && are_alike(i, j)) found.emplace(i, j);
    }
  }
  for (const auto& pair : found) {
    const auto rivals = std::count_if(found.begin(), found.end(), [&pair](const auto& other) {
      return other.first == pair.first || other.second == pair.second;
    });
    if (rivals == 1) pairs.insert(pair);
  }
}

void cells_are_paired_as_promised() {
  // Few columns, so that cases meet: two at random, the planner, and often a rule or the robots.
  std::vector<std::string> columns = {"planner"};
  const std::vector<std::string> all = columns_of_case();
  for (int i = 0; i < 2; ++i)
    columns.push_back(all[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(all.size()) - 1))]);
  if (any_flag()) columns.push_back(any_flag() ? "robots" : kRules[any_whole(0, 3)]);
  const Side base = any_side(columns);
  const Side head = any_side(columns);
  const NewHistory history;
  const Side* sides[] = {&base, &head};
  for (int number = 0; number < 2; ++number) {
    Sweep sweep{info_of(new_uuid(), 1 + number), {}, RunStatus::kFinished};
    for (std::size_t i = 0; i < sides[number]->cases.size(); ++i) {
      for (const int instance : sides[number]->instances[i]) {
        sweep.plannings.push_back(
            {sides[number]->cases[i], instance_number(instance), timed(kMillisecond, instance)});
      }
    }
    record(history.path(), sweep);
  }
  CasePairs expected;
  for (std::size_t i = 0; i < base.cases.size(); ++i) {
    for (std::size_t j = 0; j < head.cases.size(); ++j) {
      if (base.cases[i] == head.cases[j]) expected.emplace(i, j);
    }
  }
  const std::size_t same = expected.size();
  pair_only_ones(
      base, head,
      [&](std::size_t i, std::size_t j) {
        CaseInfo other = head.cases[j];
        other.planner = base.cases[i].planner;
        return other == base.cases[i];
      },
      expected);
  pair_only_ones(
      base, head,
      [&](std::size_t i, std::size_t j) {
        const CaseInfo& a = base.cases[i];
        const CaseInfo& b = head.cases[j];
        const bool rules = std::all_of(std::begin(kRules), std::end(kRules),
                                       [&](const char* rule) { return a.option(rule) == b.option(rule); });
        const bool meet = std::any_of(base.instances[i].begin(), base.instances[i].end(),
                                      [&](int instance) { return head.instances[j].count(instance) > 0; });
        return rules && meet && a.robots == b.robots;
      },
      expected);
  Database database = history.open();
  CasePairs found;
  for (const PairedCell& cell : must(paired_cells(database, {"", {}, {1}}, {"", {}, {2}}))) {
    const std::size_t of_head = place_of(head.cases, cell.parameters);
    const auto pair = std::find_if(expected.begin(), expected.end(),
                                   [of_head](const auto& one) { return one.second == of_head; });
    RC_ASSERT(pair != expected.end());
    RC_ASSERT(found.insert(*pair).second);
    const CaseInfo& of_base = base.cases[pair->first];
    RC_ASSERT(cell.base_planner == (of_base == cell.parameters ? "" : of_base.planner));
    std::set<int> both;
    for (const int instance : base.instances[pair->first]) {
      if (head.instances[of_head].count(instance) > 0) both.insert(instance);
    }
    RC_ASSERT(cell.results.size() == both.size());
    RC_ASSERT(cell.base_only == base.instances[pair->first].size() - both.size());
    RC_ASSERT(cell.head_only == head.instances[of_head].size() - both.size());
  }
  RC_ASSERT(found == expected);
  RC_CLASSIFY(same > 0, "equal cases");
  RC_CLASSIFY(expected.size() > same, "other cases");
}

/// Of each column alone: whether a case is compared with one that differs in it.
void rules_and_robots_part_cells() {
  const NewHistory history;
  const auto record_alone = [&history](const CaseInfo& info, int instance) {
    Sweep sweep{info_of(new_uuid()), {}, RunStatus::kFinished};
    sweep.plannings.push_back({info, instance_number(instance), timed(kMillisecond)});
    record(history.path(), sweep);
  };
  record_alone(whole_case(), 0);
  const std::vector<std::string> columns = columns_of_case();
  // Of what differs in more than the planner, those that have an instance in common are compared.
  const auto instance = static_cast<int>(any_whole(0, 1));
  for (const std::string& column : columns) record_alone(with_other(whole_case(), column), instance);
  Database database = history.open();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool is_rule = std::find(std::begin(kRules), std::end(kRules), columns[i]) != std::end(kRules);
    const bool expected = columns[i] == "planner" || (instance == 0 && !is_rule && columns[i] != "robots");
    const auto cells =
        must(paired_cells(database, {"", {}, {1}}, {"", {}, {static_cast<std::int64_t>(i) + 2}}));
    RC_LOG() << columns[i] << '\n';
    RC_ASSERT(cells.size() == (expected ? 1U : 0U));
    if (expected) RC_ASSERT(cells[0].base_planner == whole_case().planner);
    if (expected) RC_ASSERT(cells[0].results.size() == (instance == 0 ? 1U : 0U));
  }
}

// --- sides --------------------------------------------------------------------------

/// Of a commit, a branch, a run: which runs are meant, the newest cell of each case among them.
void sides_are_what_they_are_called() {
  const NewHistory history;
  std::vector<Sweep> sweeps;
  const auto count = any_whole(1, 4);
  for (std::int64_t i = 0; i < count; ++i) {
    Sweep sweep{info_of(new_uuid(), static_cast<int>(any_whole(1, 3))), {}, RunStatus::kFinished};
    sweep.info.branch = any_flag() ? "main" : "topic";
    sweep.info.build = build_number(static_cast<int>(any_whole(1, 2)));
    for (int number = 0; number < 2; ++number) {
      if (any_flag())
        sweep.plannings.push_back({case_number(number), instance_number(0), timed((i + 1) * kMillisecond)});
    }
    record(history.path(), sweep);
    sweeps.push_back(std::move(sweep));
  }
  Database database = history.open();
  std::set<std::size_t> excluded;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (any_whole(0, 3) > 0) continue;
    must(exclude_run(database, sweeps[i].info.uuid, "noise"));
    excluded.insert(i);
  }
  const auto runs_of = [&](const std::function<bool(const Sweep&)>& is_meant) {
    std::vector<std::int64_t> ids;
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      if (excluded.count(i) == 0 && is_meant(sweeps[i])) ids.push_back(static_cast<std::int64_t>(i) + 1);
    }
    return ids;
  };
  const auto of_commit = [&](const std::string& hash) {
    const auto clean =
        runs_of([&](const Sweep& one) { return one.info.commit->hash == hash && !one.info.build.dirty; });
    return !clean.empty() ? clean : runs_of([&](const Sweep& one) { return one.info.commit->hash == hash; });
  };
  const auto check = [&](const std::string& text, const std::vector<std::int64_t>& expected) {
    const auto side = resolve_side(database, text);
    RC_LOG() << text << '\n';
    RC_ASSERT(side.has_value() == !expected.empty());
    if (side) RC_ASSERT(side->run_ids == expected);
  };
  for (int number = 1; number <= 3; ++number)
    check("commit:" + commit_number(number).hash, of_commit(commit_number(number).hash));
  for (const std::string branch : {"main", "topic"}) {
    // The newest commit that a run that counts has on it.
    std::string newest;
    for (int number = 1; number <= 3; ++number) {
      const std::string hash = commit_number(number).hash;
      if (!runs_of([&](const Sweep& one) {
             return one.info.branch == branch && one.info.commit->hash == hash;
           }).empty())
        newest = hash;
    }
    check("branch:" + branch, newest.empty() ? std::vector<std::int64_t>{} : of_commit(newest));
  }
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    check("run:" + sweeps[i].info.uuid,
          runs_of([&](const Sweep& one) { return one.info.uuid == sweeps[i].info.uuid; }));
  }
  const auto counting = runs_of([](const Sweep&) { return true; });
  check("run:latest", counting.empty() ? counting : std::vector<std::int64_t>{counting.back()});
  if (counting.empty()) return;
  // All together against the newest: of each case the newest cell.
  for (const PairedCell& cell : must(paired_cells(database, {"", {}, counting}, {"", {}, counting}))) {
    std::int64_t newest = 0;
    for (const std::int64_t id : counting) {
      for (const Planned& planned : sweeps[static_cast<std::size_t>(id) - 1].plannings) {
        if (planned.parameters == cell.parameters) newest = id;
      }
    }
    RC_ASSERT(cell.base_run == sweeps[static_cast<std::size_t>(newest) - 1].info.uuid);
    RC_ASSERT(cell.results.front().base.planning_time_ns == newest * kMillisecond);
  }
}

const PropertyRoom room("history_keys", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("cases that differ in one column are recorded, merged, compared and followed apart",
                     cases_stay_apart, kManyCells);
  passed &=
      property("a filter by one column finds what has its value", filters_find_their_column, kManyCells);
  passed &= property("noise stays with its case", noise_stays_with_its_case, kManyCells);
  passed &=
      property("noise is that of one machine, suite, method and budget", noise_is_of_one_kind, kFewCells);
  passed &= property("machines and builds that differ in one column are two", machines_and_builds_stay_apart,
                     kManyCells);
  passed &= property("times are followed on one machine and kind of build, counts everywhere",
                     times_belong_to_machine_and_build, kFewCells);
  passed &= property("plannings are compared by instance and turn", plannings_are_paired_by_instance_and_turn,
                     kFewCells);
  passed &= property("cells are paired as guaranteed", cells_are_paired_as_promised, kFewCells);
  passed &= property("cells that differ in a rule of motion or in robots are not compared",
                     rules_and_robots_part_cells, kManyCells / 2);
  passed &= property("a side of a comparison is the runs that it is called after",
                     sides_are_what_they_are_called, kFewCells);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_keys_laws
