// Recording: what is written is what is read, all of a case or nothing.
#include "db/recorder.hpp"

#include <cmath>
#include <limits>

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;
using test::sample_case;
using test::sample_instance;
using test::sample_result;
using test::sample_run;

class Recording : public test::DatabaseTest {
 protected:
  ~Recording() override {
    if (std::filesystem::exists(file)) test::expect_sound(file);
  }
  RunRecorder begin(const RunInfo& info = sample_run()) {
    return must(RunRecorder::begin(must(Database::open(file)), info));
  }
};

TEST_F(Recording, every_field_of_a_run_is_kept) {
  const std::string uuid = begin().run_uuid();
  EXPECT_EQ(ask(file,
                "SELECT run || '|' || suite || '|' || status || '|' || branch || '|' || command_line || '|' "
                "|| options || '|' || seed || '|' || time_limit_s FROM v_runs"),
            uuid + "|smoke|running|main|sipplab bench --suite smoke|count=50 seed=1|1|300.0");
  EXPECT_EQ(
      ask(file,
          "SELECT commit_hash || '|' || commit_subject || '|' || committed_utc || '|' || ancestor_count "
          "FROM v_runs"),
      "0123456789abcdef0123456789abcdef01234567|Close the interval|2026-01-31T12:00:00Z|42");
  EXPECT_EQ(ask(file, "SELECT first_parent_hash || '|' || first_parent_count FROM commit_"),
            "fedcba9876543210fedcba9876543210fedcba98|40");
  EXPECT_EQ(ask(file,
                "SELECT host || '|' || cpu_model || '|' || cores || '|' || memory_bytes || '|' || kernel "
                "|| '|' || machine FROM v_runs"),
            "host|A CPU|2|8589934592|Linux 6.1|" + fingerprint(sample_run().machine));
  EXPECT_EQ(ask(file,
                "SELECT compiler || '|' || compiler_version || '|' || flags || '|' || build_type || '|' || "
                "assertions || '|' || sanitizers || '|' || binary_hash || '|' || dirty FROM v_runs"),
            "gcc|12.2.0|-O3|Release|0||00ff00ff00ff00ff|0");
}

TEST_F(Recording, every_field_of_a_result_is_kept) {
  auto recorder = begin();
  const CaseInfo parameters = sample_case(64, 2.5);
  ResultRow row = sample_result(0);
  row.position = 7;
  row.repetition = 3;
  row.makespan_s = 0.1 + 0.2;
  row.peak_memory_bytes = 123456789;
  recorder.add(parameters, sample_instance(0), row);
  ResultRow censored;
  censored.status = ResultStatus::kLimit;
  censored.limit = "expansions";
  censored.expansions = std::numeric_limits<std::uint64_t>::max();
  recorder.add(parameters, sample_instance(1), censored);
  ResultRow invalid = sample_result(2);
  invalid.status = ResultStatus::kInvalid;
  invalid.valid = false;
  invalid.violations = 2;
  invalid.message = "robots 1 and 2 overlap";
  recorder.add(parameters, sample_instance(2), invalid);
  must(recorder.commit());
  EXPECT_EQ(ask(file,
                "SELECT instance || '|' || instance_hash || '|' || position || '|' || repetition || '|' || "
                "status || '|' || "
                "planning_time_ns || '|' || tries || '|' || expansions || '|' || generations || '|' || "
                "plan_hash || '|' || valid || '|' || violations || '|' || peak_memory_bytes || '|' || "
                "ifnull(limit_struck, 'no limit') || '|' || ifnull(message, 'no message') "
                "FROM v_results WHERE status = 'solved'"),
            "warehouse seed=1 "
            "index=0|0000000000000001|7|3|solved|1000000|2|5000|20000|fedcba9876543210|1|0|123456789|"
            "no limit|no message");
  EXPECT_EQ(ask(file,
                "SELECT count(*) FROM v_results WHERE makespan_s = 0.1 + 0.2 AND flowtime_s = 1000.0 "
                "AND min_clearance_cells = 1e-12"),
            "1");
  EXPECT_EQ(ask(file,
                "SELECT limit_struck || '|' || (makespan_s IS NULL) || '|' || (plan_hash IS NULL) || '|' || "
                "(valid IS NULL) || '|' || expansions FROM v_results WHERE status = 'limit'"),
            "expansions|1|1|1|9223372036854775807");
  EXPECT_EQ(
      ask(file,
          "SELECT valid || '|' || violations || '|' || message FROM v_results WHERE status = 'invalid'"),
      "0|2|robots 1 and 2 overlap");
}

