// The doctor: silent about a sound history, and right about each kind of damage.
#include "db/doctor.hpp"

#include <fstream>

#include "db/queries.hpp"
#include "db/tests/history_support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;
using test::record_version;

class Doctor : public test::DatabaseTest {
 protected:
  DoctorReport look(DoctorOptions options = {}) {
    auto database = options.fix ? must(Database::open(file)) : must(Database::open_read_only(file));
    return examine(database, options);
  }
  /// The one finding that is expected.
  DoctorFinding finding(DoctorOptions options = {}) {
    const DoctorReport report = look(options);
    EXPECT_EQ(report.findings.size(), 1U);
    if (report.findings.empty()) return {};
    EXPECT_FALSE(report.findings[0].advice.empty());
    return report.findings[0];
  }
  void change(const std::string& sql) {
    auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    must(connection.execute("PRAGMA foreign_keys = OFF", "damaging"));
    must(connection.execute(sql, "damaging"));
  }
  static constexpr DoctorOptions kFix{false, true};
};

TEST_F(Doctor, a_sound_history_has_no_finding) {
  record_version(file, {1, 1, 8});
  record_version(file, {2, 1, 8}, 128);
  const DoctorReport report = look();
  for (const DoctorFinding& finding : report.findings) ADD_FAILURE() << finding.what;
  EXPECT_TRUE(report.sound());
  EXPECT_GE(report.checks.size(), 8U);
}

TEST_F(Doctor, finds_a_name_that_stands_for_two_commands) {
  record_version(file, {1, 1, 8});
  record_version(file, {2, 1, 8});
  change("UPDATE case_ SET planner = 'cmd:my planner'");
  change("UPDATE run SET options = options || ' planner=0a memory_limit=1'");
  EXPECT_TRUE(look().sound());
  change("UPDATE run SET options = replace(options, '0a', '0b') WHERE id = 1");
  EXPECT_EQ(finding().check, "planners");
  EXPECT_EQ(finding().what, "\"cmd:my planner\" stands for 2 commands");
}

TEST_F(Doctor, leaves_no_file_behind_and_heeds_none) {
  record_version(file, {1, 1, 8});
  const std::filesystem::path here = std::filesystem::current_path();
  const std::filesystem::path empty = file.parent_path() / "empty";
  std::filesystem::create_directory(empty);
  std::filesystem::current_path(empty);
  EXPECT_TRUE(look().sound());
  EXPECT_TRUE(std::filesystem::is_empty(empty));
  std::ofstream{":memory:"} << "not a database";
  EXPECT_TRUE(look().sound());
  std::filesystem::current_path(here);
}

TEST_F(Doctor, what_the_recorder_summarises_is_what_the_results_say) {
  auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run()));
  for (int count = 0; count < 10; ++count) {
    const CaseInfo parameters = test::sample_case(count);
    for (int i = 0; i < count; ++i) {
      ResultRow row = i % 4 == 3 ? test::failed_result() : test::sample_result(i);
      row.planning_time_ns = 1'000'003LL * ((i * 7) % 11);
      if (row.flowtime_s) row.flowtime_s = 1000.0 / (1 + (i * 5) % 7);
      recorder.add(parameters, test::sample_instance(i), row);
    }
    must(recorder.commit_case(parameters));
  }
  must(recorder.finish(RunStatus::kFinished));
  EXPECT_TRUE(look().sound());
  EXPECT_EQ(ask(file, "SELECT count(*) FROM cell_summary WHERE median_flowtime_s IS NULL"), "1")
      << "the empty one";
}

