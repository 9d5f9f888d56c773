// One more row in the table of options is found in the flags, in the command that plans again and in the
// columns of a case.
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "bench/cli/planner_flags.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "db/rows.hpp"
#include "db/tests/plain_case.hpp"

namespace sipplab::bench {
namespace {

/// An option that is nowhere but in its row.
double patience = 0;

std::vector<Option> rows_and_one() {
  Option option;
  option.name = "patience";
  option.help = "seconds";
  option.column = "patience_s";
  option.kind = OptionKind::kNumber;
  option.expected = "a number";
  option.always_told = true;
  option.get = [](const PlannerOptions&) { return format_ssi(patience); };
  option.set = [](PlannerOptions&, std::string_view text) {
    const std::optional<double> value = parse_ssi(text);
    if (value) patience = *value;
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

TEST(OneMoreOption, IsFoundInFlagsReplayAndColumns) {
  const std::vector<Option> rows = rows_and_one();
  cli::OptionFlags flags;
  CLI::App app;
  flags.add_to(app, kAllGroups, false, rows);
  EXPECT_NE(app.help().find("--patience"), std::string::npos);
  EXPECT_THROW(app.parse("--patience x"), CLI::ParseError);
  app.parse("--patience 2.5");
  patience = 0;
  flags.stated().applied_to({});
  EXPECT_EQ(patience, 2.5);
  EXPECT_NE(option_flags({}, rows).find(" --patience 2.5"), std::string::npos);

  const db::CaseInfo written = case_row({}, rows);
  EXPECT_EQ(written.real("patience_s"), 2.5);
  auto connection = db::sqlite::Connection::open_in_memory().value();
  db::migrate(connection, db::migrations()).value();
  connection.execute("ALTER TABLE case_ ADD COLUMN patience_s REAL NOT NULL DEFAULT 0", "adding a column")
      .value();
  const std::int64_t id = db::case_id(connection, written).value();
  auto select =
      db::sqlite::Statement::prepare(connection, "SELECT * FROM v_cases WHERE case_id = ?", "asking").value();
  ASSERT_TRUE(select.bind(id).step().value());
  patience = 0;
  options_of(db::read_case(select, 1), rows);
  EXPECT_EQ(patience, 2.5) << "written, and read again";
}

TEST(Columns, AreThoseOfTheSchema) {
  const db::CaseInfo row = case_row({});
  const db::CaseInfo schema = db::test::plain_case();
  for (const auto& [column, value] : row.options) {
    const auto found = schema.options.find(column);
    ASSERT_NE(found, schema.options.end()) << "a migration adds the column " << column;
    EXPECT_EQ(found->second, value) << column << ": the default of an older case";
  }
  EXPECT_EQ(row.options.size(), schema.options.size());
}

}  // namespace
}  // namespace sipplab::bench
