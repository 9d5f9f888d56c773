// The history file: where it is, how it is opened, and that its schema is ours.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// `option` (what --db says) if given, else $SIPPLAB_DB if set and not empty, else
/// "sipplab.db" in the working directory.
std::filesystem::path database_path(const std::optional<std::string>& option);

/// How a writer keeps a transaction that is killed from leaving half of it.
enum class Journal {
  kWriteAhead,  ///< readers and writers beside each other, on one machine: the log is shared in memory
  kRollback,    ///< one file after each transaction, also on network file systems that have locks
};

/// An open history. Its schema is the one of this program.
class Database {
 public:
  /// Opens for writing; a file that is missing or empty becomes a fresh history, an
  /// older one is migrated. A file that is something else, newer than this program, or
  /// older than the first release is refused and stays as it is, byte for byte.
  static Result<Database> open(const std::filesystem::path& path, Journal journal = Journal::kWriteAhead);

  /// Opens for reading; a missing file is an error. An older history is migrated
  /// first, for which it must be writable. Where that is allowed, reading leaves no
  /// file beside the history.
  static Result<Database> open_read_only(const std::filesystem::path& path);

  sqlite::Connection& connection() { return connection_; }
  const std::filesystem::path& path() const { return path_; }

  /// Opened for reading, from a medium on which nothing can be written.
  bool is_immutable() const { return is_immutable_; }

  /// The schema version that this program writes.
  static int latest_schema_version();

 private:
  /// SQLite makes a log even to read, and only a connection that may write takes it away again, as the last
  /// one that closes. Does so when it is destroyed, if the log is empty.
  class LogSweeper {
   public:
    explicit LogSweeper(std::filesystem::path path) : path_(std::move(path)) {}
    ~LogSweeper();
    LogSweeper(const LogSweeper&) = delete;
    LogSweeper& operator=(const LogSweeper&) = delete;

   private:
    std::filesystem::path path_;
  };

  Database(sqlite::Connection connection, std::filesystem::path path);

  std::unique_ptr<LogSweeper> sweeper_;  ///< of a reader; goes after its connection
  sqlite::Connection connection_;
  std::filesystem::path path_;
  bool is_immutable_ = false;
};

}  // namespace sipplab::db
