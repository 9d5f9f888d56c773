// What the gate makes of numbers: exact values, how often it is wrong on simulated pairs, and
// that what workers say reads back.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/gate/error_rates.hpp"
#include "bench/gate/gate_cases.hpp"
#include "bench/gate/laboratory.hpp"
#include "bench/gate/protocol.hpp"
#include "bench/gate/report.hpp"
#include "bench/gate/worker.hpp"
#include "bench/judge/evidence.hpp"
#include "bench/judge/judgement.hpp"
#include "bench/temporary_folder.hpp"
#include "planner/core/random.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::bench {
namespace {

constexpr std::size_t kPairs = 14;
const double kLeastFloor = Floors().of(kProcessTime);
constexpr std::size_t kFreshPairs = 8;
constexpr std::size_t kCells = 4;
constexpr double kTolerance = 0.05;

/// Sum of twelve uniform numbers: near enough to normal, the same on every machine.
double scatter(Random& random, double deviation) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.unit();
  return deviation * sum;
}

/// Pairs of the four cells and of all together, as a virtual machine with company has them.
std::vector<std::vector<double>> pairs(Random& random, std::size_t count, double slowdown) {
  constexpr double kCellDeviation = 0.012;
  std::vector<std::vector<double>> rows(kCells + 1);
  for (std::size_t pair = 0; pair < count; ++pair) {
    double sum = 0;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      rows[cell].push_back(slowdown + scatter(random, kCellDeviation));
      sum += rows[cell].back();
    }
    rows[kCells].push_back(sum / kCells);
  }
  return rows;
}

/// After the first look, without the noise of calibrations.
std::vector<Difference> looked_at(const std::vector<std::vector<double>>& rows) {
  std::vector<Difference> differences;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Difference row;
    row.metric = &kProcessTime;
    row.cell = i;
    row.pairs = rows[i];
    row.floor = kLeastFloor;
    evaluate(row);
    differences.push_back(std::move(row));
  }
  std::vector<Difference*> all;
  for (Difference& row : differences) all.push_back(&row);
  judge_times(all);
  return differences;
}

Verdict verdict(Difference row, const std::vector<double>& fresh, double tolerance) {
  row.fresh_pairs = fresh;
  second_look(row, tolerance);
  return *row.verdict;
}

bool alarmed(Random& random, double slowdown) {
  const std::vector<Difference> rows = looked_at(pairs(random, kPairs, slowdown));
  const auto fresh = pairs(random, kFreshPairs, slowdown);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (verdict(rows[row], fresh[row], kTolerance) == Verdict::kRegressed) return true;
  }
  return false;
}

int alarms(double slowdown, int trials) {
  Random random(20);
  int count = 0;
  for (int i = 0; i < trials; ++i) count += alarmed(random, slowdown) ? 1 : 0;
  return count;
}

TEST(GateEvidence, TheMiddleHalfForgetsWildValues) {
  EXPECT_DOUBLE_EQ(interquartile_mean({1, 2, 3, 1000}), 2.5);
  EXPECT_DOUBLE_EQ(interquartile_mean({-50, 1, 2, 2, 3, 4, 9, 1000}), 2.75);
  EXPECT_DOUBLE_EQ(interquartile_mean({7}), 7);
  EXPECT_DOUBLE_EQ(interquartile_mean({}), 0);
}

TEST(GateEvidence, TheSignTestIsOneSided) {
  EXPECT_DOUBLE_EQ(slower_p_value(std::vector<double>(12, 0.1)), std::ldexp(1.0, -12));
  EXPECT_DOUBLE_EQ(slower_p_value(std::vector<double>(12, -0.1)), 1);
  EXPECT_DOUBLE_EQ(slower_p_value({1, 1, -1}), 0.5);
  EXPECT_DOUBLE_EQ(slower_p_value({1, -1, -1}), 0.875);
  EXPECT_DOUBLE_EQ(slower_p_value({0, 0}), 1);
}

TEST(GateEvidence, TheBoundIsAnOrderStatistic) {
  // Of 12 values the 10th: P(10 or more of 12 coins) = 79 / 4096, below 2.5 %.
  EXPECT_DOUBLE_EQ(upper_bound({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}), 10);
  EXPECT_DOUBLE_EQ(upper_bound({1, 2, 3, 4, 5, 6}), 6);  // 1 / 64
  EXPECT_TRUE(std::isinf(upper_bound({1, 2, 3, 4, 5})));
}

