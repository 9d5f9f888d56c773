// What users call a side of a comparison, and which results are its pairs.
#include "db/comparisons.hpp"

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::must;

constexpr const char* kOlder = "aaaa000000000000000000000000000000000000";
constexpr const char* kNewer = "aaab000000000000000000000000000000000000";

class Comparisons : public test::DatabaseTest {
 protected:
  /// A run of one case with `count` instances; returns its UUID.
  std::string record(const std::string& hash, std::int64_t ancestors, const std::string& branch,
                     std::int64_t robots, int count, bool dirty = false) {
    return record(hash, ancestors, branch, {test::sample_case(robots)}, count, dirty);
  }
  std::string record(const std::string& hash, std::int64_t ancestors, const std::string& branch,
                     const std::vector<CaseInfo>& cases, int count, bool dirty = false) {
    RunInfo info = test::sample_run();
    info.commit->hash = hash;
    info.commit->ancestor_count = ancestors;
    info.branch = branch;
    info.build.dirty = dirty;
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), info));
    for (const CaseInfo& parameters : cases) test::record_case(recorder, parameters, count);
    must(recorder.finish(RunStatus::kFinished));
    return recorder.run_uuid();
  }

  Result<ComparisonSide> side(const std::string& text) {
    auto database = must(Database::open_read_only(file));
    return resolve_side(database, text);
  }

  std::vector<PairedCell> pairs(const std::string& base, const std::string& head) {
    auto database = must(Database::open_read_only(file));
    return must(
        paired_cells(database, must(resolve_side(database, base)), must(resolve_side(database, head))));
  }
};

TEST_F(Comparisons, a_side_is_a_run_a_commit_or_a_branch) {
  const std::string first = record(kOlder, 7, "main", 64, 3);
  const std::string second = record(kNewer, 8, "main", 64, 3);
  EXPECT_EQ(must(side(first)).title, "run " + first.substr(0, 8) + " of commit aaaa0000");
  EXPECT_EQ(must(side("latest")).title, "run " + second.substr(0, 8) + " of commit aaab0000");
  EXPECT_EQ(must(side("aaaa0")).title, "commit aaaa0000 (1 run)");
  EXPECT_EQ(must(side("main")).title, "branch main at aaab0000 (1 run)");
  EXPECT_EQ(must(side("commit:aaab")).commit_hash, kNewer);
  EXPECT_EQ(side("aaa").error().kind, ErrorKind::kNotFound);  // too short for a hash, no branch
  EXPECT_EQ(side("develop").error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(side("run:main").error().kind, ErrorKind::kNotFound);
}

TEST_F(Comparisons, a_commit_is_judged_by_builds_of_just_this_commit) {
  record(kOlder, 7, "main", 64, 3);
  record(kOlder, 7, "main", 64, 5, true);
  record(kNewer, 8, "main", 64, 3, true);
  EXPECT_EQ(must(side("commit:aaaa")).title, "commit aaaa0000 (1 run) without 1 of uncommitted changes");
  EXPECT_EQ(must(side("main")).title, "branch main at aaab0000+ (uncommitted changes) (1 run)");
  const std::vector<PairedCell> cells = pairs("commit:aaaa", "main");
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(cells[0].base_only, 0U);
}

TEST_F(Comparisons, what_fits_two_things_is_refused) {
  record(kOlder, 7, "aaaa", 64, 1);
  const auto ambiguous = side("aaaa");
  ASSERT_FALSE(ambiguous);
  EXPECT_NE(ambiguous.error().message.find("branch:"), std::string::npos) << ambiguous.error().message;
  EXPECT_TRUE(side("branch:aaaa"));
  EXPECT_TRUE(side("commit:aaaa"));
}

TEST_F(Comparisons, excluded_runs_do_not_count) {
  record(kOlder, 7, "main", 64, 3);
  const std::string newer = record(kNewer, 8, "main", 64, 3);
  auto database = must(Database::open(file));
  must(exclude_run(database, newer, "busy machine"));
  EXPECT_EQ(must(side("main")).commit_hash, kOlder);
  EXPECT_NE(side(newer).error().message.find("excluded"), std::string::npos);
  EXPECT_FALSE(side("commit:aaab"));
}

TEST_F(Comparisons, of_a_commit_the_newest_result_of_each_case_counts) {
  const std::string base = record(kOlder, 7, "main", 64, 3);
  record(kNewer, 8, "work", 64, 1);
  const std::string shard = record(kNewer, 8, "work", 128, 2);
  const std::string again = record(kNewer, 8, "work", 64, 2);
  record(kOlder, 7, "main", 128, 2);
  const std::vector<PairedCell> cells = pairs("commit:aaaa", "work");
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[0].parameters.robots, 64);
  EXPECT_EQ(cells[0].base_run, base);
  EXPECT_EQ(cells[0].base_planner, "");
  EXPECT_EQ(cells[0].head_run, again);
  EXPECT_EQ(cells[0].results.size(), 2U);
  EXPECT_EQ(cells[0].base_only, 1U);
  EXPECT_EQ(cells[0].head_only, 0U);
  EXPECT_TRUE(cells[0].same_machine);
  EXPECT_EQ(cells[1].head_run, shard);
}

