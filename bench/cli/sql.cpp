// sipplab sql: one question to the history, in SQL. It can only read.
#include <memory>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"

namespace sipplab::cli {
namespace {

struct SqlArguments {
  HistoryFlags history;
  std::string query;
};

int run_sql_command(const SqlArguments& arguments) {
  const auto table = db::run_sql(db::database_path(arguments.history.database), arguments.query);
  if (!table) return fail(table.error());
  print(db::format(*table, arguments.history.output_format()));
  return kSuccess;
}

}  // namespace

Command add_sql_command(CLI::App& program) {
  auto arguments = std::make_shared<SqlArguments>();
  CLI::App* command =
      program.add_subcommand("sql", "ask the history in SQL; db/schema.md explains views and columns");
  arguments->history.add_to(*command);
  command->add_option("query", arguments->query, "one SELECT statement")->required();
  return {command, [arguments] { return run_sql_command(*arguments); }};
}

}  // namespace sipplab::cli
