// Merging: everything arrives, once, and says where it came from.
#include "db/merge.hpp"

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "db/doctor.hpp"
#include "db/measurements.hpp"
#include "db/queries.hpp"
#include "db/tests/history_support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;
using test::record_version;

class Merging : public test::DatabaseTest {
 protected:
  Merging() : first(folder / "first.db"), second(folder / "second.db") {}

  MergeReport merge(const std::filesystem::path& source) {
    auto database = must(Database::open(file));
    return must(merge_into(database, source));
  }
  /// Everything that views show, without what holds within one file only.
  std::string contents(const std::filesystem::path& path) {
    const char* runs =
        "SELECT run, suite, status, started_utc, commit_hash, machine, binary_hash, excluded_reason, cases, "
        "results, solved, shard FROM v_runs ORDER BY run";
    const char* results =
        "SELECT run, instance_hash, position, repetition, robots, ssi_s, status, planning_time_ns, "
        "makespan_s, flowtime_s, plan_hash FROM v_results "
        "ORDER BY run, robots, ssi_s, instance_hash, position, repetition";
    const char* cells =
        "SELECT run, robots, ssi_s, success_rate, median_planning_time_s, median_flowtime_s "
        "FROM v_run_cells ORDER BY run, robots, ssi_s";
    const char* commits =
        "SELECT commit_hash, subject, ancestor_count, parents, runs FROM v_commits ORDER BY commit_hash";
    std::string text;
    for (const char* question : {runs, results, cells, commits})
      text += format_csv(must(run_sql(path, question)));
    return text;
  }

  std::filesystem::path first;
  std::filesystem::path second;
};

TEST_F(Merging, shards_become_one_history_that_knows_where_they_came_from) {
  record_version(first, {1, 1, 8}, 64);
  record_version(first, {2, 1, 7}, 64);
  record_version(second, {2, 1, 9}, 128);
  EXPECT_EQ(merge(first).rows_of("result"), 20);
  const MergeReport report = merge(second);
  EXPECT_EQ(report.rows_of("run"), 1);
  EXPECT_EQ(report.rows_of("commit_"), 0) << "both know the second commit";
  EXPECT_EQ(report.rows_of("instance"), 0) << "both know the instances";
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_runs"), "3");
  EXPECT_EQ(ask(file, "SELECT origin FROM v_runs WHERE solved = 9"), second.string());
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_run_cells WHERE success_rate = 0.9 AND robots = 128"), "1");
  test::expect_sound(file);
}

/// A part of a sweep of twelve plannings of two cases, by a machine of its own.
void record_part(const std::filesystem::path& part, const std::string& shard, const std::string& host,
                 const std::vector<int>& positions) {
  RunInfo info = test::sample_run();
  info.uuid = "12345678-1234-4123-8123-123456789012";
  info.shard = shard;
  info.planned = 12;
  info.machine.host = host;
  auto recorder = must(RunRecorder::begin(must(Database::open(part, Journal::kRollback)), info));
  for (const int robots : {64, 128}) {
    for (const int position : positions) {
      ResultRow row = test::sample_result(position);
      row.position = position;
      row.progress = {{0, 1, 9, 9, 1, 1}};
      if (host == "slow") row.progress.push_back({1, 2, 8, 8, 1, 1});
      recorder.add(test::sample_case(robots), test::sample_instance(position), row);
    }
  }
  must(recorder.commit());
  must(recorder.finish(RunStatus::kFinished));
}

TEST_F(Merging, parts_of_a_sweep_become_one_run) {
  const char* state =
      "SELECT (SELECT group_concat(status || '|' || shard || '|' || results || '|' || missing || '|' || "
      "machines) FROM "
      "v_sweeps) || ' ' || (SELECT group_concat(results || '/' || solved) FROM v_run_cells)";
  record_part(first, "1/2", "host", {0, 2, 3});
  record_part(second, "2/2", "slow", {1, 4, 5});
  merge(first);
  EXPECT_EQ(ask(file, state), "finished|1/2|6|6|1 3/3,3/3");
  merge(second);
  EXPECT_EQ(ask(file, state), "finished||12|0|2 6/6,6/6");
  EXPECT_EQ(ask(file, "SELECT count(DISTINCT shard) || '|' || count(*) FROM v_attempts"), "2|2");
  EXPECT_EQ(
      ask(file,
          "SELECT count(*) FROM result JOIN attempt ON attempt.id = attempt_id JOIN machine ON machine.id = "
          "machine_id WHERE host = 'slow' AND position IN (1, 4, 5)"),
      "6");
  EXPECT_EQ(ask(file, "SELECT host FROM v_runs"), "host, slow");
  EXPECT_TRUE(merge(first).added.empty());
  EXPECT_TRUE(merge(second).added.empty());
  EXPECT_EQ(ask(file, state), "finished||12|0|2 6/6,6/6");
  test::expect_sound(file);
  EXPECT_TRUE(examine(*std::make_unique<Database>(must(Database::open(file))), {}).sound());
}