TEST_F(Recording, cases_come_back_with_all_their_parameters) {
  CaseInfo odd = sample_case(192, test::kInfinity);
  odd.environment = "empty";
  odd.map_spec = "empty:32x32";
  odd.instance_set = "files";
  odd.planner = "sipplab weight:1.5";
  odd.radius_cells = 0.3;
  odd.speed_cells_per_s = 2;
  odd.options["initial_order"] = odd.options["reschedule"] = "random";
  odd.options["any_angle"] = std::int64_t{0};
  odd.options["connectedness"] = std::int64_t{5};
  odd.options["weight"] = 1.5;
  odd.options["improve"] = "300i";
  odd.options["time_limit_s"] = test::kInfinity;
  odd.options["max_expansions"] = std::int64_t{1000};
  odd.options["max_restarts"] = std::int64_t{10};
  odd.options["seed"] = std::int64_t{-1};
  auto recorder = begin();
  test::record_case(recorder, odd, 1);
  test::record_case(recorder, sample_case(64), 1);
  auto database = must(Database::open(file));
  const auto recorded = must(recorded_cases(database, recorder.run_uuid()));
  ASSERT_EQ(recorded.size(), 2U);
  EXPECT_EQ(recorded[0].parameters, odd);
  EXPECT_EQ(recorded[1].parameters, sample_case(64));
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_run_cells WHERE ssi_s = 9e999 AND time_limit_s > 1e300"), "1");
  EXPECT_EQ(
      ask(file, "SELECT count(*) FROM v_run_cells WHERE max_expansions IS NULL AND max_restarts IS NULL"),
      "1");
}

TEST_F(Recording, parameters_differ_in_one_field_only_and_are_two_cases) {
  auto recorder = begin();
  CaseInfo other = sample_case(64);
  other.options["max_restarts"] = std::int64_t{1};
  test::record_case(recorder, sample_case(64), 1);
  test::record_case(recorder, other, 1);
  test::record_case(recorder, sample_case(64, test::kInfinity), 1);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM case_"), "3");
  // A second run finds the same cases again.
  auto second = begin();
  test::record_case(second, sample_case(64, test::kInfinity), 1);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM case_"), "3");
}

TEST_F(Recording, machines_builds_commits_and_instances_are_written_once) {
  for (int i = 0; i < 2; ++i) {
    auto recorder = begin();
    test::record_case(recorder, sample_case(64), 3);
  }
  EXPECT_EQ(ask(file,
                "SELECT (SELECT count(*) FROM machine) || (SELECT count(*) FROM build) || "
                "(SELECT count(*) FROM commit_) || (SELECT count(*) FROM instance)"),
            "1113");
  RunInfo elsewhere = sample_run();
  elsewhere.machine.kernel = "Linux 6.2";
  elsewhere.build.dirty = true;
  elsewhere.commit.reset();
  begin(elsewhere);
  EXPECT_EQ(ask(file,
                "SELECT (SELECT count(*) FROM machine) || (SELECT count(*) FROM build) || "
                "(SELECT count(*) FROM commit_)"),
            "221");
}

TEST_F(Recording, counts_of_a_commit_are_filled_in_when_they_become_known) {
  RunInfo shallow = sample_run();
  shallow.commit->ancestor_count = 0;
  begin(shallow);
  begin();
  begin(shallow);
  EXPECT_EQ(ask(file, "SELECT ancestor_count FROM commit_"), "42");
}

