// The history: what is written is what is read.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/queries.hpp"
#include "db/recorder.hpp"
#include "db/sqlite/statement.hpp"
#include "db/summaries.hpp"
#include "db/tests/plain_case.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/scratch_folder.hpp"
#include "property_tests/support/texts.hpp"

namespace sipplab::db::history_laws {
namespace {

/// Checking all of a file takes longer the more runs there are in it.
constexpr int kThoroughOneIn = 32;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// --- rows ---------------------------------------------------------------------------

std::int64_t any_number() { return *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 40); }

/// Counts that are "no limit" at the top.
std::uint64_t any_count() {
  return *rc::gen::weightedOneOf<std::uint64_t>(
      {{3, rc::gen::inRange<std::uint64_t>(0, 1u << 30)}, {1, rc::gen::just(kNoCountLimit)}});
}

double any_time() {
  return *rc::gen::weightedOneOf<double>({{3, any_real_between(0, 1e6)}, {1, any_of({0.0, kInfinity})}});
}

CaseInfo any_case_info() {
  CaseInfo info = test::plain_case();
  info.environment = *any_text();
  info.map_spec = *any_text();
  info.instance_set = *any_text();
  info.robots = *rc::gen::inRange<std::int64_t>(0, 4);
  info.planner = *any_text();
  info.radius_cells = any_time();
  info.speed_cells_per_s = any_time();
  const auto count = [] { return static_cast<std::int64_t>(std::min(any_count(), kNoCountLimit)); };
  for (const char* time : {"ssi_s", "time_limit_s"}) info.options[time] = any_time();
  for (const char* word : {"initial_order", "reschedule", "improve"}) info.options[word] = *any_text();
  for (const char* limit : {"max_expansions", "max_restarts"}) info.options[limit] = count();
  info.options["any_angle"] = *rc::gen::element<std::int64_t>(0, 1);
  info.options["connectedness"] = *rc::gen::inRange<std::int64_t>(2, 6);
  info.options["seed"] = *rc::gen::arbitrary<std::int64_t>();
  return info;
}

ResultRow any_row() {
  ResultRow row;
  row.status = static_cast<ResultStatus>(*rc::gen::inRange(0, 4));
  row.planning_time_ns = any_number();
  const bool has_plan = row.status == ResultStatus::kSolved || row.status == ResultStatus::kInvalid;
  if (has_plan) {
    row.makespan_s = *any_real_between(0, 1e6);
    row.flowtime_s = *any_real_between(0, 1e9);
    row.plan_hash = *rc::gen::arbitrary<std::uint64_t>();
    row.valid = row.status == ResultStatus::kSolved;
    row.min_clearance_cells =
        *rc::gen::weightedOneOf<double>({{3, any_real_between(-1, 1)}, {1, rc::gen::just(kInfinity)}});
  }
  row.tries = any_count();
  row.expansions = any_count();
  row.generations = any_count();
  row.violations = any_number();
  if (*rc::gen::arbitrary<bool>()) row.peak_memory_bytes = any_number();
  row.limit = *any_text();
  row.message = *any_text();
  row.made_by = *rc::gen::element<std::string>("", "prioritized", "complete");
  if (*rc::gen::arbitrary<bool>()) row.ssi_kept_s = *rc::gen::element(0.0, 1.0 / 3, kNoTimeLimit);
  return row;
}

struct Recorded {
  CaseInfo parameters;
  std::vector<InstanceInfo> instances;
  std::vector<ResultRow> rows;
};

InstanceInfo instance_info(std::int64_t number) {
  return {"instance " + std::to_string(number),
          "map",
          "name, 'quoted' " + std::to_string(number),
          number,
          number + 1,
          number + 2,
          number};
}

Recorded any_recorded() {
  Recorded recorded;
  recorded.parameters = any_case_info();
  const auto results = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 5));
  for (int i = 0; i < results; ++i) {
    recorded.instances.push_back(instance_info(*rc::gen::inRange<std::int64_t>(0, 4)));
    recorded.rows.push_back(any_row());
    // One instance several times: position and repetition tell the results apart.
    recorded.rows.back().position = i / 2;
    recorded.rows.back().repetition = i % 2;
  }
  return recorded;
}

std::vector<Recorded> any_run() {
  std::vector<Recorded> run;
  const auto cases = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 4));
  for (int i = 0; i < cases; ++i) {
    Recorded recorded = any_recorded();
    bool known = false;
    for (const Recorded& other : run) known |= other.parameters == recorded.parameters;
    if (!known) run.push_back(std::move(recorded));
  }
  return run;
}

