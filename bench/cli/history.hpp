// What the commands that read the history share: opening it, output formats, and
// exit codes for its errors.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "db/database.hpp"
#include "db/error.hpp"
#include "db/table.hpp"

namespace sipplab::cli {

/// --db, --format table|csv|json and --json.
struct HistoryFlags {
  std::optional<std::string> database;
  std::string format = "table";
  bool json = false;

  void add_to(CLI::App& command);
  db::OutputFormat output_format() const;
};

/// kInternalError for what SQLite itself reports, else kBadUsage.
int fail(const db::Error& error);

}  // namespace sipplab::cli