TEST(GateEvidence, SmallEffectsNeedNoSecondLook) {
  const std::vector<Difference> rows = looked_at(
      {std::vector<double>(kPairs, 0.9 * kLeastFloor), std::vector<double>(kPairs, 1.1 * kLeastFloor)});
  EXPECT_FALSE(needs_second_look(rows[0], kTolerance));
  EXPECT_TRUE(needs_second_look(rows[1], kTolerance));
  EXPECT_TRUE(needs_second_look(rows[0], 0.5 * kLeastFloor));
}

TEST(GateEvidence, LargeEffectsThatPairsDisagreeAboutAreNoRegression) {
  std::vector<double> mixed(kPairs, 0.05);
  for (std::size_t pair = 0; pair < 4; ++pair) mixed[pair] = -0.05;
  const Difference row = looked_at({mixed}).front();
  EXPECT_DOUBLE_EQ(row.effect, 0.05);
  EXPECT_TRUE(needs_second_look(row, kTolerance));
  EXPECT_EQ(verdict(row, std::vector<double>(kFreshPairs, 0.05), kTolerance), Verdict::kInconclusive);
}

TEST(GateEvidence, ASuspicionThatFreshPairsDenyIsNoRegression) {
  const Difference row = looked_at({std::vector<double>(kPairs, 0.03)}).front();
  const std::vector<double> nothing(kFreshPairs, -0.001);
  EXPECT_EQ(verdict(row, nothing, kTolerance), Verdict::kEquivalent);
  EXPECT_EQ(verdict(row, nothing, 0.02), Verdict::kInconclusive);
  EXPECT_EQ(verdict(row, std::vector<double>(kFreshPairs, 0.03), kTolerance), Verdict::kRegressed);
}

TEST(GateEvidence, WithoutASuspicionNothingIsConfirmed) {
  const Difference row = looked_at({std::vector<double>(kPairs, 0)}).front();
  EXPECT_EQ(verdict(row, std::vector<double>(kFreshPairs, 0.2), kTolerance), Verdict::kInconclusive);
}

TEST(GateEvidence, SlowdownsOfOneProgramAreNoise) {
  for (const bool excused : {true, false}) {
    Judgement judgement = measured({});
    Difference row = looked_at({std::vector<double>(kPairs, 0.03)}).front();
    row.cell.reset();
    row.fresh_pairs.assign(kFreshPairs, 0.03);
    second_look(row, kTolerance);
    judgement.differences.push_back(row);
    JudgeOptions options;
    if (excused) options.times_excuse = "the same program";
    judge(judgement, options);
    EXPECT_EQ(judgement.all.verdict, excused ? Verdict::kEquivalent : Verdict::kRegressed);
  }
}

TEST(GateEvidence, EqualBuildsRaiseFewAlarms) { EXPECT_LE(alarms(0, 2000), 20); }  // 1 %

TEST(GateEvidence, ThreePerCentAreFound) { EXPECT_GE(alarms(0.03, 1000), 950); }

TEST(GateEvidence, AFasterHeadIsNoAlarm) { EXPECT_EQ(alarms(-0.1, 200), 0); }

TEST(GateEvidence, AFasterHeadIsAnImprovementWhenFreshPairsSayItToo) {
  const Difference row = looked_at({std::vector<double>(kPairs, -0.05)}).front();
  EXPECT_TRUE(needs_second_look(row, kTolerance));
  EXPECT_EQ(verdict(row, std::vector<double>(kFreshPairs, -0.05), kTolerance), Verdict::kImproved);
  EXPECT_EQ(verdict(row, std::vector<double>(kFreshPairs, 0.001), kTolerance), Verdict::kEquivalent);
  Judgement judgement = measured({});
  Difference all = row;
  all.cell.reset();
  all.fresh_pairs.assign(kFreshPairs, -0.05);
  second_look(all, kTolerance);
  judgement.differences.push_back(all);
  judge(judgement, {});
  EXPECT_EQ(judgement.all.verdict, Verdict::kImproved);
  EXPECT_EQ(judgement.all.reason.find("faster: 4.9 % less time (95 %: 4.9 to 4.9)"), 0U)
      << judgement.all.reason;
  const std::string text = report_markdown({judgement, "sipplab gate", "a", "b"});
  EXPECT_NE(text.find("| all cells | -4.88 % | -4.88 % | "), std::string::npos) << text;
  EXPECT_EQ(text.find("| all cells | -4.88 % | -4.88 % | 1 |"), std::string::npos) << "the other side's test";
}