TEST_F(Recording, nothing_is_there_before_it_is_committed) {
  auto recorder = begin();
  recorder.add(sample_case(64), sample_instance(0), sample_result(0));
  EXPECT_EQ(ask(file, "SELECT count(*) FROM result"), "0");
  recorder.discard();
  recorder.add(sample_case(65), sample_instance(0), sample_result(0));
  must(recorder.commit());
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_results"), "1");
  must(recorder.finish(RunStatus::kFinished));
  EXPECT_EQ(ask(file, "SELECT status || (ended_utc >= started_utc) FROM v_runs"), "finished1");
}

TEST_F(Recording, an_instance_that_a_set_holds_twice_is_recorded_twice) {
  auto recorder = begin();
  for (const std::int64_t position : {0, 1}) {
    ResultRow row = sample_result(0);
    row.position = position;
    recorder.add(sample_case(64), sample_instance(0), row);
  }
  must(recorder.commit());
  EXPECT_EQ(
      ask(file,
          "SELECT count(*) || '|' || count(DISTINCT instance_hash) || '|' || max(position) FROM v_results"),
      "2|1|1");
}

TEST_F(Recording, two_results_of_one_instance_position_and_repetition_leave_nothing_of_the_batch) {
  auto recorder = begin();
  recorder.add(sample_case(64), sample_instance(0), sample_result(0));
  recorder.add(sample_case(64), sample_instance(0), sample_result(0));
  const auto result = recorder.commit();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kBadInput);
  EXPECT_EQ(ask(file, "SELECT (SELECT count(*) FROM cell) + (SELECT count(*) FROM instance)"), "0");
  // The keys of the undone instances must not be used again.
  recorder.discard();
  test::record_case(recorder, sample_case(64), 1);
}

TEST_F(Recording, a_planning_is_recorded_once_and_a_case_grows) {
  auto recorder = begin();
  const auto add = [&recorder](int index) {
    ResultRow row = sample_result(index);
    row.position = index;
    recorder.add(sample_case(64), sample_instance(index), row);
    return recorder.commit().has_value();
  };
  EXPECT_TRUE(add(0));
  EXPECT_TRUE(add(1));
  EXPECT_FALSE(add(1));
  recorder.discard();
  EXPECT_TRUE(add(2));
  EXPECT_EQ(ask(file, "SELECT count(*) || '|' || sum(results) || '|' || sum(solved) FROM v_run_cells"),
            "1|3|3");
  EXPECT_EQ(ask(file,
                "SELECT count(*) FROM cell_summary JOIN v_recomputed_cells AS made USING (case_id, run_id) "
                "WHERE cell_summary.median_flowtime_s = made.median_flowtime_s "
                "AND cell_summary.median_planning_time_s = made.median_planning_time_s"),
            "1");
}

