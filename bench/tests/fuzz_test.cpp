// What engines and llvm-cov print, as numbers; and the cases of the suite `adversarial`.
#include <gtest/gtest.h>

#include "bench/campaigns/coverage.hpp"
#include "bench/campaigns/engine_log.hpp"
#include "bench/campaigns/hardest.hpp"
#include "bench/sweep/adversarial.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/sweep/suites.hpp"
#include "planner/io/case_codec.hpp"

namespace sipplab::bench {
namespace {

TEST(EngineLog, ReadsWhatASingleProcessSays) {
  const EngineLog log = parse_engine_log(
      "INFO: Seed: 1\n"
      "#2\tINITED cov: 12 ft: 13 corp: 1/1b exec/s: 0 rss: 30Mb\n"
      "#1024\tpulse  cov: 500 ft: 900 corp: 12/340b lim: 80 exec/s: 512 rss: 40Mb\n"
      "#1030\tNEW    cov: 501 ft: 901 corp: 13/341b lim: 80 exec/s: 512 rss: 40Mb L: 4/9 MS: 1 CopyPart-\n"
      "#4096\tDONE   cov: 559 ft: 1498 corp: 23/86Kb lim: 80 exec/s: 2048 rss: 72Mb\n"
      "stat::slowest_unit_time_sec:    3\n"
      "stat::peak_rss_mb:              75\n");
  ASSERT_EQ(log.snapshots.size(), 3U);  // the third is no quarter more than the second
  EXPECT_EQ(log.snapshots[1].executions, 1024);
  EXPECT_EQ(log.snapshots[1].elapsed_ns, 2'000'000'000);
  EXPECT_EQ(log.last.executions, 4096);
  EXPECT_EQ(log.last.edges, 559);
  EXPECT_EQ(log.last.features, 1498);
  EXPECT_EQ(log.last.corpus_files, 23);
  EXPECT_EQ(log.corpus_bytes, 86 << 10);
  EXPECT_EQ(log.peak_memory_bytes, std::int64_t{75} << 20);
  EXPECT_EQ(log.slowest_input_s, 3);
}

TEST(EngineLog, ReadsWhatForkModeSays) {
  const EngineLog log = parse_engine_log(
      "#8192: cov: 559 ft: 1498 corp: 236 exec/s 4096 oom/timeout/crash: 0/0/2 time: 12s job: 3\n");
  EXPECT_EQ(log.last.executions, 8192);
  EXPECT_EQ(log.last.corpus_files, 236);
  EXPECT_EQ(log.last.elapsed_ns, 12'000'000'000);
}

TEST(EngineLog, PassesOverEverythingElse) {
  EXPECT_TRUE(parse_engine_log("").snapshots.empty());
  EXPECT_TRUE(
      parse_engine_log("==7==ERROR: AddressSanitizer\n    #0 0x55 in main\n# cov: ft:\n").snapshots.empty());
}

TEST(Coverage, TakesTheFilesOfThePlannerAlone) {
  const auto files = parse_coverage(
      R"({"data": [{"files": [{"filename": "/a/planner/io/text.cpp", "summary": {"lines": {"count": 8, "covered": 6}}},
                              {"filename": "/a/fuzz/x.cpp", "summary": {"lines": {"count": 9, "covered": 9}}}]}]})",
      "summary.json");
  ASSERT_TRUE(files.has_value());
  ASSERT_EQ(files->size(), 1U);
  EXPECT_EQ(files->front().file, "planner/io/text.cpp");
  EXPECT_EQ(files->front().lines, 8);
  EXPECT_EQ(files->front().covered_lines, 6);
}

TEST(Coverage, AnythingElseIsRefusedInOneLine) {
  for (const char* text : {"", "{", "[]", R"({"data": 7})", R"({"data": []})",
                           R"({"data": [{"files": [3]}]})", R"({"data": [{"files": [{"filename": 7}]}]})"}) {
    const auto files = parse_coverage(text, "summary.json");
    ASSERT_FALSE(files.has_value()) << text;
    EXPECT_EQ(files.error().rfind("summary.json: ", 0), 0U);
    EXPECT_EQ(files.error().find('\n'), std::string::npos);
  }
}

TEST(Adversarial, EveryCaseIsACaseThatIsHardAndInTheSuite) {
  const auto cases = adversarial_cases();
  EXPECT_GT(cases.size(), 10U);
  for (const db::EmbeddedText& adversarial : cases) {
    const auto plan_case = decode_case(adversarial.text);
    ASSERT_TRUE(plan_case) << adversarial.name;
    EXPECT_FALSE(find_error(plan_case->instance)) << adversarial.name;
    EXPECT_FALSE(plan_case->instance.agents.empty()) << adversarial.name;
  }
  SweepRequest request;
  request.suite = find_suite("adversarial");
  ASSERT_NE(request.suite, nullptr);
  const auto sweep = expand(request);
  ASSERT_TRUE(sweep.has_value());
  EXPECT_EQ(sweep->cases.size(), cases.size());
  EXPECT_EQ(sweep->cases.front().name.rfind("plan/adversarial-01/agents:", 0), 0U)
      << sweep->cases.front().name;
}

TEST(Hardest, OneOfEachKindTheHardestFirst) {
  HardCase easy;
  easy.plan_case.instance.agents.resize(2);
  easy.expansions = 10;
  HardCase hard = easy;
  hard.expansions = 30;
  HardCase other = easy;
  other.plan_case.options.rescheduling = Rescheduling::kNone;
  const auto kept = distinct_cases({hard, easy, other}, 5);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].expansions_per_robot(), 15);
  EXPECT_EQ(kept[1].plan_case.options.rescheduling, Rescheduling::kNone);
  EXPECT_EQ(distinct_cases({hard, easy, other}, 1).size(), 1U);
}

}  // namespace
}  // namespace sipplab::bench
