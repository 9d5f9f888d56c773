// Histories drawn small; see histories.hpp.
#include "property_tests/support/histories.hpp"

#include <optional>
#include <utility>

#include "db/best_known.hpp"
#include "db/queries.hpp"
#include "db/rows.hpp"
#include "db/run_names.hpp"
#include "db/sqlite/statement.hpp"
#include "db/tests/plain_case.hpp"
#include "property_tests/support/encounters.hpp"

namespace sipplab::db {
namespace {

constexpr const char* kAsking = "asking";
constexpr const char* kCampaigns[] = {"00000000-0000-4000-8000-000000000001",
                                      "00000000-0000-4000-8000-000000000002"};

std::string any_word(std::initializer_list<const char*> words) {
  const std::vector<std::string> all(words.begin(), words.end());
  return all[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(all.size()) - 1))];
}

/// From 1/8 on.
double any_positive(int most) { return static_cast<double>(any_whole(1, 8 * most)) / 8; }

/// Later than any before: no two things happen at once.
std::string next_moment() {
  static int moment = 100'000;
  return "2026-02-01T00:00:00." + std::to_string(++moment) + "Z";
}

template <class T>
std::optional<T> maybe(T value) {
  return any_flag() ? std::optional<T>(std::move(value)) : std::nullopt;
}

}  // namespace

std::int64_t any_whole(std::int64_t least, std::int64_t most) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(least, most + 1));
}
bool any_flag() { return any_whole(0, 1) == 1; }

std::int64_t ask(Database& database, const std::string& sql) {
  return must(database.connection().query_int(sql, kAsking));
}

std::vector<std::size_t> any_order(std::size_t size) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < size; ++i)
    order.insert(order.begin() + any_whole(0, static_cast<std::int64_t>(i)), i);
  return order;
}

Table rows_of(Database& database, const std::string& sql) {
  return must(rest_of(must(sqlite::Statement::prepare(database.connection(), sql, kAsking))));
}

Texts texts_of(Database& database, const std::string& sql) {
  Texts texts;
  for (const auto& row : rows_of(database, sql).rows) texts.push_back(std::get<std::string>(row[0]));
  return texts;
}
Texts views_of(Database& database) {
  return texts_of(database, "SELECT name FROM sqlite_schema WHERE type = 'view' ORDER BY name");
}

NewHistory::NewHistory() {
  static const ScratchFolder kPattern;
  static const std::filesystem::path kEmpty = kPattern.path() / "history.db";
  if (!std::filesystem::exists(kEmpty)) must(Database::open(kEmpty));
  std::filesystem::copy_file(kEmpty, path());
}

CommitInfo commit_number(int number) {
  CommitInfo commit;
  const auto hash = [](int of) { return std::string(39, 'a') + static_cast<char>('0' + of); };
  commit.hash = hash(number);
  commit.committed_utc = second_number(number);
  commit.subject = "change " + std::to_string(number);
  if (number > 1) commit.first_parent = hash(number - 1);
  commit.ancestor_count = 10 + number;
  commit.first_parent_count = number;
  if (number > 2) commit.later_parents = {hash(number - 2)};
  return commit;
}

MachineInfo machine_number(int number) {
  return {"host " + std::to_string(number), "processor", 2, std::int64_t{1} << 30,
          "Linux 6." + std::to_string(number)};
}

BuildInfo build_number(int number) {
  BuildInfo build{"gcc", "12.2", "-O3", "Release", false, "", "program " + std::to_string(number), false};
  build.dirty = number == 2;
  return build;
}

CaseInfo case_number(int number) {
  CaseInfo info = test::plain_case();
  info.robots = 1 + number;
  if (number == 1) info.options["any_angle"] = std::int64_t{0};
  if (number == 2) info.options["time_limit_s"] = kNoTimeLimit;
  if (number == 3) info.options["connectedness"] = std::int64_t{3};
  return info;
}

InstanceInfo instance_number(int number) {
  return {"hash " + std::to_string(number),
          "map hash",
          "maps/a_b-random-" + std::to_string(number) + ".scen",
          number + 2,
          10 + number,
          20 + number,
          number};
}

std::string second_number(int number) { return "2026-01-01T00:00:0" + std::to_string(number) + ".000Z"; }