TEST_F(Recording, an_attempt_says_where_and_what_it_took) {
  RunInfo info = sample_run();
  info.shard = "2/8";
  info.planned = 3;
  info.attempt = {"slurm", "17", "2", 1, 12.5, 1.5, std::int64_t{1} << 30};
  auto recorder = begin(info);
  recorder.add(sample_case(64), sample_instance(0), sample_result(0));
  must(recorder.commit({1'500'000'000, 4096}));
  EXPECT_EQ(
      ask(file,
          "SELECT shard || '|' || status || '|' || host || '|' || scheduler || '|' || job || '|' || task "
          "|| '|' || restarts || '|' || queued_s || '|' || cores || '|' || memory_limit_bytes || '|' || "
          "cpu_time_s || '|' || peak_memory_bytes FROM v_attempts"),
      "2/8|running|host|slurm|17|2|1|12.5|1.5|1073741824|1.5|4096");
  EXPECT_EQ(ask(file, "SELECT planned || '|' || results || '|' || missing || '|' || machines FROM v_sweeps"),
            "3|1|2|1");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM result JOIN attempt ON attempt.id = attempt_id"), "1");
  must(recorder.finish(RunStatus::kFinished, {2'000'000'000, 8192}));
  EXPECT_EQ(ask(file, "SELECT status || cpu_time_s FROM v_attempts"), "finished2.0");
}

TEST_F(Recording, a_run_that_goes_on_elsewhere_meets_the_times_of_no_other_machine) {
  std::string uuid;
  {
    auto recorder = begin();
    uuid = recorder.run_uuid();
    test::record_case(recorder, sample_case(64), 1);
    must(recorder.finish(RunStatus::kAborted));
  }
  RunInfo elsewhere = sample_run();
  elsewhere.machine.host = "another";
  auto recorder = must(RunRecorder::resume(must(Database::open(file)), uuid, elsewhere));
  ResultRow row = sample_result(1);
  row.position = 1;
  recorder.add(sample_case(64), sample_instance(1), row);
  must(recorder.commit());
  must(recorder.finish(RunStatus::kFinished));
  EXPECT_EQ(ask(file, "SELECT host || '|' || cpu_model FROM v_runs"), "another, host|2 machines: A CPU");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_runs WHERE machine IN (SELECT machine FROM v_attempts)"), "0");
  EXPECT_EQ(
      ask(file,
          "SELECT group_concat(host || results, ' ') FROM (SELECT * FROM v_machine_cells ORDER BY host)"),
      "another1 host1");
}

TEST_F(Recording, numbers_that_are_none_and_solved_without_costs_are_refused) {
  auto recorder = begin();
  ResultRow row = sample_result(0);
  row.makespan_s = std::nan("");
  recorder.add(sample_case(1), sample_instance(0), row);
  const auto refused = recorder.commit();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("NaN in a result"), std::string::npos) << refused.error().message;
  row.makespan_s.reset();
  recorder.add(sample_case(2), sample_instance(0), row);
  EXPECT_FALSE(recorder.commit());
  row = sample_result(0);
  row.valid = false;
  recorder.add(sample_case(3), sample_instance(0), row);
  EXPECT_FALSE(recorder.commit());
  EXPECT_EQ(ask(file, "SELECT count(*) FROM cell"), "0");
}

TEST_F(Recording, a_full_disk_is_an_error_and_loses_nothing_that_was_committed) {
  auto database = must(Database::open(file));
  const auto pages = must(database.connection().query_int("PRAGMA page_count", "asking"));
  must(database.connection().execute("PRAGMA max_page_count = " + std::to_string(pages + 10), "limiting"));
  auto recorder = must(RunRecorder::begin(std::move(database), sample_run()));
  test::record_case(recorder, sample_case(1), 10);
  for (int i = 0; i < 5000; ++i) recorder.add(sample_case(2), sample_instance(i), sample_result(i));
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto result = recorder.commit();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kFull);
    EXPECT_NE(result.error().message.find("no space left while writing"), std::string::npos);
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
  }
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_results"), "10");
  // Small cases still fit, and so does the end of the run.
  recorder.discard();
  test::record_case(recorder, sample_case(3), 1);
  must(recorder.finish(RunStatus::kAborted));
}

TEST_F(Recording, a_run_that_ended_early_is_resumed_under_its_uuid) {
  std::string uuid;
  {
    auto recorder = begin();
    uuid = recorder.run_uuid();
    test::record_case(recorder, sample_case(64), 2);
    must(recorder.finish(RunStatus::kAborted));
  }
  auto database = must(Database::open(file));
  const auto found = must(find_earlier_run(database, sample_run()));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->uuid, uuid);
  EXPECT_EQ(found->status, RunStatus::kAborted);
  EXPECT_EQ(found->results, 2);

  auto recorder = must(RunRecorder::resume(std::move(database), uuid, sample_run()));
  EXPECT_EQ(ask(file, "SELECT status || (ended_utc IS NULL) FROM run"), "running1");
  test::record_case(recorder, sample_case(65), 2);
  must(recorder.finish(RunStatus::kFinished));
  EXPECT_EQ(ask(file, "SELECT count(*) || group_concat(cases) || group_concat(results) FROM v_runs"), "124");
  auto again = must(Database::open(file));
  EXPECT_EQ(must(find_earlier_run(again, sample_run()))->status, RunStatus::kFinished);
  EXPECT_EQ(ask(file, "SELECT group_concat(status) FROM v_attempts"), "aborted,finished");
}

TEST_F(Recording, what_is_not_finished_is_resumed_before_what_is) {
  const std::string first = begin().run_uuid();
  ask(file, "UPDATE run SET writer = '' RETURNING 1");
  must(begin().finish(RunStatus::kFinished));
  auto database = must(Database::open(file));
  EXPECT_EQ(must(find_earlier_run(database, sample_run()))->uuid, first);
}

TEST_F(Recording, a_run_that_is_named_has_to_be_of_this_sweep) {
  const std::string uuid = begin().run_uuid();
  begin();
  auto database = must(Database::open(file));
  EXPECT_EQ(must(find_earlier_run(database, sample_run(), uuid.substr(0, 13)))->uuid, uuid);
  const auto other = find_earlier_run(database, sample_run("paper"), uuid);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("is not of this sweep and build"), std::string::npos);
  EXPECT_FALSE(find_earlier_run(database, sample_run(), "12345678"));
}

TEST_F(Recording, the_id_of_a_sweep_is_taken_once) {
  RunInfo info = sample_run();
  info.uuid = "12345678-1234-4123-8123-123456789012";
  EXPECT_EQ(begin(info).run_uuid(), info.uuid);
  const auto again = RunRecorder::begin(must(Database::open(file)), info);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("expected --resume"), std::string::npos);
}

