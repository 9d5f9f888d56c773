// Comparisons of what was recorded: kinds of differences, verdicts, and the words for them.
#include "bench/judge/compare.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "bench/judge/case_words.hpp"
#include "bench/judge/holm.hpp"
#include "bench/judge/junit.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/judge/report.hpp"
#include "bench/judge/text_table.hpp"

namespace sipplab::bench {
namespace {

db::ResultRow solved(std::uint64_t plan, double flowtime_s) {
  db::ResultRow row;
  row.status = db::ResultStatus::kSolved;
  row.plan_hash = plan;
  row.makespan_s = flowtime_s / 2;
  row.flowtime_s = flowtime_s;
  row.planning_time_ns = 1000;
  row.tries = 1;
  row.expansions = 10;
  row.generations = 20;
  return row;
}

db::ResultRow failed() {
  db::ResultRow row;
  row.planning_time_ns = 1000;
  return row;
}

/// A cell of `count` instances that both sides solved alike.
db::PairedCell equal_cell(std::size_t count) {
  db::PairedCell cell;
  cell.parameters.environment = "warehouse";
  cell.parameters.map_spec = "warehouse";
  cell.parameters.robots = 64;
  cell.parameters.ssi_s = 5;
  cell.parameters.order = "shortest";
  cell.parameters.reschedule = "deterministic";
  cell.parameters.seed = 1;
  cell.same_machine = true;
  for (std::size_t i = 0; i < count; ++i) {
    const db::ResultRow row = solved(i, 100 + static_cast<double>(i));
    cell.results.push_back(
        {"warehouse agents:64 seed:7 index:" + std::to_string(i), "hash " + std::to_string(i), row, row});
  }
  return cell;
}

TEST(Difference, NamesTheGravestKind) {
  const db::ResultRow base = solved(1, 10);
  EXPECT_FALSE(difference(base, base));
  EXPECT_EQ(difference(base, failed())->kind, DifferenceKind::kStatus);
  EXPECT_EQ(difference(base, solved(2, 10))->kind, DifferenceKind::kPlan);
  db::ResultRow head = base;
  head.generations = 21;
  EXPECT_EQ(difference(base, head)->kind, DifferenceKind::kWork);
  head.status = db::ResultStatus::kInvalid;
  head.message = "robots 1 and 2 overlap";
  EXPECT_EQ(difference(base, head)->kind, DifferenceKind::kValidity);
  EXPECT_EQ(difference(base, head)->head, "robots 1 and 2 overlap");
}

TEST(Difference, AClockThatStruckExcusesWork) {
  db::ResultRow base = failed();
  base.status = db::ResultStatus::kLimit;
  base.limit = "time";
  db::ResultRow head = base;
  head.expansions = 99;
  EXPECT_FALSE(difference(base, head));
  head.limit = base.limit = "restarts";
  EXPECT_TRUE(difference(base, head));
}

TEST(Compare, EqualSidesAreTheSame) {
  const std::vector<db::PairedCell> cells = {equal_cell(8)};
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.verdict, CompareVerdict::kSame);
  EXPECT_EQ(result.compared, 8U);
  EXPECT_DOUBLE_EQ(result.cells[0].time_ratio.value_or(0), 1);
}

TEST(Compare, AnotherPlanIsAChangeAndUnderExactARegression) {
  std::vector<db::PairedCell> cells = {equal_cell(8)};
  cells[0].results[3].head.plan_hash = 99;
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.verdict, CompareVerdict::kChanged);
  ASSERT_EQ(result.cells[0].differences.size(), 1U);
  EXPECT_EQ(result.cells[0].differences[0].result, 3U);
  CompareOptions exact;
  exact.exact = true;
  EXPECT_EQ(compare(cells, exact).verdict, CompareVerdict::kRegressed);
}

TEST(Compare, OneLostMayBeChanceAndManyAreNot) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  cells[0].results[0].head = failed();
  EXPECT_EQ(compare(cells, {}).verdict, CompareVerdict::kInconclusive);
  // Two hypotheses, the cell and all cells: 7 lost give 2 * 2 / 2^7 = 0.03.
  for (std::size_t i = 0; i < 7; ++i) cells[0].results[i].head = failed();
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.verdict, CompareVerdict::kRegressed);
  EXPECT_DOUBLE_EQ(result.success_p, 4.0 / 128);
  EXPECT_EQ(result.cells[0].both_solved, 13U);
}