TEST(GateEvidence, WhatItSaysThatItSeesIsWhatItSees) {
  Random random(7);
  const std::vector<double> sample = pairs(random, 400, 0).back();
  const double smallest = detectable(sample, {kPairs, kFreshPairs, kCells + 1}, kLeastFloor);
  EXPECT_GT(smallest, kLeastFloor);
  EXPECT_LT(smallest, 0.03);
  const int found = alarms(smallest, 1000);
  EXPECT_GE(found, 930);
  EXPECT_TRUE(std::isinf(detectable(sample, {5, 5, kCells + 1}, kLeastFloor)));
}

std::vector<MeasuredRow> measured_rows(const std::vector<std::vector<double>>& pairs_of_rows) {
  std::vector<MeasuredRow> rows;
  for (const Difference& row : looked_at(pairs_of_rows)) rows.push_back({row, row.pairs});
  return rows;
}

TEST(GateErrorRates, AreThoseOfTheJudgementThatDrewThem) {
  Random random(9);
  constexpr std::size_t kMeasured = 280;
  const std::vector<MeasuredRow> rows = measured_rows(pairs(random, kMeasured, 0));
  const GateRequest request;
  const auto regressed = [&](const Planted& planted) {
    return error_rate(rows, planted, request, 1000).regressed;
  };
  EXPECT_LE(regressed({0}), 10U);
  const GatePlan plan{request.pairs, request.fresh_pairs, rows.size()};
  EXPECT_GE(regressed({detectable(rows.back().pairs, plan, kLeastFloor)}), 930U);
  const Planted in_one{detectable(rows.front().pairs, plan, kLeastFloor), 0};
  EXPECT_GE(regressed(in_one), 930U);
  EXPECT_LE(regressed({in_one.slowdown / 4, 0}), 100U);
}

TEST(GateErrorRates, ShowADisturbanceThatLasts) {
  // One side is slower for the length of half a look, then the other: the median is zero, comparisons are
  // wrong.
  std::vector<double> disturbed;
  for (int pair = 0; pair < 280; ++pair) disturbed.push_back(pair / 28 % 2 == 0 ? 0.03 : -0.03);
  EXPECT_GE(error_rate(measured_rows({disturbed}), {}, {}, 1000).regressed, 20U);
  EXPECT_EQ(error_rate(measured_rows({std::vector<double>(280, 0)}), {}, {}, 1000).regressed, 0U);
}

TEST(GateEvidence, TheFloorFollowsTheNoise) {
  EXPECT_DOUBLE_EQ(floor_from(0, kLeastFloor), kLeastFloor);
  EXPECT_DOUBLE_EQ(floor_from(0.01, kLeastFloor), kFloorInStandardErrors * 0.01);
  const double few = standard_error({-0.01, 0, 0.01, 5}, 4);
  EXPECT_GT(few, 0);
  EXPECT_LT(few, 0.02);  // the wild one says little
}

/// What a worker answers to these lines, its greeting left out.
std::vector<std::string> served(const std::string& requests) {
  std::istringstream in(requests);
  std::ostringstream out;
  serve_gate(in, out);
  std::istringstream lines(out.str());
  std::vector<std::string> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(line);
  answers.erase(answers.begin());
  return answers;
}

