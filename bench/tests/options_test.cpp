// One more row in the table of options is found in the flags, in the command that plans again, in the label
// and in the history.
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "bench/cli/planner_flags.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "db/rows.hpp"
#include "db/tests/plain_case.hpp"
#include "planner/core/number.hpp"

namespace sipplab::bench {
namespace {

/// An option that is nowhere but in its row. It lies in a member that no case keeps.
std::vector<Option> rows_and_one() {
  Option option;
  option.name = "patience";
  option.help = "tries";
  option.json = "patience";
  option.kind = OptionKind::kCount;
  option.expected = "a number";
  option.get = [](const PlannerOptions& options) { return std::to_string(options.threads); };
  option.set = [](PlannerOptions& options, std::string_view text) {
    const auto value = parse_number<unsigned>(text);
    options.threads = value.value_or(options.threads);
    return value.has_value();
  };
  std::vector<Option> rows(option_rows().begin(), option_rows().end());
  rows.push_back(option);
  return rows;
}

constexpr std::initializer_list<OptionGroup> kAllGroups = {OptionGroup::kPlanner, OptionGroup::kMotion,
                                                           OptionGroup::kLimits, OptionGroup::kImprovement};

TEST(OptionFlags, TakeWhatTheTableHas) {
  cli::OptionFlags flags;
  CLI::App app;
  flags.add_to(app, kAllGroups);
  app.parse("--ssi 2.5,9 --weight=1.5 --turns --no-any-angle --max-restarts 7 --improve 5i");
  const PlannerOptions options = flags.stated().applied_to({});
  EXPECT_EQ(options.ssi_s, 2.5);
  EXPECT_EQ(options.longer_ssi_s, std::vector<double>{9});
  EXPECT_EQ(options.weight, 1.5);
  EXPECT_TRUE(options.rules.turns);
  EXPECT_FALSE(options.any_angle);
  EXPECT_EQ(options.max_restarts, 7u);
  EXPECT_EQ(options.improve, parse_improve_budget("5i"));
  EXPECT_TRUE(flags.stated().states("weight"));
  EXPECT_FALSE(flags.stated().states("seed"));
  for (const char* wrong :
       {"--weight 0.5", "--threads 0", "--time-limit 0", "--turns=x", "--seed 5,6", "--method x"}) {
    EXPECT_THROW(app.parse(wrong), CLI::ParseError) << wrong;
  }
}

TEST(OptionFlags, TakeSeveralValuesInASweep) {
  cli::OptionFlags flags;
  CLI::App app;
  flags.add_to(app, kAllGroups, true);
  app.parse("--weight 1,1.5 --no-turns");
  ASSERT_EQ(flags.values().size(), 2u);
  EXPECT_EQ(flags.values()[0].texts, (std::vector<std::string>{"1", "1.5"}));
  EXPECT_EQ(flags.values()[1].texts, std::vector<std::string>{"no"});
}

TEST(OneMoreOption, IsFoundInFlagsReplayLabelAndHistory) {
  const std::vector<Option> rows = rows_and_one();
  cli::OptionFlags flags;
  CLI::App app;
  flags.add_to(app, kAllGroups, false, rows);
  EXPECT_NE(app.help().find("--patience"), std::string::npos);
  EXPECT_THROW(app.parse("--patience x"), CLI::ParseError);
  app.parse("--patience 25");
  SweepCase sweep_case;
  sweep_case.options = flags.stated().applied_to({});
  EXPECT_EQ(sweep_case.options.threads, 25u);
  EXPECT_EQ(option_flags(sweep_case.options, rows), option_flags(sweep_case.options) + " --patience 25");
  EXPECT_EQ(label_of(sweep_case.options, rows), "sipplab patience:25");

  const db::CaseInfo written = case_row(sweep_case, rows);
  auto connection = db::sqlite::Connection::open_in_memory().value();
  db::migrate(connection, db::migrations()).value();
  const std::int64_t id = db::case_id(connection, written).value();
  auto select =
      db::sqlite::Statement::prepare(connection, "SELECT * FROM v_cases WHERE case_id = ?", "asking", id)
          .value();
  ASSERT_TRUE(select.step().value());
  EXPECT_EQ(db::read_case(select, 1), written);
  EXPECT_EQ(options_of(db::read_case(select, 1), rows).threads, 25u) << "written, and read again";
  EXPECT_EQ(case_row({}, rows), case_row({})) << "a case from before the option is the same";
}

TEST(Columns, AreThoseOfTheSchema) {
  const db::CaseInfo row = case_row({});
  const db::CaseInfo schema = db::test::plain_case();
  for (const auto& [column, value] : row.options) {
    const auto found = schema.options.find(column);
    ASSERT_NE(found, schema.options.end()) << "no column " << column;
    EXPECT_EQ(found->second, value) << column << ": the default of an older case";
  }
  EXPECT_EQ(row.options.size(), schema.options.size());
}

}  // namespace
}  // namespace sipplab::bench