TEST_F(Doctor, summaries_are_compared_with_results_and_made_anew) {
  record_version(file, {1, 1, 8});
  change("UPDATE cell_summary SET mean_flowtime_s = mean_flowtime_s * (1 + 1e-15)");
  EXPECT_TRUE(look().sound()) << "sums of another release of SQLite";
  change("UPDATE cell_summary SET mean_flowtime_s = mean_flowtime_s * (1 + 1e-9)");
  EXPECT_TRUE(look({true, false}).sound()) << "the quick look does not read results";
  EXPECT_EQ(finding().check, "summaries");
  EXPECT_TRUE(finding(kFix).fixed);
  EXPECT_TRUE(look().sound());

  change("UPDATE instance_summary SET solved = solved - 1 WHERE instance_id = 2");
  EXPECT_EQ(finding().check, "summaries");
  EXPECT_TRUE(finding(kFix).fixed);
  EXPECT_TRUE(look().sound());

  change("DELETE FROM cell_summary");
  EXPECT_EQ(finding({true, false}).check, "summaries");
  EXPECT_TRUE(look(kFix).sound());
  EXPECT_EQ(ask(file, "SELECT solved FROM cell_summary"), "8");
}

TEST_F(Doctor, a_killed_run_is_closed_and_can_still_be_resumed) {
  {
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run()));
    test::record_case(recorder, test::sample_case(64), 3);
  }
  EXPECT_TRUE(look().sound()) << "its process, this one, is alive";
  ask(file, "UPDATE run SET writer = 'gone' RETURNING 1");
  EXPECT_EQ(finding().check, "unfinished runs");
  EXPECT_TRUE(finding(kFix).fixed);
  EXPECT_EQ(ask(file, "SELECT status FROM run"), "aborted");
  auto database = must(Database::open(file));
  EXPECT_TRUE(must(find_resumable_run(database, test::sample_run())));
}

TEST_F(Doctor, an_empty_run_is_excluded) {
  must(must(RunRecorder::begin(must(Database::open(file)), test::sample_run())).finish(RunStatus::kAborted));
  EXPECT_EQ(finding().check, "empty runs");
  EXPECT_TRUE(finding(kFix).fixed);
  EXPECT_TRUE(look().sound());
}

TEST_F(Doctor, rows_that_others_deleted_are_missed) {
  record_version(file, {1, 1, 8});
  change("DELETE FROM progress WHERE instance_id = 3; DELETE FROM result WHERE instance_id = 3");
  const DoctorReport report = look();
  ASSERT_GE(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].check, "results");
  EXPECT_NE(report.findings[0].what.find("9 results, expected 10"), std::string::npos)
      << report.findings[0].what;
}

TEST_F(Doctor, references_to_nothing_are_found) {
  record_version(file, {1, 1, 8});
  change("DELETE FROM machine");
  const DoctorFinding found = finding();
  EXPECT_EQ(found.check, "foreign keys");
  EXPECT_NE(found.what.find("rows of run point to rows of machine"), std::string::npos) << found.what;
}

TEST_F(Doctor, a_view_that_is_missing_or_another_is_found) {
  record_version(file, {1, 1, 8});
  change("DROP VIEW v_slowest; CREATE VIEW v_slowest AS SELECT nonsense FROM run");
  const DoctorReport report = look();
  ASSERT_EQ(report.findings.size(), 2U);
  EXPECT_EQ(report.findings[0].check, "schema");
  EXPECT_EQ(report.findings[1].check, "views");
}

TEST_F(Doctor, a_damaged_page_is_a_finding_and_not_the_end) {
  record_version(file, {1, 1, 8});
  ask(file, "PRAGMA wal_checkpoint(TRUNCATE)");
  const auto pages = std::stol(ask(file, "SELECT rootpage FROM sqlite_schema WHERE name = 'result'"));
  {
    std::fstream bytes{file, std::ios::in | std::ios::out | std::ios::binary};
    bytes.seekp((pages - 1) * 4096 + 16);
    bytes << std::string(2000, '\x5a');
  }
  const DoctorReport report = look();
  EXPECT_FALSE(report.sound());
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings[0].check, "integrity");
}

}  // namespace
}  // namespace sipplab::db
