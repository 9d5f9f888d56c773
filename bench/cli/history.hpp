// What the commands that read the history share: opening it, output formats, and
// exit codes for its errors.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "db/database.hpp"
#include "db/sqlite/error.hpp"
#include "db/table.hpp"

namespace sipplab::cli {

/// --db, --format table|csv|json and --json.
struct HistoryFlags {
  std::optional<std::string> database;
  std::string format = "table";
  bool json = false;

  void add_to(CLI::App& command);
  /// Adds a command with these flags to another.
  CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& description);
  db::OutputFormat output_format() const;
  /// Prints it in that format.
  void show(const db::Table& table) const;
};

/// The history that --db names; open_history() makes a missing one.
db::Result<db::Database> open_history(const std::optional<std::string>& path);
db::Result<db::Database> read_history(const std::optional<std::string>& path);

/// kInternalError for what SQLite itself reports, else kBadUsage.
int fail(const db::Error& error);

}  // namespace sipplab::cli