TEST_F(Merging, a_sweep_of_which_a_part_is_missing_is_not_finished) {
  const std::filesystem::path third = folder / "third.db";
  record_part(first, "1/3", "host", {0, 1});
  record_part(second, "2/3", "host", {2, 3});
  record_part(third, "3/3", "host", {4, 5});
  merge(first);
  merge(third);
  EXPECT_EQ(ask(file, "SELECT status || missing || machines FROM v_sweeps"), "aborted41");
  merge(second);
  EXPECT_EQ(ask(file, "SELECT status || missing || machines FROM v_sweeps"), "finished01");
}

TEST_F(Merging, a_planning_that_two_parts_hold_counts_once) {
  record_part(first, "1/2", "host", {0, 1, 2, 3});
  record_part(second, "1/2", "slow", {2, 3, 4, 5});
  merge(first);
  EXPECT_EQ(merge(second).rows_of("result"), 4);
  EXPECT_EQ(ask(file, "SELECT sum(results) || '|' || (SELECT count(*) FROM result) FROM v_run_cells"),
            "12|12");
  // The curve of a planning is that of the attempt which the result is from.
  EXPECT_EQ(ask(file, "SELECT group_concat(n) FROM (SELECT count(*) AS n FROM progress GROUP BY position)"),
            "2,2,2,2,4,4");
  test::expect_sound(file);
  EXPECT_TRUE(examine(*std::make_unique<Database>(must(Database::open(file))), {}).sound());
}

TEST_F(Merging, twice_is_once) {
  record_version(first, {1, 1, 8});
  record_version(second, {2, 1, 7});
  merge(first);
  merge(second);
  const std::string once = contents(file);
  EXPECT_TRUE(merge(first).added.empty());
  EXPECT_TRUE(merge(second).added.empty());
  EXPECT_EQ(contents(file), once);
}

TEST_F(Merging, the_order_does_not_matter) {
  record_version(first, {1, 1, 8}, 64);
  record_version(second, {2, 1, 7}, 128);
  merge(first);
  merge(second);
  const std::filesystem::path other = folder / "other.db";
  {
    auto database = must(Database::open(other));
    must(merge_into(database, second));
    must(merge_into(database, first));
  }
  EXPECT_EQ(contents(other), contents(file));
}

TEST_F(Merging, a_run_that_went_on_is_brought_up_to_date) {
  auto recorder = must(RunRecorder::begin(must(Database::open(first)), test::sample_run()));
  test::record_case(recorder, test::sample_case(64), 5);
  merge(first);
  EXPECT_EQ(ask(file, "SELECT status || cases FROM v_runs"), "running1");
  test::record_case(recorder, test::sample_case(128), 5);
  must(recorder.finish(RunStatus::kFinished));
  EXPECT_EQ(merge(first).rows_of("result"), 5);
  EXPECT_EQ(ask(file, "SELECT status || cases FROM v_runs"), "finished2");
  test::expect_sound(file);
}

TEST_F(Merging, the_later_word_about_an_exclusion_stands) {
  const std::string uuid = record_version(first, {1, 1, 8});
  merge(first);
  {
    auto database = must(Database::open(first));
    must(exclude_run(database, uuid, "swapping"));
  }
  merge(first);
  EXPECT_EQ(ask(file, "SELECT excluded_reason FROM run"), "swapping");
  {
    auto database = must(Database::open(file));
    must(include_run(database, uuid));
  }
  merge(first);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM run WHERE excluded_reason IS NULL"), "1")
      << "it was included here after it was excluded there";
}

TEST_F(Merging, counts_that_a_shallow_clone_did_not_know_are_filled_in) {
  record_version(first, {7, 1, 8});
  record_version(second, {7, 1, 8});
  ask(first, "UPDATE commit_ SET ancestor_count = 0 RETURNING 1");
  merge(first);
  merge(second);
  EXPECT_EQ(ask(file, "SELECT ancestor_count FROM commit_"), "7");
}