RunOrigin any_origin() {
  RunOrigin origin;
  const auto commit = static_cast<int>(any_whole(0, 3));
  if (commit > 0) origin.commit = commit_number(commit);
  origin.branch = any_word({"main", "topic"});
  origin.machine = machine_number(static_cast<int>(any_whole(1, 2)));
  origin.build = build_number(static_cast<int>(any_whole(1, 2)));
  return origin;
}

ResultRow any_result() {
  ResultRow row;
  row.status = static_cast<ResultStatus>(any_whole(0, 3));
  row.planning_time_ns = any_whole(1, 9) * 1'000'000;
  if (row.status == ResultStatus::kSolved || row.status == ResultStatus::kInvalid) {
    row.makespan_s = any_positive(9);
    row.flowtime_s = any_positive(40);
    row.plan_hash = static_cast<std::uint64_t>(any_whole(1, 3)) << 62;
    row.valid = row.status == ResultStatus::kSolved;
    row.min_clearance_cells = any_positive(1);
    row.ssi_kept_s = any_positive(5);
    if (any_flag()) {
      RetimingRow retiming;
      retiming.executable = any_flag();
      retiming.given_valid = any_flag();
      retiming.given_violations = any_whole(0, 3);
      retiming.given_makespan_s = any_positive(9);
      retiming.given_flowtime_s = any_positive(40);
      retiming.retime_ns = any_whole(0, 9);
      retiming.unit_step_cost = maybe(any_whole(1, 50));
      row.retiming = retiming;
    }
    const auto points = any_whole(0, 2);
    for (std::int64_t i = 0; i < points; ++i) {
      row.progress.push_back(
          {10 * i, 1000 * (i + 1), any_positive(40), any_positive(9), any_positive(30), any_positive(7)});
    }
  }
  if (row.status == ResultStatus::kLimit) row.limit = any_word({"time", "expansions"});
  row.tries = static_cast<std::uint64_t>(any_whole(1, 4));
  row.expansions = static_cast<std::uint64_t>(any_whole(0, 90));
  row.generations = static_cast<std::uint64_t>(any_whole(0, 90));
  row.violations = row.status == ResultStatus::kInvalid ? any_whole(1, 4) : 0;
  row.peak_memory_bytes = maybe(any_whole(0, 5000));
  row.message = row.status == ResultStatus::kInvalid ? "they collide" : "";
  row.made_by = any_word({"", "prioritized", "complete"});
  row.instructions = maybe(any_whole(1, 99));
  row.cpu_time_ns = maybe(any_whole(1, 99) * 1000);
  if (any_flag()) {
    row.flowtime_bound_s = any_positive(30);
    row.makespan_bound_s = any_positive(7);
  }
  if (any_flag()) row.reported = {{"nodes", any_positive(9)}, {"cost", any_positive(9)}};
  return row;
}

Sweep any_sweep() {
  Sweep sweep;
  static_cast<RunOrigin&>(sweep.info) = any_origin();
  sweep.info.uuid = new_uuid();
  sweep.info.suite = any_word({"smoke", "density"});
  sweep.info.options = any_word({"count=1 seed=1", "count=2 seed=1"});
  sweep.info.command_line = "sipplab bench";
  sweep.info.planned = any_whole(1, 12);
  sweep.info.attempt.scheduler = any_word({"", "slurm"});
  sweep.info.attempt.restarts = any_whole(0, 2);
  sweep.info.attempt.cores = 2;
  const auto repetitions = any_whole(1, 2);
  for (int number = 0; number < 4; ++number) {
    if (!any_flag()) continue;
    const auto instances = static_cast<int>(any_whole(1, 3));
    for (int position = 0; position < instances; ++position) {
      for (std::int64_t repetition = 0; repetition < repetitions; ++repetition) {
        Planned planned{case_number(number), instance_number(position), any_result()};
        planned.row.position = position;
        planned.row.repetition = repetition;
        sweep.plannings.push_back(std::move(planned));
      }
    }
  }
  sweep.status = any_flag() ? RunStatus::kFinished : RunStatus::kAborted;
  return sweep;
}

void record(const std::filesystem::path& file, const Sweep& sweep) {
  RunRecorder recorder = must(RunRecorder::begin(must(Database::open(file)), sweep.info));
  std::int64_t spent_ns = 0;
  for (const Planned& planned : sweep.plannings) {
    recorder.add(planned.parameters, planned.instance, planned.row);
    spent_ns += planned.row.planning_time_ns;
  }
  must(recorder.commit({spent_ns, 4096}));
  must(recorder.finish(sweep.status, {spent_ns, 8192}));
}

