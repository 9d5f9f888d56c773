// Judgements: changes of behaviour, metrics and their verdicts.
#include "bench/judge/judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/judge/report.hpp"
#include "bench/tests/judgement_support.hpp"

namespace sipplab::bench {
namespace {

TEST(Change, NamesTheGravestKind) {
  const db::ResultRow base = solved(1, 10);
  EXPECT_FALSE(change(base, base));
  EXPECT_EQ(change(base, failed())->kind, ChangeKind::kStatus);
  EXPECT_EQ(change(base, solved(2, 10))->kind, ChangeKind::kPlan);
  db::ResultRow head = base;
  head.generations = 21;
  EXPECT_EQ(change(base, head)->kind, ChangeKind::kWork);
  head.status = db::ResultStatus::kInvalid;
  head.message = "robots 1 and 2 overlap";
  EXPECT_EQ(change(base, head)->kind, ChangeKind::kValidity);
  EXPECT_EQ(change(base, head)->head, "robots 1 and 2 overlap");
}

TEST(Change, AClockThatStruckExcusesWork) {
  db::ResultRow base = failed();
  base.status = db::ResultStatus::kLimit;
  base.limit = "time";
  db::ResultRow head = base;
  head.expansions = 99;
  EXPECT_FALSE(change(base, head));
  head.limit = base.limit = "restarts";
  EXPECT_TRUE(change(base, head));
}

TEST(Judgement, EqualSidesAreTheSame) {
  const std::vector<db::PairedCell> cells = {equal_cell(8)};
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kSame);
  EXPECT_EQ(result.all.compared, 8U);
  EXPECT_DOUBLE_EQ(row(result, kSweepTime).effect, 0);
  EXPECT_EQ(row(result, kSweepTime).pairs.size(), 8U);
}

TEST(Judgement, AnotherPlanIsAChange) {
  std::vector<db::PairedCell> cells = {equal_cell(8)};
  cells[0].results[3].head.plan_hash = 99;
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kChanged);
  EXPECT_EQ(result.all.reason, "1 of 8 plannings changed; flowtime +0.0 %");
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].result, 3U);
  JudgeOptions expected;
  expected.expects_changes = true;
  EXPECT_EQ(judgement_of(cells, expected).all.verdict, Verdict::kChanged);
  EXPECT_EQ(judgement_of(cells, expected).all.reason.find("1 of 8 plannings changed, as expected"), 0U);
}

TEST(Judgement, OtherWorkForTheSamePlansIsNoOtherPlan) {
  std::vector<db::PairedCell> cells = {equal_cell(8)};
  cells[0].results[3].base.generations = 1000;
  cells[0].results[3].head.generations = 1001;
  const Judgement small = judgement_of(cells);
  EXPECT_EQ(small.all.differing, 1U);
  EXPECT_EQ(small.all.other_plans, 0U);
  EXPECT_EQ(small.all.verdict, Verdict::kEquivalent);
  EXPECT_EQ(small.all.reason, "plans unchanged, other work in 1 of 8; generations +0.0 %");
  cells[0].results[3].head.generations = 1100;
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kChanged);
  EXPECT_EQ(
      result.all.reason,
      "plans unchanged, other work in 1 of 8; generations +1.2 % (95 %: -1.6 to +4.1); flowtime +0.0 %");
}