TEST(GateReport, SaysWhatCalibrationsShowInWordsAndInJson) {
  GateRequest request;
  request.suite = "gate";
  request.pairs = 14;
  GateResult result;
  result.calibrations = 2;
  result.judgement.cells.push_back({});
  result.judgement.cells.front().name = "empty:32x32, 32 robots";
  for (const auto& cell : {std::optional<std::size_t>(), std::optional<std::size_t>(0)}) {
    Difference row;
    row.metric = &kProcessTime;
    row.cell = cell;
    row.noise = cell ? 0.02 : 0.01;
    row.detectable = cell ? std::log(1.05) : std::log(1.02);
    result.judgement.differences.push_back(std::move(row));
  }
  result.error_rates = {{{}, 2000, 2, 10}, {{std::log(1.05), 1}, 2000, 1940, 60}};
  const std::string text = noise_text(request, result);
  EXPECT_NE(text.find("noise: 1.00 % over all cells (standard error of 14 pairs, from 2 comparisons"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("sees: a slowdown of 2.0 % over all cells, of 5.0 % in empty:32x32, 32 robots alone"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("of 2000 comparisons drawn from these pairs:\n"
                "  equal builds: 0.1 % called regressed (95 %: 0.0 to 0.4), 0.5 % inconclusive\n"
                "  5.0 % slower in empty:32x32, 32 robots alone: 97.0 % called regressed (95 %: 96.2 to "
                "97.7), 3.0 % inconclusive\n"),
      std::string::npos)
      << text;
  const auto json = nlohmann::json::parse(noise_json(request, result));
  EXPECT_EQ(json.at("error_rates").at(1).at("regressed"), 1940);
  EXPECT_EQ(json.at("comparisons"), 2);
  EXPECT_EQ(json.at("pairs"), 14);
  EXPECT_EQ(json.at("rows").size(), 2u);
}

TEST(GateWorker, AnswersEveryLine) {
  const std::vector<std::string> answers =
      served("nonsense\n{}\n{\"load\": \"nowhere.xml\"}\n{\"plan\": 7}\n{\"load\": 3}\n");
  ASSERT_EQ(answers.size(), 5U);
  for (const std::string& answer : answers) {
    const nlohmann::json json = nlohmann::json::parse(answer, nullptr, false);
    EXPECT_TRUE(json.is_object() && json.contains("error")) << answer;
  }
}

TEST(GateWorker, OptionsAndAnswersReadBack) {
  PlannerOptions options;
  options.ssi_s = kInfiniteSsi;
  options.order = InitialOrder::kRandom;
  options.rescheduling = Rescheduling::kNone;
  options.max_restarts = 3;
  options.seed = 9;
  options.weight = 1.5;
  options.time_limit_s = db::kNoTimeLimit;  // workers know none
  const auto read = options_from_json(nlohmann::json::parse(to_json(options).dump()));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->weight, 1.5);
  EXPECT_EQ(to_json(*read), to_json(options));

  WorkerAnswer answer;
  answer.row.status = db::ResultStatus::kSolved;
  answer.row.plan_hash = 0xffff'ffff'ffff'fff0;
  answer.row.flowtime_s = 0.1;
  answer.cpu_ns = 5;
  const auto again = answer_from_json(nlohmann::json::parse(to_json(answer).dump()));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->row.plan_hash, answer.row.plan_hash);
  EXPECT_EQ(again->row.flowtime_s, answer.row.flowtime_s);
  EXPECT_EQ(again->cpu_ns, 5);
  EXPECT_FALSE(answer_from_json({{"status", "lost"}}));
}

TEST(GateWorker, DoesWhatIsNotThePlanner) {
  const auto folder = TemporaryFolder::make();
  ASSERT_TRUE(folder);
  Laboratory laboratory(folder->path());
  Instance instance;
  instance.map = GridMap(4, 4);
  instance.agents.resize(1);
  instance.agents[0].start = {0, 0};
  instance.agents[0].goal = {3, 3};
  const std::string file = (folder->path() / "one.xml").string();
  ASSERT_FALSE(write_file(file, write_instance_xml(instance)));
  for (const GateTask task : kLaboratoryTasks) {
    EXPECT_EQ(parse_gate_task(name(task)), task);
    const auto once = laboratory.run(task, file, instance, {}, 0);
    ASSERT_TRUE(once) << name(task) << ": " << once.error();
    EXPECT_GT(once->cpu_ns, 0);
    EXPECT_EQ(laboratory.run(task, file, instance, {}, 0)->outcome, once->outcome) << name(task);
  }
}

TEST(GateCases, HoldEachTimedInstanceAndTheSmokeSuite) {
  const auto cases = GateCases::make("gate", 1, {});
  ASSERT_TRUE(cases);
  std::map<std::string, std::size_t> timed;
  for (const GateCell& cell : cases->cells()) {
    const char* kind = cell.task != GateTask::kPlan ? "laboratory" : cell.slow ? "crowded" : "short";
    timed[kind] += cell.timed ? cell.jobs.size() : 0;
  }
  EXPECT_EQ(timed["short"], 20U);
  EXPECT_EQ(timed["crowded"], 14U);
  EXPECT_EQ(timed["laboratory"], 20U);
  EXPECT_GT(cases->jobs().size(), 100U);
  EXPECT_EQ(cases->cells().front().name, "empty:32x32, 32 robots");
  EXPECT_FALSE(GateCases::make("nonsense", 1, {}));
}

}  // namespace
}  // namespace sipplab::bench
