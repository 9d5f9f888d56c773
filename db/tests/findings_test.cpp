// Fuzzing in the history: runs are written whole, and a finding goes from new to reproduced,
// fixed and regressed with what is seen of it.
#include "db/findings.hpp"

#include "db/fuzz_runs.hpp"
#include "db/merge.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;

RunOrigin origin() { return test::sample_run(); }

FuzzRun run_of(const std::string& status, const std::string& hash = "0123456789abcdef") {
  static int number = 0;
  FuzzRun run;
  run.uuid = "00000000-0000-4000-8000-" + std::to_string(200000000000 + ++number);
  run.campaign = "00000000-0000-4000-8000-000000000001";
  run.target = "reads_back";
  run.mode = "for";
  run.started_utc = "2026-01-31T12:00:00.000Z";
  run.wall_time_ns = 2'000'000'000;
  run.cpu_time_ns = 1'000'000'000;
  run.status = status;
  run.seed = UINT64_MAX;
  run.target_hash = hash;
  run.executions = 5000;
  run.snapshots = {{1000, 1, 2, 3, 4, 5}, {5000, 6, 7, 8, 9, 10}};
  run.counts = {{"event", "inputs", 5000}, {"event", "two robots", 4500}, {"claim", "plan is valid", 3000}};
  return run;
}

Finding broken(const std::string& minimal = "..\nrobot 0 0 to 1 0\n") {
  Finding finding;
  finding.target = "reads_back";
  finding.kind = "claim";
  finding.claim = "reads back equal";
  finding.message = "broken claim: reads back equal: no";
  finding.input = std::string("raw\0bytes\xff", 10);
  finding.minimal = minimal;
  finding.robots = 1;
  finding.cells = 2;
  return finding;
}

class Findings : public test::DatabaseTest {
 protected:
  Database database = must(Database::open(file));

  StoredFinding seen(const Finding& finding) {
    return must(record_finding(database, origin(), finding, std::nullopt, now()));
  }
  StoredFinding replayed(std::int64_t id, bool breaks) {
    return must(record_replay(database, origin(), id, breaks, now()));
  }
  std::string events() {
    return ask(
        file, "SELECT group_concat(event, ' ') FROM (SELECT event FROM finding_event ORDER BY happened_utc)");
  }

 private:
  /// A second later each time.
  std::string now() { return "2026-01-31T12:00:" + std::to_string(++seconds_) + ".000Z"; }
  int seconds_ = 10;
};

TEST_F(Findings, a_run_is_written_with_snapshots_and_counts) {
  const std::int64_t id = must(record_fuzz_run(database, origin(), run_of("clean")));
  EXPECT_EQ(ask(file, "SELECT executions_per_s FROM v_fuzz_runs"), "2500.0");
  EXPECT_EQ(ask(file, "SELECT executions_per_cpu_s FROM v_fuzz_runs"), "5000.0");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM fuzz_snapshot"), "2");
  EXPECT_EQ(ask(file, "SELECT per_input FROM v_fuzz_counts WHERE name = 'two robots'"), "0.9");
  const Table table = must(list_fuzz_runs(database, {}));
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], Value{id});
  test::expect_sound(file);
}

TEST_F(Findings, a_program_is_known_once_it_ran_clean_for_a_time) {
  must(record_fuzz_run(database, origin(), run_of("findings", "another program")));
  EXPECT_FALSE(must(is_fuzzed_clean(database, "reads_back", "0123456789abcdef")));
  FuzzRun smoke = run_of("clean");
  smoke.mode = "smoke";
  must(record_fuzz_run(database, origin(), smoke));
  EXPECT_FALSE(must(is_fuzzed_clean(database, "reads_back", "0123456789abcdef")));
  must(record_fuzz_run(database, origin(), run_of("clean")));
  EXPECT_TRUE(must(is_fuzzed_clean(database, "reads_back", "0123456789abcdef")));
  EXPECT_FALSE(must(is_fuzzed_clean(database, "reads_back", "fedcba9876543210")));
  must(record_fuzz_run(database, origin(), run_of("findings")));
  EXPECT_FALSE(must(is_fuzzed_clean(database, "reads_back", "0123456789abcdef")));
}

TEST_F(Findings, what_is_written_is_what_is_read) {
  const StoredFinding stored = seen(broken());
  EXPECT_EQ(stored.state, "new");
  EXPECT_EQ(stored.times_found, 1);
  EXPECT_EQ(stored.finding.input, broken().input);
  EXPECT_EQ(stored.finding.minimal, broken().minimal);
  EXPECT_EQ(stored.finding.signature(), "claim | reads back equal | ");
  EXPECT_EQ(stored.first_commit, test::sample_run().commit->hash);
  EXPECT_EQ(stored.finding.robots, 1);
  test::expect_sound(file);
}