RunInfo any_run_info() {
  static int commits = 0;  // a hash names one commit, so each run has one of its own
  RunInfo info;
  info.suite = *any_text();
  info.branch = *any_text();
  info.command_line = *any_text();
  info.options = *any_text();
  info.seed = *rc::gen::arbitrary<std::uint64_t>();
  info.time_limit_s = any_time();
  if (*rc::gen::arbitrary<bool>()) {
    info.commit = CommitInfo{"0123456789abcdef" + std::to_string(++commits),
                             "2026-01-31T12:00:00Z",
                             *any_text(),
                             *any_text(),
                             any_number(),
                             any_number()};
  }
  info.machine = {*any_text(), *any_text(), any_number(), any_number(), *any_text()};
  info.build = {*any_text(),
                *any_text(),
                *any_text(),
                *any_text(),
                *rc::gen::arbitrary<bool>(),
                *any_text(),
                *any_text(),
                *rc::gen::arbitrary<bool>()};
  return info;
}

/// The UUID of the run.
std::string record(Database database, const RunInfo& info, const std::vector<Recorded>& run) {
  RunRecorder recorder = must(RunRecorder::begin(std::move(database), info));
  for (const Recorded& recorded : run) {
    for (std::size_t i = 0; i < recorded.rows.size(); ++i) {
      recorder.add(recorded.parameters, recorded.instances[i], recorded.rows[i]);
    }
    must(recorder.commit());
  }
  must(recorder.finish(RunStatus::kFinished));
  return recorder.run_uuid();
}

// --- reading them again -------------------------------------------------------------

std::optional<std::int64_t> optional_integer(const sqlite::Statement& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  return row.integer(column);
}

void check_run(Database& database, const std::string& uuid, const RunInfo& info) {
  auto select = must(sqlite::Statement::prepare(
      database.connection(),
      "SELECT suite, run.branch, command_line, options, seed, time_limit_s, status, host, cpu_model, cores, "
      "memory_bytes, kernel, compiler, compiler_version, flags, build_type, assertions, sanitizers, "
      "binary_hash, dirty, hash, committed_utc, subject, first_parent_hash, ancestor_count, "
      "first_parent_count FROM run JOIN machine ON machine.id = machine_id JOIN build ON build.id = build_id "
      "LEFT JOIN commit_ ON commit_.id = commit_id WHERE uuid = ?",
      "reading a run"));
  RC_ASSERT(must(select.bind(uuid).step()));
  int column = 0;
  for (const std::string& text : {info.suite, info.branch, info.command_line, info.options}) {
    RC_ASSERT(select.text(column++) == text);
  }
  RC_ASSERT(static_cast<std::uint64_t>(select.integer(column++)) == info.seed);
  RC_ASSERT(select.real(column++) == info.time_limit_s);
  RC_ASSERT(select.text(column++) == "finished");
  RC_ASSERT(select.text(column++) == info.machine.host);
  RC_ASSERT(select.text(column++) == info.machine.cpu_model);
  RC_ASSERT(select.integer(column++) == info.machine.cores);
  RC_ASSERT(select.integer(column++) == info.machine.memory_bytes);
  RC_ASSERT(select.text(column++) == info.machine.kernel);
  for (const std::string& text :
       {info.build.compiler, info.build.compiler_version, info.build.flags, info.build.build_type}) {
    RC_ASSERT(select.text(column++) == text);
  }
  RC_ASSERT(select.integer(column++) == static_cast<std::int64_t>(info.build.assertions));
  RC_ASSERT(select.text(column++) == info.build.sanitizers);
  RC_ASSERT(select.text(column++) == info.build.binary_hash);
  RC_ASSERT(select.integer(column++) == static_cast<std::int64_t>(info.build.dirty));
  RC_ASSERT(select.is_null(column) == !info.commit.has_value());
  if (!info.commit) return;
  for (const std::string& text :
       {info.commit->hash, info.commit->committed_utc, info.commit->subject, info.commit->first_parent}) {
    RC_ASSERT(select.text(column++) == text);
  }
  RC_ASSERT(select.integer(column++) == info.commit->ancestor_count);
  RC_ASSERT(select.integer(column++) == info.commit->first_parent_count);
}