TEST_F(Merging, every_table_of_the_schema_is_merged) {
  record_version(first, {1, 1, 8});
  MeasurementRun imported;
  imported.uuid = "00000000-0000-8000-8000-000000000001";
  imported.started_utc = "2026-01-31T12:00:00.000Z";
  imported.info.suite = "other";
  imported.measurements.push_back({"sort/1024", 0, 100, 12.5, 12.0, "", {{"items_per_second", 8e7}}});
  {
    auto database = must(Database::open(first));
    must(record_measurements(database, imported));
  }
  merge(first);
  EXPECT_EQ(ask(file, "SELECT benchmark || json_extract(counters, '$.items_per_second') FROM v_measurements"),
            "sort/102480000000.0");
  for (const std::string table : {"commit_parent", "cell_summary", "measurement_counter", "result"}) {
    EXPECT_EQ(ask(file, "SELECT count(*) FROM " + table), ask(first, "SELECT count(*) FROM " + table))
        << table;
  }
}

TEST_F(Merging, a_full_disk_leaves_the_history_as_it_was) {
  record_version(file, {1, 1, 8}, 32);
  for (int number = 2; number <= 40; ++number) record_version(first, {number, 1, 8}, 64 + number);
  const std::string before = contents(file);
  auto database = must(Database::open(file));
  const auto pages = must(database.connection().query_int("PRAGMA page_count", "asking"));
  must(database.connection().execute("PRAGMA max_page_count = " + std::to_string(pages + 2), "filling up"));
  const auto full = merge_into(database, first);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().kind, ErrorKind::kFull) << full.error().message;
  EXPECT_EQ(contents(file), before);
  must(database.connection().execute("PRAGMA max_page_count = 1000000", "making room"));
  EXPECT_EQ(must(merge_into(database, first)).rows_of("run"), 39);
  test::expect_sound(file);
}

/// Of a file that is too large to be gathered, or of which a few fill what is gathered.
void pad(const std::filesystem::path& path, int megabytes) {
  ask(path,
      "UPDATE run SET command_line = hex(zeroblob(" + std::to_string(megabytes) + " << 19)) RETURNING 1");
}

TEST_F(Merging, many_files_are_what_one_after_the_other_is) {
  std::vector<std::filesystem::path> parts;
  for (int part = 0; part < 12; ++part) {
    parts.push_back(folder / ("part" + std::to_string(part) + ".db"));
    // Each planning is in two parts, and the first one stays.
    record_part(parts.back(), std::to_string(part + 1) + "/12", part % 3 == 0 ? "slow" : "host",
                {part % 6, (part + 5) % 6});
    if (part == 7) pad(parts.back(), 9);
  }
  // More than is gathered at a time.
  for (int number = 1; number <= 10; ++number) {
    parts.push_back(folder / ("version" + std::to_string(number) + ".db"));
    record_version(parts.back(), {number, 1, 8});
    pad(parts.back(), 7);
  }
  for (const auto& part : parts) merge(part);
  const std::filesystem::path other = folder / "other.db";
  {
    auto database = must(Database::open(other));
    const MergeReport report = must(merge_into(database, parts));
    EXPECT_TRUE(report.refused.empty());
    EXPECT_EQ(report.rows_of("run"), 11);
    EXPECT_EQ(report.rows_of("result"), 12 + 100);
    EXPECT_TRUE(must(merge_into(database, parts)).added.empty());
  }
  EXPECT_EQ(contents(other), contents(file));
  const char* attempts =
      "SELECT group_concat(shard || ' ' || host || ' ' || position) FROM (SELECT attempt.shard, host, "
      "position "
      "FROM result JOIN attempt ON attempt.id = attempt_id JOIN machine ON machine.id = attempt.machine_id "
      "ORDER BY 1, 2, 3)";
  EXPECT_EQ(ask(other, attempts), ask(file, attempts));
  EXPECT_EQ(ask(other, "SELECT group_concat(origin) FROM (SELECT origin FROM run ORDER BY uuid)"),
            ask(file, "SELECT group_concat(origin) FROM (SELECT origin FROM run ORDER BY uuid)"));
  test::expect_sound(other);
  EXPECT_TRUE(examine(*std::make_unique<Database>(must(Database::open(other))), {}).sound());
}