/// 900 plannings of 100 instances; of the first `instances` the head expands `factor` times as many nodes.
std::vector<db::PairedCell> with_more_work(std::size_t instances, double factor) {
  std::vector<db::PairedCell> cells = {equal_cell(900)};
  for (std::size_t i = 0; i < 900; ++i) {
    db::PairedResult& result = cells[0].results[i];
    result.instance_hash = "hash " + std::to_string(i % 100);
    result.base.expansions = result.head.expansions = 100'000;
    if (i % 100 < instances) result.head.expansions = static_cast<std::uint64_t>(100'000 * factor);
  }
  return cells;
}

TEST(Judgement, MoreExpansionsForTheSamePlansAreNotTheSame) {
  // Eight instances of a hundred differ: chance gives that once in 128 times, and seven metrics are tested.
  const Judgement doubtful = judgement_of(with_more_work(8, 1.85));
  EXPECT_EQ(row(doubtful, kExpansions, std::nullopt).verdict, Verdict::kInconclusive);
  EXPECT_EQ(doubtful.all.verdict, Verdict::kInconclusive);
  EXPECT_EQ(
      doubtful.all.reason.find("expansions +5.0 % (95 %: +1.6 to +8.6), which may be chance (sees from "), 0U)
      << doubtful.all.reason;
  EXPECT_NE(doubtful.all.reason.find("; plans unchanged, other work in 72 of 900"), std::string::npos);
  // The effect is below the floor, and its interval reaches beyond.
  EXPECT_EQ(judgement_of(with_more_work(8, 1.05)).all.verdict, Verdict::kInconclusive);
  const Judgement certain = judgement_of(with_more_work(100, 1.05));
  EXPECT_EQ(certain.all.verdict, Verdict::kRegressed);
  EXPECT_EQ(certain.all.reason.find("expansions +5.0 % (95 %: +5.0 to +5.0)"), 0U) << certain.all.reason;
  const Judgement small = judgement_of(with_more_work(100, 1.003));
  EXPECT_EQ(small.all.verdict, Verdict::kEquivalent);
  EXPECT_EQ(small.all.reason,
            "plans unchanged, other work in 900 of 900; expansions +0.3 % (95 %: +0.3 to +0.3)");
  // Fewer, and not for certain.
  EXPECT_EQ(judgement_of(with_more_work(8, 0.5)).all.verdict, Verdict::kChanged);
}

TEST(Judgement, OtherPlansScatterExpansionsWithoutDoubt) {
  std::vector<db::PairedCell> cells = with_more_work(8, 1.85);
  for (std::size_t i = 0; i < 8; ++i) cells[0].results[i].head.plan_hash = 5000 + i;
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(row(result, kExpansions, std::nullopt).verdict, Verdict::kChanged);
  EXPECT_EQ(result.all.verdict, Verdict::kChanged);
}

TEST(Judgement, OneLostMayBeChanceAndManyAreNot) {
  std::vector<db::PairedCell> cells = {equal_cell(40)};
  cells[0].results[0].head = failed();
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kInconclusive);
  // Seven metrics over all cells: 12 lost give 7 * 2 / 2^12 = 0.0034, 10 lost 0.014.
  for (std::size_t i = 0; i < 10; ++i) cells[0].results[i].head = failed();
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kRegressed) << "a cell has three metrics alone";
  cells.assign(40, equal_cell(1));
  for (std::size_t i = 0; i < 40; ++i) cells[i].results[0].instance_hash = "hash " + std::to_string(i);
  for (std::size_t i = 0; i < 10; ++i) cells[i].results[0].head = failed();
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kInconclusive);
  for (std::size_t i = 10; i < 12; ++i) cells[i].results[0].head = failed();
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kRegressed);
  EXPECT_DOUBLE_EQ(row(result, kSuccess, std::nullopt).adjusted_p, 7 * 2.0 / 4096);
  EXPECT_EQ(result.all.reason.find("success -30.0 points (95 %: -44.8 to -15.2): 12 of 40 plannings lost, 0 "
                                   "gained, p = 0.0034"),
            0U)
      << result.all.reason;
}

/// 900 plannings of 100 instances, as suite density has; the head loses the first of some instances.
std::vector<db::PairedCell> with_lost(std::size_t plannings, std::size_t instances, std::size_t lost) {
  std::vector<db::PairedCell> cells = {equal_cell(plannings)};
  for (std::size_t i = 0; i < plannings; ++i) {
    cells[0].results[i].instance_hash = "hash " + std::to_string(i % instances);
    if (i < lost) cells[0].results[i].head = failed();
  }
  return cells;
}

