// What is said of judgements: the reason of a verdict, and reports as text, Markdown, JSON and JUnit's XML.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/judge/report.hpp"
#include "bench/tests/judgement_support.hpp"

namespace sipplab::bench {
namespace {

TEST(Judgement, WhatTheClockCutShortIsNotCalledTheSame) {
  std::vector<db::PairedCell> cells = {equal_cell(6)};
  for (std::size_t i = 0; i < 4; ++i) {
    cells[0].results[i].base.limit = cells[0].results[i].head.limit = "time";
    cells[0].results[i].head.plan_hash = 99;
  }
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.verdict, Verdict::kSame);
  EXPECT_EQ(result.all.cut_short, 4U);
  EXPECT_NE(result.all.reason.find("but for 4 that the clock cut short"), std::string::npos)
      << result.all.reason;
}

TEST(Judgement, SaysWhatItCouldHaveSeen) {
  std::vector<db::PairedCell> cells = slower_arrivals(1, 100, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    db::PairedResult& result = cells[0].results[i];
    result.head.flowtime_s = *result.base.flowtime_s * std::exp(i % 2 == 0 ? 0.01 : -0.01);
  }
  const Judgement result = judgement_of(cells);
  // A standard error of 0.00101, the normal quantiles of 1 - 0.01 / 7 / 2 and 0.95.
  EXPECT_NEAR(row(result, kFlowtime, std::nullopt).detectable, (3.189 + 1.645) * 0.001005 / std::sqrt(0.9549),
              2e-5);
  EXPECT_NE(
      report_text({result, "sipplab compare", "a", "b"})
          .find("sees, 19 times of 20, with 100 plannings of 100 instances: success from 21.0 points on, "
                "flowtime from 0.5 % on"),
      std::string::npos)
      << report_text({result, "sipplab compare", "a", "b"});
}

TEST(Judgement, ReportsNameTheInstanceAndTheCommand) {
  std::vector<db::PairedCell> cells = {equal_cell(4)};
  cells[0].results[2].head = failed();
  const Judgement result = judgement_of(cells);
  const Report report{result, "sipplab compare", "run 1", "run 2"};
  const std::string command =
      "sipplab generate --map warehouse --agents 64 --seed 7 --count 3 -o replay && "
      "sipplab plan --instance replay/2.xml --ssi 5 --order shortest --reschedule deterministic "
      "--any-angle --connectedness 2 --seed 1 --time-limit inf";
  for (const std::string& text : {report_text(report), report_markdown(report), report_json(report)}) {
    EXPECT_NE(text.find("index:2"), std::string::npos) << text;
    EXPECT_NE(text.find(command), std::string::npos) << text;
  }
  EXPECT_NE(report_junit(report).find("skipped=\"1\""), std::string::npos);
}

TEST(Judgement, UnexpectedChangesOfPlansFailInJunit) {
  std::vector<db::PairedCell> cells = {equal_cell(8), equal_cell(8)};
  cells[1].parameters.robots = 65;
  cells[1].results[3].head.plan_hash = 99;
  const Judgement result = judgement_of(cells);
  Report report{result, "sipplab compare", "a", "b"};
  EXPECT_NE(report_junit(report).find("failures=\"0\" skipped=\"0\""), std::string::npos);
  report.changes_fail = true;
  const std::string xml = report_junit(report);
  EXPECT_NE(xml.find("failures=\"2\" skipped=\"0\""), std::string::npos)
      << "the cell, and the whole: " << xml;
  EXPECT_NE(xml.find("name=\"warehouse, 65 robots\"><failure message=\"1 of 8 plannings changed"),
            std::string::npos)
      << xml;
  // What cannot be told to be worse is another plan all the same.
  cells[1].results[3].head = failed();
  const Judgement lost = judgement_of(cells);
  ASSERT_EQ(lost.all.verdict, Verdict::kInconclusive);
  Report doubtful{lost, "sipplab compare", "a", "b"};
  doubtful.changes_fail = true;
  EXPECT_NE(report_junit(doubtful).find("failures=\"2\" skipped=\"0\""), std::string::npos);
}

TEST(Judgement, AllCellsTogetherHaveAnEffectWithItsInterval) {
  std::vector<db::PairedCell> cells(3, equal_cell(20));
  for (std::size_t cell = 0; cell < 3; ++cell) {
    for (std::size_t i = 0; i < 20; ++i) {
      db::PairedResult& result = cells[cell].results[i];
      result.instance_hash = "cell " + std::to_string(cell) + " instance " + std::to_string(i);
      result.head.flowtime_s = *result.base.flowtime_s * (i % 2 == 0 ? 1.01 : 1.03);
      result.head.expansions = 12;
    }
  }
  const Judgement result = judgement_of(cells);
  const Difference& flowtime = row(result, kFlowtime, std::nullopt);
  EXPECT_EQ(flowtime.pairs.size(), 60U);
  EXPECT_NEAR(flowtime.effect, (std::log(1.01) + std::log(1.03)) / 2, 1e-12);
  // Student's quantile for 59 degrees of freedom is 2.001.
  EXPECT_NEAR(flowtime.at_most - flowtime.effect,
              2.001 * (std::log(1.03) - std::log(1.01)) / 2 / std::sqrt(59.0), 1e-5);
  EXPECT_NEAR(flowtime.at_least + flowtime.at_most, 2 * flowtime.effect, 1e-12);
  EXPECT_EQ(flowtime.verdict, Verdict::kRegressed);
  EXPECT_NEAR(std::exp(row(result, kExpansions, std::nullopt).effect), 1.2, 1e-9);
  const std::string text = report_text({result, "sipplab compare", "a", "b"});
  EXPECT_NE(text.find("\nREGRESSED: flowtime +2.0 % (95 %: +1."), std::string::npos) << text;
}

TEST(Judgement, TheWorstCellIsNamedAndTheOthersAreCounted) {
  std::vector<db::PairedCell> cells(3, equal_cell(20));
  for (std::size_t cell = 0; cell < 3; ++cell) {
    cells[cell].parameters.robots = 64 + static_cast<std::int64_t>(cell);
    for (db::PairedResult& result : cells[cell].results) {
      if (cell > 0) result.head.flowtime_s = *result.base.flowtime_s * (1 + 0.02 * static_cast<double>(cell));
    }
  }
  const Judgement result = judgement_of(cells);
  EXPECT_EQ(result.all.reason.find("flowtime +2.0 % (95 %: "), 0U) << result.all.reason;
  EXPECT_NE(
      result.all.reason.find(", most of all +4.0 % in warehouse, 66 robots (2 of 3 cells are like that)"),
      std::string::npos)
      << result.all.reason;
  EXPECT_EQ(result.cells[0].verdict, Verdict::kSame);
  EXPECT_EQ(result.cells[1].verdict, Verdict::kRegressed);
}

TEST(Judgement, ASlowCellIsNotCalledNoSlowdownOfAll) {
  const auto times = [](double log_ratio, Verdict verdict, std::optional<std::size_t> cell) {
    Difference row{.metric = &kProcessTime, .cell = cell, .pairs = std::vector<double>(14, log_ratio)};
    row.effect = row.at_least = row.at_most = log_ratio;
    row.verdict = verdict;
    return row;
  };
  for (const bool slower : {true, false}) {
    Judgement judgement = measured({equal_cell(8)});
    judgement.differences.push_back(times(0.002, Verdict::kEquivalent, std::nullopt));
    judgement.differences.push_back(slower ? times(0.05, Verdict::kRegressed, 0)
                                           : times(0.001, Verdict::kEquivalent, 0));
    judge(judgement, {});
    EXPECT_EQ(judgement.all.reason.find("no slowdown") == std::string::npos, slower) << judgement.all.reason;
    EXPECT_EQ(judgement.all.reason.find("over all cells time +0.2 %") != std::string::npos, slower);
  }
}

}  // namespace
}  // namespace sipplab::bench