TEST(Compare, RepetitionsAndEqualFilesAreOneObservation) {
  // Eight instances, ten plannings each; the head never solves the first.
  std::vector<db::PairedCell> cells = {equal_cell(80)};
  for (std::size_t i = 0; i < 80; ++i) {
    cells[0].results[i].instance_hash = "hash " + std::to_string(i % 8);
    if (i % 8 == 0) cells[0].results[i].head = failed();
  }
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.verdict, CompareVerdict::kInconclusive) << result.reason;
  EXPECT_EQ(result.cells[0].instances, 8U);
  EXPECT_EQ(result.cells[0].lost, std::vector<std::size_t>{0});
  EXPECT_EQ(result.lost, 1U);
  EXPECT_DOUBLE_EQ(result.success_p, 1);
  EXPECT_EQ(result.cells[0].head_solved, 70U);
  const CompareReport report{{"run 1", std::nullopt, {}}, {"run 2", std::nullopt, {}}, result};
  EXPECT_NE(compare_text(report).find("8 (80)"), std::string::npos) << compare_text(report);
}

TEST(Compare, AnInstanceLostInManyCellsIsOneLost) {
  std::vector<db::PairedCell> cells(7, equal_cell(6));
  for (db::PairedCell& cell : cells) cell.results[2].head = failed();
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.lost, 1U);
  EXPECT_EQ(result.verdict, CompareVerdict::kInconclusive) << result.reason;
}

TEST(Compare, AnInstanceSolvedMoreOftenByTheHeadIsGained) {
  std::vector<db::PairedCell> cells = {equal_cell(6)};
  for (db::PairedResult& result : cells[0].results) result.instance_hash = "one";
  cells[0].results[1].base = cells[0].results[2].base = failed();
  cells[0].results[4].head = failed();
  const CompareResult result = compare(cells, {});
  EXPECT_TRUE(result.cells[0].lost.empty());
  EXPECT_EQ(result.cells[0].gained, std::vector<std::size_t>{1});
}

TEST(Compare, FourInstancesPlannedOftenAreFourFlowtimes) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (std::size_t i = 0; i < 20; ++i) {
    db::PairedResult& result = cells[0].results[i];
    result.instance_hash = "hash " + std::to_string(i % 4);
    result.head.flowtime_s = *result.base.flowtime_s * 1.2;
  }
  const CompareResult result = compare(cells, {});
  EXPECT_NEAR(result.cells[0].flowtime.mean_ratio, 1.2, 1e-9);
  EXPECT_DOUBLE_EQ(result.cells[0].flowtime.p_value, 0.125);  // 2 / 2^4, the least that four can give
  EXPECT_NE(result.verdict, CompareVerdict::kRegressed) << result.reason;
}

TEST(Compare, WhatTheClockCutShortIsNotCalledTheSame) {
  std::vector<db::PairedCell> cells = {equal_cell(6)};
  for (std::size_t i = 0; i < 4; ++i) {
    cells[0].results[i].base.limit = cells[0].results[i].head.limit = "time";
    cells[0].results[i].head.plan_hash = 99;
  }
  const CompareResult result = compare(cells, {});
  EXPECT_EQ(result.verdict, CompareVerdict::kSame);
  EXPECT_EQ(result.cut_short, 4U);
  EXPECT_NE(result.reason.find("but for 4 that the clock cut short"), std::string::npos) << result.reason;
}

TEST(Compare, AnInvalidPlanIsARegressionAlone) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  cells[0].results[4].head.status = db::ResultStatus::kInvalid;
  EXPECT_EQ(compare(cells, {}).verdict, CompareVerdict::kRegressed);
}

TEST(Compare, LongerFlowtimesCountWhenCertainAndLarge) {
  std::vector<db::PairedCell> cells = {equal_cell(20)};
  for (db::PairedResult& result : cells[0].results) {
    result.head.flowtime_s = *result.base.flowtime_s * 1.03;
    result.head.plan_hash = 5000;
  }
  EXPECT_EQ(compare(cells, {}).verdict, CompareVerdict::kRegressed);
  for (db::PairedResult& result : cells[0].results) result.head.flowtime_s = *result.base.flowtime_s * 1.005;
  EXPECT_EQ(compare(cells, {}).verdict, CompareVerdict::kChanged);
}

TEST(Compare, TimesOfTwoMachinesSayNothing) {
  std::vector<db::PairedCell> cells = {equal_cell(3)};
  cells[0].same_machine = false;
  EXPECT_EQ(compare(cells, {}).cells[0].time_ratio, std::nullopt);
}