TEST(Judgement, ALossThatIsSmallerThanWhatMattersIsNoAlarm) {
  const Judgement small = judgement_of(with_lost(900, 100, 3));
  EXPECT_EQ(row(small, kSuccess, std::nullopt).verdict, Verdict::kEquivalent);
  EXPECT_EQ(small.all.verdict, Verdict::kChanged);
  EXPECT_EQ(
      small.all.reason,
      "3 of 900 plannings changed; success -0.3 points (95 %: -0.7 to +0.0): 3 of 900 plannings lost, 0 "
      "gained, p = 1, too small to matter; flowtime +0.0 %");
  // As few as suite smoke has: the interval reaches far, and what was measured is small.
  const Judgement few = judgement_of(with_lost(144, 15, 1));
  EXPECT_EQ(row(few, kSuccess, std::nullopt).verdict, Verdict::kChanged);
  EXPECT_NE(few.all.reason.find(", within chance (sees from 34.2 points on)"), std::string::npos)
      << few.all.reason;
  // Who expects other plans has not said that fewer are found.
  JudgeOptions expected;
  expected.expects_changes = true;
  const Judgement doubted = judgement_of(with_lost(144, 15, 1), expected);
  EXPECT_EQ(doubted.all.verdict, Verdict::kInconclusive);
  EXPECT_EQ(
      doubted.all.reason.find("success -0.7 points (95 %: -2.2 to +0.8): 1 of 144 plannings lost, 0 gained, "
                              "p = 1, which may be chance (sees from 34.2 points on)"),
      0U)
      << doubted.all.reason;
  EXPECT_EQ(judgement_of(with_lost(900, 100, 3), expected).all.verdict, Verdict::kChanged);
  JudgeOptions strict;
  strict.floors[db::MetricKind::kSuccess] = 0;
  EXPECT_EQ(judgement_of(with_lost(900, 100, 3), strict).all.verdict, Verdict::kInconclusive);
}

TEST(Judgement, ALossThatMayMatterIsInconclusive) {
  const Judgement chance = judgement_of(with_lost(144, 15, 2));
  EXPECT_EQ(chance.all.verdict, Verdict::kInconclusive);
  EXPECT_NE(chance.all.reason.find(", which may be chance (sees from "), std::string::npos)
      << chance.all.reason;
  // Less than a point, but more than chance alone gives: it may be more than a point.
  const Judgement leaning = judgement_of(with_lost(900, 100, 7));
  EXPECT_EQ(leaning.all.verdict, Verdict::kInconclusive);
  EXPECT_LT(row(leaning, kSuccess, std::nullopt).effect, 0.01);
  // Certain, and of a size that is not known well enough.
  const Judgement certain = judgement_of(with_lost(1600, 400, 14));
  EXPECT_EQ(certain.all.verdict, Verdict::kInconclusive);
  EXPECT_LE(row(certain, kSuccess, std::nullopt).adjusted_p, kRecordedLevel);
  EXPECT_NE(certain.all.reason.find(", which may be too small to matter (sees from "), std::string::npos)
      << certain.all.reason;
}

TEST(Judgement, RepetitionsAndEqualFilesAreOneObservation) {
  // Eight instances, ten plannings each; the head never solves the first.
  std::vector<db::PairedCell> cells = {equal_cell(80)};
  for (std::size_t i = 0; i < 80; ++i) {
    cells[0].results[i].instance_hash = "hash " + std::to_string(i % 8);
    if (i % 8 == 0) cells[0].results[i].head = failed();
  }
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kInconclusive) << result.all.reason;
  EXPECT_EQ(result.cells[0].instances, 8U);
  EXPECT_EQ(row(result, kSuccess).worse(), 1U);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].plannings, 10U);
  EXPECT_DOUBLE_EQ(row(result, kSuccess, std::nullopt).adjusted_p, 1);
  EXPECT_EQ(result.cells[0].head_solved, 70U);
  const std::string text = report_text({result, "sipplab compare", "run 1", "run 2"});
  EXPECT_NE(text.find("8 (80)"), std::string::npos) << text;
}