MeasurementRun any_report() {
  MeasurementRun run;
  run.uuid = new_uuid();
  run.started_utc = second_number(static_cast<int>(any_whole(1, 5)));
  static_cast<RunOrigin&>(run.info) = any_origin();
  run.info.suite = any_word({"micro", "other"});
  run.info.options = "context";
  const auto repetitions = any_whole(1, 2);
  for (const char* benchmark : {"sort", "search"}) {
    for (std::int64_t repetition = 0; repetition < repetitions; ++repetition) {
      Measurement one;
      one.benchmark = benchmark;
      one.repetition = repetition;
      one.iterations = any_whole(1, 9);
      one.real_time_ns = maybe(any_positive(90));
      one.cpu_time_ns = maybe(any_positive(90));
      one.error = one.real_time_ns ? "" : "failed";
      one.threads = any_whole(1, 4);
      one.label = any_word({"", "label"});
      one.aggregate = any_word({"", "median"});
      if (any_flag()) one.counters = {{"items", any_positive(9)}};
      run.measurements.push_back(std::move(one));
    }
  }
  return run;
}

PropertyRun any_property_run() {
  PropertyRun run;
  run.uuid = new_uuid();
  run.started_utc = second_number(static_cast<int>(any_whole(1, 5)));
  run.room = any_word({"grid", "search"});
  run.title = any_word({"it holds", "it holds twice"});
  run.seed = static_cast<std::uint64_t>(any_whole(0, 9)) << 60;
  run.max_success = 100;
  run.status = any_word({"passed", "failed", "gave_up", "crashed"});
  run.cases = any_whole(1, 100);
  run.discards = any_whole(0, 9);
  run.shrink_tries = any_whole(0, 9);
  run.shrinks = any_whole(0, run.shrink_tries);
  run.wall_time_ns = any_whole(1, 9) * 1'000'000'000;
  if (any_flag()) run.classes["dense"] = any_whole(1, run.cases);
  if (run.status != "passed") run.message = "it does not";
  if (run.status == "failed") {
    run.reproduce = "reproduce=x";
    run.counterexample = "1";
    run.case_robots = any_whole(1, 4);
    run.case_cells = any_whole(1, 30);
  }
  return run;
}

FuzzRun any_fuzz_run() {
  FuzzRun run;
  run.uuid = new_uuid();
  run.campaign = any_word({kCampaigns[0], kCampaigns[1]});
  run.target = any_word({"plan", "parse"});
  run.mode = any_word({"smoke", "for", "nightly"});
  run.started_utc = second_number(static_cast<int>(any_whole(1, 5)));
  run.wall_time_ns = any_whole(0, 10) * 1'000'000'000;
  run.cpu_time_ns = any_whole(0, 10) * 1'000'000'000;
  run.status = any_word({"clean", "findings", "broken"});
  run.seed = static_cast<std::uint64_t>(any_whole(0, 9));
  run.budget_executions = maybe(any_whole(1, 99));
  run.budget_s = maybe(any_positive(10));
  run.workers = any_whole(1, 3);
  run.target_hash = any_word({"hash 1", "hash 2"});
  run.executions = any_whole(1, 1000);
  run.edges = any_whole(0, 9);
  run.features = any_whole(0, 9);
  run.corpus_files = any_whole(0, 9);
  run.corpus_bytes = any_whole(0, 99);
  run.peak_memory_bytes = any_whole(0, 99);
  run.slowest_input_s = any_whole(0, 9);
  run.crashes = any_whole(0, 2);
  run.timeouts = any_whole(0, 2);
  run.ooms = any_whole(0, 2);
  run.leaks = any_whole(0, 2);
  run.snapshots = {{1, 2, 3, 4, 5, 6}, {10, 20, 30, 40, 50, 60}};
  run.counts = {{"event", "inputs", any_whole(1, 99)},
                {"event", "two robots", any_whole(1, 50)},
                {"claim", "it holds", any_whole(1, 50)}};
  return run;
}