TEST_F(Merging, a_file_that_cannot_be_merged_is_named_and_the_others_are) {
  const auto named = [this](const char* name) { return folder / name; };
  record_part(first, "1/2", "host", {0, 1, 2});
  record_part(second, "2/2", "host", {3, 4, 5});
  std::ofstream(named("text.db")) << "a letter";
  for (const char* name : {"cut.db", "orphan.db", "orphan-large.db"}) {
    record_version(named(name), {1, 1, 8});
  }
  std::filesystem::resize_file(named("cut.db"), std::filesystem::file_size(named("cut.db")) / 2);
  pad(named("orphan-large.db"), 9);
  for (const char* name : {"orphan.db", "orphan-large.db"}) {
    auto connection = must(sqlite::Connection::open(named(name), sqlite::OpenMode::kReadWrite));
    must(connection.execute("PRAGMA foreign_keys = OFF", "damaging"));
    must(connection.execute("DELETE FROM instance WHERE id = 3", "damaging"));
  }
  const std::vector<std::filesystem::path> sources{first,
                                                   named("text.db"),
                                                   named("cut.db"),
                                                   named("none.db"),
                                                   named("orphan.db"),
                                                   named("orphan-large.db"),
                                                   file,
                                                   second};
  auto database = must(Database::open(file));
  const MergeReport report = must(merge_into(database, sources));
  ASSERT_EQ(report.refused.size(), 6U);
  for (std::size_t i = 0; i < report.refused.size(); ++i) {
    const std::string& line = report.refused[i].message;
    EXPECT_EQ(line.rfind(sources[i + 1].string() + ": ", 0), 0U) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(line.find("in memory"), std::string::npos) << line;
    if (sources[i + 1] != file) {
      EXPECT_EQ(line.find(file.string() + ": "), std::string::npos) << line;
    }
  }
  EXPECT_EQ(report.rows_of("run"), 1);
  EXPECT_EQ(ask(file, "SELECT status || results || missing FROM v_sweeps"), "finished120");
  test::expect_sound(file);
  EXPECT_TRUE(examine(database, {}).sound());
}

TEST_F(Merging, a_full_disk_keeps_what_was_written_before) {
  constexpr int kVersions = 12;
  std::vector<std::filesystem::path> sources;
  for (int number = 1; number <= kVersions; ++number) {
    sources.push_back(folder / ("version" + std::to_string(number) + ".db"));
    record_version(sources.back(), {number, 1, 8});
    pad(sources.back(), number < 5 ? 7 : 9);  // some gathered, then each at once
  }
  auto database = must(Database::open(file));
  const auto limit_pages = [&database](int megabytes) {
    must(database.connection().execute("PRAGMA max_page_count = " + std::to_string(megabytes * 256),
                                       "limiting"));
  };
  limit_pages(60);
  const auto full = merge_into(database, sources);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().kind, ErrorKind::kFull) << full.error().message;
  const std::string kept = ask(file, "SELECT count(*) FROM run");
  EXPECT_GT(std::stoi(kept), 0);
  EXPECT_LT(std::stoi(kept), kVersions);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM result"), kept + "0");
  test::expect_sound(file);
  limit_pages(1000);
  EXPECT_EQ(must(merge_into(database, sources)).rows_of("run"), kVersions - std::stoi(kept));
  EXPECT_TRUE(examine(database, {}).sound());
}

TEST_F(Merging, of_a_planning_that_two_files_hold_all_is_said_by_the_first) {
  record_part(first, "1/2", "host", {0, 1, 2});
  record_part(second, "2/2", "slow", {2, 3, 4});
  ask(second,
      "INSERT INTO reported SELECT cell_id, instance_id, position, repetition, 'iterations', 7 FROM result "
      "RETURNING 1");
  ask(second,
      "INSERT INTO retiming SELECT cell_id, instance_id, position, repetition, 1, 1, 0, 5.0, 9.0, 100, NULL "
      "FROM result RETURNING 1");
  merge(first);
  merge(second);
  const std::string news = ask(file, "SELECT count(*) FROM result WHERE position IN (3, 4)");
  EXPECT_NE(news, "0");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM reported"), news);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM retiming"), news);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM reported WHERE position = 2"), "0");
}

TEST_F(Merging, what_is_no_history_is_refused_and_nothing_changes) {
  record_version(file, {1, 1, 8});
  const std::string before = contents(file);
  auto database = must(Database::open(file));
  const auto itself = merge_into(database, file);
  ASSERT_FALSE(itself);
  EXPECT_NE(itself.error().message.find("merged into itself"), std::string::npos);
  EXPECT_FALSE(merge_into(database, folder / "none.db"));
  EXPECT_FALSE(std::filesystem::exists(folder / "none.db"));
  EXPECT_EQ(contents(file), before);
}

}  // namespace
}  // namespace sipplab::db