TEST(Judgement, AnInstanceLostInManyCellsIsOneLost) {
  std::vector<db::PairedCell> cells(7, equal_cell(6));
  for (db::PairedCell& cell : cells) cell.results[2].head = failed();
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(row(result, kSuccess, std::nullopt).worse(), 1U);
  EXPECT_EQ(result.all.verdict, Verdict::kInconclusive) << result.all.reason;
}

TEST(Judgement, ManyLossesOfFewInstancesSayWhyTheyMayBeChance) {
  std::vector<db::PairedCell> cells = with_lost(900, 100, 0);
  for (std::size_t i = 0; i < 900; ++i) {
    if (i % 100 < 4) cells[0].results[i].head = failed();
  }
  Judgement result = measured(cells);
  Difference time{.metric = &kProcessTime, .cell = 0, .pairs = std::vector<double>(14, 0.01)};
  time.verdict = Verdict::kInconclusive;
  result.differences.push_back(time);
  judge(result, {});
  EXPECT_EQ(result.all.verdict, Verdict::kInconclusive);
  EXPECT_LT(row(result, kSuccess, std::nullopt).detectable, row(result, kSuccess, std::nullopt).effect);
  EXPECT_EQ(result.all.reason.find("success -4.0 points (95 %: "), 0U) << result.all.reason;
  EXPECT_NE(
      result.all.reason.find("which may be chance: in 4 instances alone (spread over all, it sees from "),
      std::string::npos)
      << result.all.reason;
  EXPECT_GT(result.all.reason.find("too noisy now to tell"), result.all.reason.find("may be chance"));
  EXPECT_NE(result.all.reason.find("too noisy now to tell"), std::string::npos);
}

TEST(Judgement, ADoubtfulTimeSaysWhetherItIsLikely) {
  for (const double at_least : {-0.01, 0.02}) {
    Judgement judgement = measured({equal_cell(8)});
    Difference time{.metric = &kProcessTime, .cell = 0, .pairs = std::vector<double>(14, 0.06)};
    time.effect = 0.06;
    time.at_least = at_least;
    time.at_most = 0.1;
    time.verdict = Verdict::kInconclusive;
    judgement.differences.push_back(time);
    judge(judgement, {});
    EXPECT_EQ(judgement.all.verdict, Verdict::kInconclusive);
    const std::string doubt =
        at_least > 0 ? "likely but not certain: measure again" : "too noisy now to tell";
    EXPECT_NE(judgement.all.reason.find(", " + doubt), std::string::npos) << judgement.all.reason;
  }
}

TEST(Judgement, AnInstanceSolvedMoreOftenByTheHeadIsGained) {
  std::vector<db::PairedCell> cells = {equal_cell(6)};
  for (db::PairedResult& result : cells[0].results) result.instance_hash = "one";
  cells[0].results[1].base = cells[0].results[2].base = failed();
  cells[0].results[4].head = failed();
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(row(result, kSuccess).worse(), 0U);
  EXPECT_EQ(row(result, kSuccess).better(), 1U);
}

TEST(Judgement, FourInstancesPlannedOftenAreFourFlowtimes) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (std::size_t i = 0; i < 20; ++i) {
    db::PairedResult& result = cells[0].results[i];
    result.instance_hash = "hash " + std::to_string(i % 4);
    result.head.flowtime_s = *result.base.flowtime_s * 1.2;
  }
  const Judgement result = judgement_of(cells);
  EXPECT_NEAR(row(result, kFlowtime).effect, std::log(1.2), 1e-9);
  EXPECT_DOUBLE_EQ(row(result, kFlowtime).p_value, 0.125);  // 2 / 2^4, the least that four can give
  EXPECT_NE(result.all.verdict, Verdict::kRegressed) << result.all.reason;
}