TEST_F(Recording, a_part_with_a_rollback_journal_is_one_file) {
  {
    auto recorder = must(RunRecorder::begin(must(Database::open(file, Journal::kRollback)), sample_run()));
    test::record_case(recorder, sample_case(64), 3);
    EXPECT_FALSE(std::filesystem::exists(file.string() + "-wal"));
    EXPECT_FALSE(std::filesystem::exists(file.string() + "-journal"));
  }
  EXPECT_EQ(must(run_sql(file, "SELECT * FROM v_results")).rows.size(), 3U);
}

TEST_F(Recording, only_a_run_of_the_same_kind_is_resumed) {
  must(begin().finish(RunStatus::kAborted));
  auto database = must(Database::open(file));
  const auto resumable = [&](auto change) {
    RunInfo info = sample_run();
    change(info);
    return must(find_earlier_run(database, info)).has_value();
  };
  EXPECT_TRUE(resumable([](RunInfo&) {}));
  EXPECT_TRUE(resumable([](RunInfo& info) { info.command_line += " --resume"; }));
  EXPECT_FALSE(resumable([](RunInfo& info) { info.suite = "paper"; }));
  EXPECT_FALSE(resumable([](RunInfo& info) { info.options = "count=49 seed=1"; }));
  EXPECT_FALSE(resumable([](RunInfo& info) { info.build.binary_hash = "1"; }));
  EXPECT_FALSE(resumable([](RunInfo& info) { info.build.flags = "-O2"; }));
  EXPECT_TRUE(resumable([](RunInfo& info) { info.machine.cores = 3; })) << "it goes on elsewhere";
  must(exclude_run(database, "latest", "machine was busy"));
  EXPECT_FALSE(resumable([](RunInfo&) {}));
}

TEST_F(Recording, a_run_has_one_writer) {
  auto recorder = begin();
  {
    auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    must(connection.execute("UPDATE run SET writer = 'another process'", "taking over"));
  }
  recorder.add(sample_case(64), sample_instance(0), sample_result(0));
  const auto result = recorder.commit();
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("taken over by another process"), std::string::npos);
  EXPECT_FALSE(recorder.finish(RunStatus::kFinished));
  EXPECT_EQ(ask(file, "SELECT count(*) FROM cell"), "0");
}

TEST_F(Recording, fingerprints_keep_fields_apart) {
  MachineInfo machine = sample_run().machine;
  const std::string before = fingerprint(machine);
  EXPECT_EQ(fingerprint(machine), before);
  EXPECT_EQ(before.size(), 16U);
  machine.host = "hostA";
  machine.cpu_model = " CPU";
  MachineInfo shifted = machine;
  shifted.host = "host";
  shifted.cpu_model = "A CPU";
  EXPECT_NE(fingerprint(machine), fingerprint(shifted));
}

}  // namespace
}  // namespace sipplab::db