void check_row(const sqlite::Statement& select, const InstanceInfo& instance, const ResultRow& row) {
  int column = 0;
  RC_ASSERT(select.text(column++) == instance.content_hash);
  RC_ASSERT(select.text(column++) == instance.name);
  RC_ASSERT(select.integer(column++) == instance.robots);
  RC_ASSERT(select.integer(column++) == instance.width_cells);
  RC_ASSERT(select.integer(column++) == instance.height_cells);
  RC_ASSERT(select.integer(column++) == instance.blocked_cells);
  RC_ASSERT(select.integer(column++) == static_cast<std::int64_t>(row.status));
  RC_ASSERT(select.integer(column++) == row.planning_time_ns);
  RC_ASSERT(select.optional_real(column++) == row.makespan_s);
  RC_ASSERT(select.optional_real(column++) == row.flowtime_s);
  RC_ASSERT(static_cast<std::uint64_t>(select.integer(column++)) == row.tries);
  RC_ASSERT(static_cast<std::uint64_t>(select.integer(column++)) == row.expansions);
  RC_ASSERT(static_cast<std::uint64_t>(select.integer(column++)) == row.generations);
  const auto hash = optional_integer(select, column++);
  RC_ASSERT(hash.has_value() == row.plan_hash.has_value());
  if (hash) RC_ASSERT(static_cast<std::uint64_t>(*hash) == *row.plan_hash);
  const auto valid = optional_integer(select, column++);
  RC_ASSERT(valid.has_value() == row.valid.has_value());
  if (valid) RC_ASSERT((*valid != 0) == *row.valid);
  RC_ASSERT(select.integer(column++) == row.violations);
  RC_ASSERT(select.optional_real(column++) == row.min_clearance_cells);
  RC_ASSERT(optional_integer(select, column++) == row.peak_memory_bytes);
  RC_ASSERT(select.optional_text(column++).value_or("") == row.limit);
  RC_ASSERT(select.optional_text(column++).value_or("") == row.message);
  RC_ASSERT(select.optional_text(column++).value_or("") == row.made_by);
  RC_ASSERT(select.optional_real(column++) == row.ssi_kept_s);
}

void check_case(Database& database, const std::string& uuid, std::size_t place, const Recorded& recorded) {
  // Cells are numbered in the order in which cases were finished.
  auto select = must(sqlite::Statement::prepare(
      database.connection(),
      "SELECT content_hash, name, instance.robots, width_cells, height_cells, blocked_cells, result.status, "
      "planning_time_ns, makespan_s, flowtime_s, tries, expansions, generations, plan_hash, valid, "
      "violations, min_clearance_cells, peak_memory_bytes, limit_struck, message, made_by, ssi_kept_s FROM "
      "result "
      "JOIN instance ON instance.id = instance_id WHERE cell_id = (SELECT cell.id FROM cell "
      "JOIN run ON run.id = run_id WHERE uuid = ? ORDER BY cell.id LIMIT 1 OFFSET ?) "
      "ORDER BY position, repetition",
      "reading results"));
  select.bind(uuid, static_cast<std::int64_t>(place));
  for (std::size_t i = 0; i < recorded.rows.size(); ++i) {
    RC_ASSERT(must(select.step()));
    check_row(select, recorded.instances[i], recorded.rows[i]);
  }
  RC_ASSERT(!must(select.step()));
}

void check_sound(Database& database) {
  RC_ASSERT(must(count_stale_summaries(database.connection())) == 0);
  auto& connection = database.connection();
  RC_ASSERT(must(connection.query_text("PRAGMA integrity_check", "checking")) == "ok");
  RC_ASSERT(must(connection.query_int("SELECT count(*) FROM pragma_foreign_key_check", "checking")) == 0);
}

const PropertyRoom room("history", kCasesOfHistories, [] {
  bool passed = true;

  {
    // One file for all runs: what is there already has to stay as it is.
    const ScratchFolder folder;
    const std::filesystem::path path = folder.path() / "history.db";
    passed &= property("a run reads back from the history as it was recorded", [&path] {
      const RunInfo info = any_run_info();
      const std::vector<Recorded> run = any_run();
      const std::string uuid = record(must(Database::open(path)), info, run);
      Database database = must(Database::open(path));
      check_run(database, uuid, info);
      const std::vector<RecordedCase> cases = must(recorded_cases(database, uuid));
      RC_ASSERT(cases.size() == run.size());
      for (std::size_t i = 0; i < run.size(); ++i) {
        RC_ASSERT(cases[i].parameters == run[i].parameters);
        check_case(database, uuid, i, run[i]);
      }
      const bool thorough = *rc::gen::inRange(0, kThoroughOneIn) == 0;
      if (thorough) check_sound(database);
      RC_CLASSIFY(thorough, "checked as a whole");
      RC_CLASSIFY(!run.empty(), "with cases");
      RC_CLASSIFY(info.commit.has_value(), "with a commit");
    });
  }

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_laws