TEST(Judgement, AnInvalidPlanIsARegressionAlone) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  cells[0].results[4].head.status = db::ResultStatus::kInvalid;
  JudgeOptions expected;
  expected.expects_changes = true;
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kRegressed);
  EXPECT_EQ(judgement_of(cells, expected).all.verdict, Verdict::kRegressed);
  std::swap(cells[0].results[4].base, cells[0].results[4].head);  // the head repairs it
  EXPECT_EQ(judgement_of(cells, expected).all.verdict, Verdict::kChanged);
}

TEST(Judgement, WhatNoCellCanTellAllCellsTogetherDo) {
  // Three instances a cell, as in suite smoke: no p value of a cell is below 0.25.
  const Judgement result = judgement_of(slower_arrivals(16, 3, 1.143));
  EXPECT_EQ(result.all.verdict, Verdict::kRegressed);
  EXPECT_EQ(result.all.reason, "flowtime +14.3 % (95 %: +14.3 to +14.3); 48 of 48 plannings changed");
  EXPECT_EQ(result.cells[0].verdict, Verdict::kChanged);
}

TEST(Judgement, EffectsBelowTheirFloorAreEquivalent) {
  EXPECT_EQ(judgement_of(slower_arrivals(1, 40, 1.005)).all.verdict, Verdict::kRegressed);
  const Judgement small = judgement_of(slower_arrivals(1, 40, 1.001));
  EXPECT_EQ(row(small, kFlowtime, std::nullopt).verdict, Verdict::kEquivalent);
  EXPECT_EQ(small.all.verdict, Verdict::kChanged);
  JudgeOptions tolerant;
  tolerant.floors[db::MetricKind::kQuality] = 0.01;
  EXPECT_EQ(judgement_of(slower_arrivals(1, 40, 1.005), tolerant).all.verdict, Verdict::kChanged);
}

TEST(Judgement, BetterIsAVerdictToo) {
  std::vector<db::PairedCell> cells = slower_arrivals(2, 20, 1);
  for (db::PairedCell& cell : cells) {
    for (db::PairedResult& result : cell.results) {
      result.head.plan_hash = result.base.plan_hash;
      result.head.expansions = 5;
    }
  }
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kImproved);
  EXPECT_EQ(result.all.reason.find(
                "expansions -50.0 % (95 %: -50.0 to -50.0), most of all -50.0 % in warehouse, 64 robots "
                "(2 of 2 cells are like that)"),
            0U)
      << result.all.reason;
}

TEST(Judgement, MoreWorkForTheSamePlansIsARegression) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (db::PairedResult& result : cells[0].results) {
    result.base.generations = 1000;
    result.head.generations = 1010;
  }
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kRegressed);
  EXPECT_EQ(result.all.reason.find("generations +1.0 % (95 %: +1.0 to +1.0); plans unchanged"), 0U)
      << result.all.reason;
}

TEST(Judgement, WorkThatTheClockCutShortIsNotCompared) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (db::PairedResult& result : cells[0].results) {
    result.base.instructions = 1000;
    result.head.instructions = 2000;
    result.head.expansions = 20;
  }
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kRegressed);
  for (db::PairedResult& result : cells[0].results) result.head.limit = "time";
  const Judgement judgement = judgement_of(cells);
  EXPECT_EQ(judgement.all.verdict, Verdict::kSame) << judgement.all.reason;
  EXPECT_TRUE(row(judgement, kInstructions, std::nullopt).pairs.empty());
  EXPECT_TRUE(row(judgement, kExpansions, std::nullopt).pairs.empty());
  EXPECT_EQ(row(judgement, kFlowtime, std::nullopt).pairs.size(), 20U);
}

TEST(Judgement, MemoryOfTwoProcessesInformsAlone) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (db::PairedResult& result : cells[0].results) {
    result.base.peak_memory_bytes = 50'000'000;
    result.head.peak_memory_bytes = 55'000'000;
  }
  const Judgement judgement = judgement_of(cells);
  EXPECT_NEAR(row(judgement, kMemory, std::nullopt).effect, std::log(56.05 / 51.05), 1e-4);
  EXPECT_EQ(judgement.all.verdict, Verdict::kSame);
  EXPECT_EQ(sight_text(judgement).find("memory"), std::string::npos) << sight_text(judgement);
}

