// The history file: where it is, how it is opened, and that its schema is ours.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "db/error.hpp"
#include "db/sqlite/connection.hpp"

namespace sipplab::db {

/// `option` (what --db says) if given, else $SIPPLAB_DB if set and not empty, else
/// "sipplab.db" in the working directory.
std::filesystem::path database_path(const std::optional<std::string>& option);

/// An open history. Its schema is the one of this program.
class Database {
 public:
  /// Opens for writing; a file that is missing or empty becomes a fresh history, an
  /// older one is migrated. A file that is something else, newer than this program, or
  /// older than the first release is refused and stays as it is, byte for byte.
  static Result<Database> open(const std::filesystem::path& path);

  /// Opens for reading; a missing file is an error. An older history is migrated
  /// first, for which it must be writable.
  static Result<Database> open_read_only(const std::filesystem::path& path);

  sqlite::Connection& connection() { return connection_; }
  const std::filesystem::path& path() const { return path_; }

  /// The schema version that this program writes.
  static int latest_schema_version();

 private:
  Database(sqlite::Connection connection, std::filesystem::path path);

  sqlite::Connection connection_;
  std::filesystem::path path_;
};

}  // namespace sipplab::db