TEST_F(Comparisons, pairs_hold_what_was_recorded) {
  record(kOlder, 7, "main", 64, 3);
  record(kNewer, 8, "work", 64, 3);
  const std::vector<PairedCell> cells = pairs("main", "work");
  ASSERT_EQ(cells.size(), 1U);
  ASSERT_EQ(cells[0].results.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const PairedResult& pair = cells[0].results[static_cast<std::size_t>(i)];
    const ResultRow expected = test::sample_result(i);
    EXPECT_EQ(pair.instance_hash, test::sample_instance(i).content_hash);
    for (const ResultRow& row : {pair.base, pair.head}) {
      EXPECT_EQ(row.status, expected.status);
      EXPECT_EQ(row.planning_time_ns, expected.planning_time_ns);
      EXPECT_EQ(row.makespan_s, expected.makespan_s);
      EXPECT_EQ(row.flowtime_s, expected.flowtime_s);
      EXPECT_EQ(row.tries, expected.tries);
      EXPECT_EQ(row.expansions, expected.expansions);
      EXPECT_EQ(row.generations, expected.generations);
      EXPECT_EQ(row.plan_hash, expected.plan_hash);
    }
  }
}

TEST_F(Comparisons, pairs_hold_instructions_and_memory_of_either_side) {
  const auto run = [this](const std::string& hash, std::int64_t instructions, std::int64_t bytes) {
    RunInfo info = test::sample_run();
    info.commit->hash = hash;
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), info));
    for (int i = 0; i < 2; ++i) {
      ResultRow row = test::sample_result(i);
      if (i == 0) {
        row.instructions = instructions;
        row.peak_memory_bytes = bytes;
      }
      recorder.add(test::sample_case(64), test::sample_instance(i), row);
    }
    must(recorder.commit());
    must(recorder.finish(RunStatus::kFinished));
  };
  run(kOlder, 3000, 4096);
  run(kNewer, 6000, 8192);
  const std::vector<PairedCell> cells = pairs("commit:aaaa", "commit:aaab");
  ASSERT_EQ(cells.size(), 1U);
  ASSERT_EQ(cells[0].results.size(), 2U);
  const PairedResult& known = cells[0].results[0];
  EXPECT_EQ(known.base.instructions, 3000);
  EXPECT_EQ(known.head.instructions, 6000);
  EXPECT_EQ(known.base.peak_memory_bytes, 4096);
  EXPECT_EQ(known.head.peak_memory_bytes, 8192);
  const PairedResult& unknown = cells[0].results[1];
  for (const ResultRow& row : {unknown.base, unknown.head}) {
    EXPECT_FALSE(row.instructions);
    EXPECT_FALSE(row.peak_memory_bytes);
  }
}

CaseInfo planned_by(std::string planner, double ssi_s, double weight = 1) {
  CaseInfo parameters = test::sample_case(64, ssi_s);
  parameters.planner = std::move(planner);
  parameters.options["weight"] = weight;
  return parameters;
}

TEST_F(Comparisons, planners_are_paired_where_nothing_else_differs) {
  record(kOlder, 7, "main", {planned_by("sipplab", 3), planned_by("sipplab", 5)}, 3);
  record(kNewer, 8, "work", {planned_by("cmd:other", 3), planned_by("cmd:other", 5)}, 3);
  const std::vector<PairedCell> cells = pairs("main", "work");
  ASSERT_EQ(cells.size(), 2U);
  for (const PairedCell& cell : cells) {
    EXPECT_EQ(cell.base_planner, "sipplab");
    EXPECT_EQ(cell.parameters.planner, "cmd:other");
    EXPECT_EQ(cell.results.size(), 3U);
  }
  EXPECT_EQ(cells[0].parameters.real("ssi_s"), 3);
}

TEST_F(Comparisons, settings_are_paired_by_instance_and_rules_where_there_is_one_pair_alone) {
  record(kOlder, 7, "main", {planned_by("sipplab weight:1.05", 3, 1.05)}, 3);
  CaseInfo elsewhere = planned_by("cmd:other", 5);
  elsewhere.instance_set = "another folder with the same files";
  record(kNewer, 8, "work", {elsewhere}, 2);
  const std::vector<PairedCell> cells = pairs("main", "work");
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(cells[0].base_planner, "sipplab weight:1.05");
  EXPECT_EQ(cells[0].results.size(), 2U);
  EXPECT_EQ(cells[0].base_only, 1U);

  // Which of two? And a plan with turns keeps other rules.
  record("bbbb" + std::string(36, '0'), 9, "two", {planned_by("cmd:other", 5), planned_by("cmd:other", 9)},
         3);
  EXPECT_TRUE(pairs("main", "two").empty());
  CaseInfo turning = planned_by("cmd:other turns:yes", 5);
  turning.options["turns"] = std::int64_t{1};
  record("cccc" + std::string(36, '0'), 10, "turns", {turning}, 3);
  EXPECT_TRUE(pairs("main", "turns").empty());
}

TEST_F(Comparisons, sides_without_a_common_case_have_no_pairs) {
  record(kOlder, 7, "main", 64, 3);
  record(kNewer, 8, "work", 128, 3);
  EXPECT_TRUE(pairs("main", "work").empty());
}

}  // namespace
}  // namespace sipplab::db