TEST_F(Findings, the_same_signature_is_the_same_finding_and_its_smaller_input_stays) {
  seen(broken("a longer input"));
  const StoredFinding again = seen(broken("short"));
  EXPECT_EQ(again.id, 1);
  EXPECT_EQ(again.state, "reproduced");
  EXPECT_EQ(again.times_found, 2);
  EXPECT_EQ(again.finding.minimal, "short");
  EXPECT_EQ(again.first_utc, "2026-01-31T12:00:11.000Z");
  EXPECT_EQ(again.last_utc, "2026-01-31T12:00:12.000Z");
  EXPECT_EQ(seen(broken("longer again")).finding.minimal, "short");
  Finding other = broken();
  other.target = "another_target";
  EXPECT_EQ(seen(other).state, "new");
}

TEST_F(Findings, a_finding_is_fixed_when_it_holds_and_regressed_when_it_breaks_again) {
  const std::int64_t id = seen(broken()).id;
  EXPECT_EQ(replayed(id, true).state, "reproduced");
  const StoredFinding fixed = replayed(id, false);
  EXPECT_EQ(fixed.state, "fixed");
  EXPECT_EQ(fixed.fixed_commit, test::sample_run().commit->hash);
  EXPECT_TRUE(must(list_findings(database, true)).empty());
  EXPECT_EQ(must(list_findings(database, false)).size(), 1U);
  EXPECT_EQ(replayed(id, false).state, "fixed");
  const StoredFinding regressed = seen(broken());
  EXPECT_EQ(regressed.state, "regressed");
  EXPECT_FALSE(regressed.fixed_commit);
  EXPECT_EQ(replayed(id, true).state, "regressed");
  EXPECT_EQ(events(), "found reproduced fixed regressed");
  test::expect_sound(file);
}

TEST_F(Findings, lives_in_two_files_merge_into_one) {
  const std::filesystem::path shard = folder / "shard.db";
  auto other = must(Database::open(shard));
  const auto at = [](int month) { return "2026-0" + std::to_string(month) + "-01T00:00:00.000Z"; };
  const auto see = [&at](Database& where, const char* minimal, int month) {
    return must(record_finding(where, origin(), broken(minimal), std::nullopt, at(month))).id;
  };
  const auto replay = [&at](Database& where, std::int64_t id, bool breaks, int month) {
    must(record_replay(where, origin(), id, breaks, at(month)));
  };
  const auto merged = [&] {
    must(merge_into(database, shard));
    must(merge_into(database, shard));  // the second time changes nothing
    const StoredFinding finding = must(find_finding(database, 1));
    return finding.state + (finding.fixed_commit ? " by a commit" : "");
  };
  see(database, "a longer input", 1);
  see(other, "short", 2);
  see(other, "short", 3);
  EXPECT_EQ(merged(), "reproduced");
  EXPECT_EQ(must(find_finding(database, 1)).finding.minimal, "short");
  EXPECT_EQ(must(find_finding(database, 1)).times_found, 2);
  EXPECT_EQ(must(find_finding(database, 1)).last_utc, at(3));

  replay(other, 1, false, 5);
  EXPECT_EQ(merged(), "fixed by a commit") << "it was last seen to break before";
  replay(database, 1, true, 6);
  EXPECT_EQ(merged(), "regressed");
  replay(database, 1, false, 8);
  replay(other, 1, true, 7);
  EXPECT_EQ(merged(), "fixed by a commit") << "what the other file saw was earlier";
  test::expect_sound(file);
}

TEST_F(Findings, one_that_is_not_there_is_an_error) {
  const auto missing = find_finding(database, 7);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no finding 7"), std::string::npos);
}

TEST_F(Findings, coverage_is_summed_up_by_room) {
  must(record_fuzz_run(database, origin(), run_of("clean")));
  const std::string campaign = must(latest_fuzz_campaign(database));
  must(record_fuzz_coverage(
      database, campaign,
      {{"planner/io/text.cpp", 80, 60}, {"planner/io/svg.cpp", 20, 20}, {"planner/grid/cell.hpp", 10, 5}}));
  EXPECT_EQ(ask(file, "SELECT share FROM v_fuzz_coverage WHERE room = 'planner/io'"), "0.8");
  const Table table = must(list_fuzz_coverage(database, campaign));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0],
            (std::vector<Value>{std::string("planner"), std::int64_t{110}, std::int64_t{85}, 0.7727}));
}

}  // namespace
}  // namespace sipplab::db