GateRun any_gate_run() {
  GateRun run;
  static_cast<RunOrigin&>(run) = any_origin();
  run.calibration = any_flag();
  run.suite = any_word({"gate", "gate-crowded"});
  run.method = any_whole(1, 2);
  run.base_build = build_number(static_cast<int>(any_whole(1, 2)));
  if (any_flag()) run.base_commit = commit_number(1);
  run.seed = static_cast<std::uint64_t>(any_whole(0, 9));
  run.pair_seconds = any_positive(1);
  run.tolerance = any_positive(1);
  run.injected_slowdown = any_flag() ? 0.125 : 0;
  run.wall_time_ns = any_whole(1, 9) * 1'000'000'000;
  run.started_utc = second_number(static_cast<int>(any_whole(1, 5)));
  run.compared = any_whole(1, 9);
  run.differing = any_whole(0, 1);
  run.verdict = any_word({"equivalent", "regressed", "inconclusive"});
  run.reason = "a reason";
  for (const int number : {-1, 0, 1}) {
    GateCellRow cell;
    if (number >= 0) cell.parameters = case_number(number);
    cell.slowdown = any_positive(1);
    cell.p_value = any_positive(1);
    if (any_flag()) {
      cell.confirm_slowdown = any_positive(1);
      cell.confirm_p_value = any_positive(1);
    }
    cell.at_most = maybe(any_positive(1));
    cell.noise = any_positive(1);
    cell.effect_floor = any_positive(1);
    cell.detectable = maybe(any_positive(1));
    cell.verdict = any_word({"equivalent", "regressed", "inconclusive"});
    const auto pairs = any_whole(1, 3);
    for (std::int64_t i = 0; i < pairs; ++i) cell.pairs.push_back(any_positive(1));
    if (any_flag()) cell.fresh_pairs = {any_positive(1), any_positive(1)};
    run.cells.push_back(std::move(cell));
  }
  if (run.differing > 0) run.differences = {{case_number(0), instance_number(0), "plan", "one", "another"}};
  return run;
}

Finding any_finding() {
  Finding finding;
  finding.target = any_word({"plan", "parse"});
  finding.kind = any_word({"claim", "crash"});
  finding.claim = "it holds";
  finding.frames = "f < g";
  finding.message = "it does not";
  finding.input = "an input";
  const auto size = any_whole(1, 3);
  finding.minimal = finding.input.substr(0, static_cast<std::size_t>(size));
  if (size < 3) finding.robots = size;
  if (size < 3) finding.cells = 10 * size;
  return finding;
}

void record_some_of_everything(const std::filesystem::path& file) {
  const auto sweeps = any_whole(1, 3);
  for (std::int64_t i = 0; i < sweeps; ++i) record(file, any_sweep());
  Database database = must(Database::open(file));
  const auto reports = any_whole(0, 2);
  for (std::int64_t i = 0; i < reports; ++i) must(record_measurements(database, any_report()));
  const auto properties = any_whole(0, 4);
  for (std::int64_t i = 0; i < properties; ++i) {
    must(record_property_runs(database, any_origin(), {any_property_run()}, any_word({"", "", "a-mutant"})));
  }
  const auto fuzz_runs = any_whole(0, 3);
  std::optional<std::int64_t> fuzz_run;
  for (std::int64_t i = 0; i < fuzz_runs; ++i) {
    fuzz_run = must(record_fuzz_run(database, any_origin(), any_fuzz_run()));
  }
  // Of a campaign there is one measurement, in whichever file.
  std::int64_t reached = 1;
  for (const char* campaign : kCampaigns) {
    must(record_fuzz_coverage(database, campaign,
                              {{"planner/grid/a.cpp", 10, reached},
                               {"planner/grid/b.cpp", 20, 3 + reached},
                               {"planner/search/a.cpp", 35, 9 + reached}}));
    ++reached;
  }
  const auto findings = any_whole(0, 3);
  for (std::int64_t i = 0; i < findings; ++i) {
    // Found, and now and then tried again.
    const auto stored = must(record_finding(database, any_origin(), any_finding(), fuzz_run, next_moment()));
    if (any_flag()) must(record_replay(database, any_origin(), stored.id, any_flag(), next_moment()));
  }
  const auto gates = any_whole(0, 2);
  for (std::int64_t i = 0; i < gates; ++i) must(record_gate_run(database, any_gate_run()));
  must(record_best_known(database, {{"a_b", "random", any_whole(0, 2), any_whole(1, 3), 1, any_whole(1, 50)},
                                    {"axb", "random", 1, 2, 1, any_whole(1, 50)}}));
}

std::vector<std::string> all_runs(Database& database) {
  std::vector<std::string> uuids;
  for (const auto& row : rows_of(database, "SELECT uuid FROM run ORDER BY id").rows) {
    uuids.push_back(std::get<std::string>(row[0]));
  }
  return uuids;
}

}  // namespace sipplab::db