TEST(Judgement, ATestOfRanksDoesNotSpeakForAMeanThatGoesTheOtherWay) {
  std::vector<db::PairedCell> cells = slower_arrivals(1, 40, 0.99);
  for (std::size_t i = 0; i < 3; ++i)
    cells[0].results[i].head.flowtime_s = *cells[0].results[i].base.flowtime_s * 1.5;
  const Judgement result = judgement_of(cells);
  EXPECT_GT(row(result, kFlowtime, std::nullopt).effect, 0.01);
  EXPECT_LT(row(result, kFlowtime, std::nullopt).adjusted_p, kRecordedLevel);
  EXPECT_EQ(result.all.verdict, Verdict::kInconclusive) << result.all.reason;
}

TEST(Judgement, TimesOfTwoMachinesSayNothing) {
  std::vector<db::PairedCell> cells = {equal_cell(3)};
  cells[0].same_machine = false;
  EXPECT_TRUE(row(judgement_of(cells), kSweepTime).pairs.empty());
}

TEST(Judgement, TasksBesidePlanningAreNoPlannings) {
  db::PairedCell task = equal_cell(20);
  task.is_planning = false;
  std::vector<db::PairedCell> cells = {equal_cell(8), task};
  cells[0].results[3].head = failed();
  const Judgement result = judgement_of(cells);
  const Difference& success = row(result, kSuccess, std::nullopt);
  EXPECT_EQ(success.plannings, 8U);
  EXPECT_EQ(success.pairs.size(), 8U);
  EXPECT_DOUBLE_EQ(success.effect, 0.125) << "one of eight";
  EXPECT_EQ(result.all.compared, 8U);
  EXPECT_EQ(result.all.instances, 8U);
  EXPECT_EQ(result.all.base_solved, 8U);
  EXPECT_EQ(result.find(kSuccess, 1), nullptr);
  EXPECT_NE(result.all.reason.find("1 of 8 plannings lost"), std::string::npos) << result.all.reason;
  // Its outcomes are compared all the same.
  cells[0].results[3].head = cells[0].results[3].base;
  EXPECT_EQ(judgement_of(cells).all.verdict, Verdict::kSame);
  cells[1].results[3].head.plan_hash = 99;
  const Judgement other = judgement_of(cells);
  EXPECT_EQ(other.all.verdict, Verdict::kChanged);
  EXPECT_EQ(other.all.other_plans, 0U);
  EXPECT_EQ(other.all.reason.find(
                "all 8 plannings gave the same status, plan and work; 1 of 20 tasks beside planning "
                "gave another outcome"),
            0U)
      << other.all.reason;
  EXPECT_EQ(other.findings.size(), 1U);
  EXPECT_NE(report_text({other, "sipplab gate", "base", "head", {}, "", ""}).find("1 of 20 tasks"),
            std::string::npos);
}

TEST(Judgement, PlansThatDifferWhenPlannedAgainAreARegression) {
  std::vector<db::PairedCell> cells = {equal_cell(8)};
  cells[0].results[3].head.plan_hash = 99;
  Judgement unstable = measured(cells);
  add_repetition(unstable, {0, 3, {ChangeKind::kRepetition, "a", "b"}});
  EXPECT_EQ(unstable.all.differing, 1U);  // a planning that differs in two ways is counted once
  add_repetition(unstable, {0, 5, {ChangeKind::kRepetition, "a", "b"}});
  EXPECT_EQ(unstable.all.differing, 2U);
  JudgeOptions expected;
  expected.expects_changes = true;
  judge(unstable, expected);
  EXPECT_EQ(unstable.all.verdict, Verdict::kRegressed);
}

}  // namespace
}  // namespace sipplab::bench