TEST(Compare, ReportsNameTheInstanceAndTheCommand) {
  std::vector<db::PairedCell> cells = {equal_cell(4)};
  cells[0].results[2].head = failed();
  const CompareResult result = compare(cells, {});
  const db::ComparisonSide base{"run 1", std::nullopt, {}};
  const db::ComparisonSide head{"run 2", std::nullopt, {}};
  const CompareReport report{base, head, result};
  const std::string command =
      "sipplab generate --map warehouse --agents 64 --seed 7 --count 3 -o replay && "
      "sipplab plan --instance replay/2.xml --ssi 5 --reschedule deterministic "
      "--order shortest --connectedness 2 --seed 1";
  for (const std::string& text : {compare_text(report), compare_markdown(report), compare_json(report)}) {
    EXPECT_NE(text.find("index:2"), std::string::npos) << text;
    EXPECT_NE(text.find(command), std::string::npos) << text;
  }
  EXPECT_NE(compare_junit(report).find("skipped=\"1\""), std::string::npos);
}

TEST(ReplayCommand, TakesFilesAsTheyAre) {
  db::CaseInfo parameters = equal_cell(0).parameters;
  parameters.map_spec = "files";
  parameters.any_angle = false;
  parameters.planner = "aa-sipp+complete";
  EXPECT_NE(replay_command(parameters, "a.xml").find(" --fallback complete"), std::string::npos);
  parameters.planner = "complete";
  EXPECT_NE(replay_command(parameters, "a.xml").find(" --method complete"), std::string::npos);
  parameters.planner = "aa-sipp";
  EXPECT_EQ(replay_command(parameters, "empty/64/3.xml"),
            "sipplab plan --instance empty/64/3.xml --ssi 5 --reschedule deterministic --order shortest "
            "--connectedness 2 --no-any-angle --seed 1");
}

TEST(ReplayCommand, NamesAnotherProgramForWhatItPlanned) {
  db::CaseInfo parameters = equal_cell(0).parameters;
  parameters.planner = "cmd:other";
  EXPECT_EQ(
      replay_command(parameters, "warehouse agents:64 seed:1 index:3"),
      "sipplab generate --map warehouse --agents 64 --seed 1 --count 4 -o replay and give replay/3.xml to "
      "cmd:other");
  EXPECT_EQ(case_words({parameters}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, cmd:other, seed 1");
}

TEST(ReplayCommand, SaysWhatRobotsAndRulesAreNotAsUsual) {
  db::CaseInfo parameters = equal_cell(0).parameters;
  parameters.planner = "aa-sipp+turns+wait:0.5+distance:0.25+time:2";
  EXPECT_EQ(
      replay_command(parameters,
                     "warehouse agents:64 seed:1 index:3 radius:0.3,1.4 speed:0.5,2 headings obstacles:2"),
      "sipplab generate --map warehouse --agents 64 --seed 1 --count 4 --radius 0.3,1.4 --speed 0.5,2 "
      "--obstacles 2 --headings -o replay && sipplab plan --instance replay/3.xml --ssi 5 --reschedule "
      "deterministic --order shortest --connectedness 2 --seed 1 --turns --wait-before-move 0.5 "
      "--inflate-distance 0.25 --inflate-time 2");
  EXPECT_EQ(case_words({parameters}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, "
            "any-angle-4+turns+wait:0.5+distance:0.25+time:2, "
            "seed 1");
}

TEST(CaseWords, SayWhatTellsCasesApart) {
  db::CaseInfo one = equal_cell(0).parameters;
  db::CaseInfo other = one;
  other.ssi_s = 0;
  EXPECT_EQ(case_words({one, other}),
            (std::vector<std::string>{"warehouse, 64 robots, ssi 5", "warehouse, 64 robots, ssi 0"}));
  EXPECT_EQ(case_words({one}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, any-angle-4, seed 1");
}

TEST(Holm, MultipliesByTheTestsThatAreLeft) {
  EXPECT_EQ(holm({0.01, 0.5, 0.02}), (std::vector<double>{0.03, 0.5, 0.04}));
  EXPECT_EQ(holm({0.4, 0.3}), (std::vector<double>{0.6, 0.6}));
}

TEST(Junit, EscapesWhatXmlDoesNotTake) {
  JunitCase test;
  test.name = "a<b & \"c\"\x01";
  test.failure = "x > y";
  const std::string xml = junit_xml("s", {test});
  EXPECT_NE(xml.find("a&lt;b &amp; &quot;c&quot;?"), std::string::npos) << xml;
  EXPECT_NE(xml.find("failures=\"1\""), std::string::npos);
}

TEST(TextTable, SignsSlowdowns) {
  EXPECT_EQ(percent_slower(0), "+0.00 %");
  EXPECT_EQ(percent_slower(std::numeric_limits<double>::infinity()), "-");
  EXPECT_EQ(markdown_table({{"a", "b"}, {"1", "2"}}, 1), "| a | b |\n|---|---:|\n| 1 | 2 |\n");
}

}  // namespace
}  // namespace sipplab::bench
