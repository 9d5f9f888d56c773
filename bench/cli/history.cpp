#include "bench/cli/history.hpp"

#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"

namespace sipplab::cli {

void HistoryFlags::add_to(CLI::App& command) {
  add_database_flag(command, database);
  command.add_option("--format", format, "table, csv or json")
      ->check(CLI::IsMember({"table", "csv", "json"}))
      ->capture_default_str();
  command.add_flag("--json", json, "the same as --format json");
}

CLI::App* HistoryFlags::add_command(CLI::App& parent, const std::string& name,
                                    const std::string& description) {
  CLI::App* command = parent.add_subcommand(name, description);
  add_to(*command);
  return command;
}

void HistoryFlags::show(const db::Table& table) const { print(db::format(table, output_format())); }

db::Result<db::Database> open_history(const std::optional<std::string>& path) {
  return db::Database::open(db::database_path(path));
}

db::Result<db::Database> read_history(const std::optional<std::string>& path) {
  return db::Database::open_read_only(db::database_path(path));
}

db::OutputFormat HistoryFlags::output_format() const {
  if (json) return db::OutputFormat::kJson;
  return db::parse_output_format(format).value_or(db::OutputFormat::kTable);
}

int fail(const db::Error& error) {
  return fail(error.kind == db::ErrorKind::kInternal ? kInternalError : kBadUsage, error.message);
}

}  // namespace sipplab::cli
