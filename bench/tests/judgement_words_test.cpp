// The words for cases, commands that repeat a planning, and the tables and XML that judgements are written
// in.
#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bench/judge/case_words.hpp"
#include "bench/judge/junit.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/judge/text_table.hpp"
#include "bench/sweep/sweep_case.hpp"

namespace sipplab::bench {
namespace {

/// A case with some options, each with a value.
db::CaseInfo row_with(std::initializer_list<std::pair<const char*, const char*>> values) {
  SweepCase sweep_case;
  sweep_case.environment = sweep_case.map_spec = "warehouse";
  sweep_case.robots = 64;
  sweep_case.options.time_limit_s = db::kNoTimeLimit;
  for (const auto& [name, text] : values)
    EXPECT_TRUE(find_option(name)->set(sweep_case.options, text)) << name;
  return case_row(sweep_case);
}

TEST(ReplayCommand, TakesFilesAsTheyAre) {
  db::CaseInfo parameters =
      row_with({{"any-angle", "no"}, {"max-restarts", "9"}, {"improve", "5i"}, {"weight", "1.5"}});
  parameters.map_spec = "files";
  EXPECT_EQ(replay_command(parameters, "empty/64/3.xml"),
            "sipplab plan --instance empty/64/3.xml --ssi 5 --order shortest --reschedule deterministic "
            "--no-any-angle --connectedness 2 --weight 1.5 --seed 1 --max-restarts 9 --time-limit inf "
            "--improve 5i");
}

TEST(ReplayCommand, NamesAnotherProgramForWhatItPlanned) {
  db::CaseInfo parameters = row_with({});
  parameters.planner = "cmd:other";
  EXPECT_EQ(
      replay_command(parameters, "warehouse agents:64 seed:1 index:3"),
      "sipplab generate --map warehouse --agents 64 --seed 1 --count 4 -o replay and give replay/3.xml to "
      "cmd:other");
  EXPECT_EQ(case_words({parameters}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, cmd:other, seed 1");
}

TEST(ReplayCommand, SaysWhatRobotsAndRulesAreNotAsUsual) {
  const db::CaseInfo parameters = row_with(
      {{"turns", "yes"}, {"wait-before-move", "0.5"}, {"inflate-distance", "0.25"}, {"inflate-time", "2"}});
  EXPECT_EQ(
      replay_command(parameters,
                     "warehouse agents:64 seed:1 index:3 radius:0.3,1.4 speed:0.5,2 headings obstacles:2"),
      "sipplab generate --map warehouse --agents 64 --seed 1 --count 4 --radius 0.3,1.4 --speed 0.5,2 "
      "--obstacles 2 --headings -o replay && sipplab plan --instance replay/3.xml --ssi 5 --order shortest "
      "--reschedule deterministic --any-angle --connectedness 2 --turns --wait-before-move 0.5 "
      "--inflate-distance 0.25 --inflate-time 2 --seed 1 --time-limit inf");
  EXPECT_EQ(case_words({parameters}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, sipplab turns:yes wait-before-move:0.5 "
            "inflate-distance:0.25 inflate-time:2, seed 1");
}

TEST(CaseWords, SayWhatTellsCasesApart) {
  db::CaseInfo one = row_with({});
  db::CaseInfo other = one;
  other.options["ssi_s"] = 0.0;
  EXPECT_EQ(case_words({one, other}),
            (std::vector<std::string>{"warehouse, 64 robots, ssi 5", "warehouse, 64 robots, ssi 0"}));
  EXPECT_EQ(case_words({one}).front(),
            "warehouse, 64 robots, ssi 5, deterministic, shortest, sipplab, seed 1");
}

TEST(Junit, EscapesWhatXmlDoesNotTake) {
  JunitCase test;
  test.name = "a<b & \"c\"\x01";
  test.failure = "x > y";
  const std::string xml = junit_xml("s", {test});
  EXPECT_NE(xml.find("a&lt;b &amp; &quot;c&quot; \""), std::string::npos) << xml;
  EXPECT_NE(xml.find("failures=\"1\""), std::string::npos);
}

TEST(TextTable, SignsSlowdowns) {
  EXPECT_EQ(percent_more(0), "+0.00 %");
  EXPECT_EQ(percent_more(std::numeric_limits<double>::infinity()), "-");
  EXPECT_EQ(markdown_table({{"a", "b"}, {"1", "2"}}, 1), "| a | b |\n|---|---:|\n| 1 | 2 |\n");
}

}  // namespace
}  // namespace sipplab::bench
