// Gate runs are kept whole, and give back the noise of the machine that made them.
#include "db/gate_runs.hpp"

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::must;

class GateRuns : public test::DatabaseTest {
 protected:
  static GateRun sample(bool calibration) {
    GateRun run;
    static_cast<RunOrigin&>(run) = test::sample_run();
    run.calibration = calibration;
    run.suite = "gate";
    run.method = 1;
    run.base_build = run.build;
    run.seed = 0xffff'ffff'ffff'ffff;
    run.pair_seconds = 0.6;
    run.tolerance = 0.05;
    run.started_utc = "2026-01-31T12:00:00.000Z";
    run.wall_time_ns = 5;
    run.compared = 3;
    run.differing = 1;
    run.verdict = "inconclusive";
    run.reason = "too noisy";
    for (const bool all : {false, true}) {
      GateCellRow cell;
      if (!all) cell.parameters = test::sample_case(64);
      cell.slowdown = all ? 0.01 : 0.02;
      cell.p_value = 0.5;
      cell.verdict = "equivalent";
      cell.pairs = {0.01, all ? 0.02 : 0.03};
      if (all) cell.fresh_pairs = {0.5};
      run.cells.push_back(cell);
    }
    run.differences = {{test::sample_case(64), test::sample_instance(1), "plan", "one", "another"}};
    return run;
  }

  static GateKind kind_of(const GateRun& run) {
    return {run.machine, run.suite, run.method, run.pair_seconds};
  }
};

TEST_F(GateRuns, are_kept_whole) {
  auto database = must(Database::open(file));
  const std::string uuid = must(record_gate_run(database, sample(false)));
  EXPECT_EQ(uuid.size(), 36U);
  EXPECT_EQ(test::ask(file, "SELECT verdict || reason || slowdown FROM v_gate_runs"),
            "inconclusivetoo noisy0.01");
  EXPECT_EQ(
      test::ask(file, "SELECT group_concat(pairs) FROM (SELECT pairs FROM v_gate_cells ORDER BY case_id)"),
      "3,2");
  EXPECT_EQ(test::ask(file, "SELECT what || robots || base || head FROM v_gate_differences"),
            "plan64oneanother");
  EXPECT_EQ(test::ask(file, "SELECT head_commit_hash FROM v_gate_runs"), test::sample_run().commit->hash);
  test::expect_sound(file);
}

TEST_F(GateRuns, a_run_that_breaks_a_rule_leaves_nothing) {
  auto database = must(Database::open(file));
  GateRun run = sample(false);
  run.cells.back().verdict = "perhaps";
  EXPECT_FALSE(record_gate_run(database, run));
  EXPECT_EQ(test::ask(file, "SELECT count(*) FROM gate_run"), "0");
  EXPECT_EQ(test::ask(file, "SELECT count(*) FROM gate_pair"), "0");
}

TEST_F(GateRuns, noise_is_that_of_calibrations_of_the_same_kind) {
  auto database = must(Database::open(file));
  must(record_gate_run(database, sample(false)));
  EXPECT_TRUE(must(gate_noise(database, kind_of(sample(true)))).empty());
  must(record_gate_run(database, sample(true)));
  must(record_gate_run(database, sample(true)));
  const std::vector<GateNoise> noise = must(gate_noise(database, kind_of(sample(true))));
  ASSERT_EQ(noise.size(), 2U);
  for (const GateNoise& row : noise) {
    ASSERT_EQ(row.comparisons.size(), 2U);
    // Fresh pairs were drawn because of a suspicion: they are no fair sample.
    EXPECT_EQ(row.comparisons[0], (std::vector<double>{0.01, row.parameters ? 0.03 : 0.02}));
  }
  EXPECT_EQ(noise[1].parameters, test::sample_case(64));

  GateKind other = kind_of(sample(true));
  other.pair_seconds = 0.3;
  EXPECT_TRUE(must(gate_noise(database, other)).empty());
  other = kind_of(sample(true));
  other.machine.host = "another";
  EXPECT_TRUE(must(gate_noise(database, other)).empty());
  other = kind_of(sample(true));
  other.method = 2;
  EXPECT_TRUE(must(gate_noise(database, other)).empty());
}

TEST_F(GateRuns, an_excluded_calibration_says_nothing) {
  auto database = must(Database::open(file));
  const std::string uuid = must(record_gate_run(database, sample(true)));
  must(exclude_run(database, uuid, "the machine was busy"));
  EXPECT_TRUE(must(gate_noise(database, kind_of(sample(true)))).empty());
  must(include_run(database, uuid));
  EXPECT_FALSE(must(gate_noise(database, kind_of(sample(true)))).empty());
}

}  // namespace
}  // namespace sipplab::db
