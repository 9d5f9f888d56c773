// sipplab sql: one question to the history, in SQL. It can only read.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "db/catalogue.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

struct SqlArguments {
  HistoryFlags history;
  std::string query;
  std::optional<std::string> file;
  std::vector<std::string> parameters;
  bool list = false;
};

int list_views(const SqlArguments& arguments) {
  const db::OutputFormat format = arguments.history.output_format();
  if (format != db::OutputFormat::kTable) {
    db::Table table{{"view", "since", "purpose", "example"}, {}};
    for (const db::ViewDescription& view : db::view_catalogue()) {
      table.rows.push_back({view.name, view.since, view.purpose, view.example});
    }
    print(db::format(table, format));
    return kSuccess;
  }
  std::string text;
  for (const db::ViewDescription& view : db::view_catalogue()) {
    text += fmt::format("{}: {}\n    {}\n\n", view.name, view.purpose, view.example);
  }
  print(text +
        "The examples can be given to `sipplab sql` as they are: :run is the newest run and :other the one "
        "of its\n"
        "suite before it, unless --param says which. db/schema.md explains every column.\n");
  return kSuccess;
}

int run_sql_command(const SqlArguments& arguments) {
  if (arguments.list) return list_views(arguments);
  std::string query = arguments.query;
  const bool from_input = query == "-" || (query.empty() && !arguments.file && isatty(STDIN_FILENO) == 0);
  if (arguments.file || from_input) {
    query = SIPPLAB_TRY_OR(fail, read_text(arguments.file ? *arguments.file : "/dev/stdin"));
  }
  if (query.find_first_not_of(" \t\r\n") == std::string::npos) {
    return bad_usage("no query, expected a SELECT statement, --file, standard input or --list");
  }
  std::vector<std::pair<std::string, std::string>> parameters;
  for (const std::string& text : arguments.parameters) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      return bad_usage("--param " + in_quotes(text) + ", expected NAME=VALUE");
    }
    parameters.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  const auto table =
      SIPPLAB_TRY_OR(fail, db::run_sql(db::database_path(arguments.history.database), query, parameters));
  arguments.history.show(table);
  return kSuccess;
}

}  // namespace

Command add_sql_command(CLI::App& program) {
  auto arguments = std::make_shared<SqlArguments>();
  CLI::App* command =
      program.add_subcommand("sql", "query the history in SQL; --list shows the views with examples");
  arguments->history.add_to(*command);
  CLI::Option* query = command->add_option("query", arguments->query,
                                           "one SELECT statement; - or none: read from standard input");
  command->add_option("-f,--file", arguments->file, "read the statement from this file")
      ->excludes(query)
      ->type_name("FILE");
  command->add_flag("--list", arguments->list, "list the views, with an example of each")->excludes(query);
  command
      ->add_option("--param", arguments->parameters,
                   "value of :NAME in the query; :run and :other take what `sipplab show` takes")
      ->type_name("NAME=VALUE");
  return {command, [arguments] { return run_sql_command(*arguments); }};
}

}  // namespace sipplab::cli
