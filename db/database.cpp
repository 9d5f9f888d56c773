// Opening a history: what the file is comes first, changing it comes after.
#include "db/database.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <system_error>
#include <utility>

#include "db/migrate.hpp"

namespace sipplab::db {
namespace {

namespace fs = std::filesystem;

// SQLite's own message for these ("unable to open database file") does not say what is wrong.
std::optional<Error> find_path_error(const fs::path& path, bool must_exist) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  const bool exists = fs::exists(status);
  if (fs::is_directory(status)) {
    return Error{ErrorKind::kCannotOpen,
                 fmt::format("{}: a directory, expected a database file", path.string())};
  }
  if (exists && !fs::is_regular_file(status)) {
    return Error{ErrorKind::kCannotOpen,
                 fmt::format("{}: not a regular file, expected a database file", path.string())};
  }
  if (!exists && must_exist) {
    return Error{
        ErrorKind::kNotFound,
        fmt::format("{}: no such file, expected a history; `sipplab bench` makes one", path.string())};
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path{"."};
  if (!exists && !fs::is_directory(folder, code)) {
    return Error{ErrorKind::kCannotOpen,
                 fmt::format("{}: no folder {}, expected it to exist", path.string(), folder.string())};
  }
  return std::nullopt;
}

Result<Done> configure_for_writing(sqlite::Connection& connection, Journal journal) {
  // WAL: readers go on while a case is written, and a killed writer leaves no half of
  // a transaction. NORMAL: a commit does not wait for the disk; a power failure can
  // take the newest cases, never the integrity.
  // The cache holds the index of some 500,000 instances (32 MiB), and the log grows to
  // 16 MiB before it is copied back: with SQLite's 2 and 4 MiB pages are written and
  // read again in the middle of a sweep.
  // Of a rollback journal only FULL keeps the integrity.
  const bool ahead = journal == Journal::kWriteAhead;
  for (const char* pragma :
       {ahead ? "PRAGMA journal_mode = WAL" : "PRAGMA journal_mode = DELETE",
        ahead ? "PRAGMA synchronous = NORMAL" : "PRAGMA synchronous = FULL", "PRAGMA foreign_keys = ON",
        "PRAGMA cache_size = -32768", "PRAGMA wal_autocheckpoint = 4096"}) {
    SIPPLAB_TRY(connection.execute(pragma, "preparing it for writing"));
  }
  return Done{};
}

bool has_file(const fs::path& path, const char* suffix) {
  std::error_code code;
  const auto size = fs::file_size(path.string() + suffix, code);
  return !code && size > 0;
}

bool has_write_ahead_log(const fs::path& path) { return has_file(path, "-wal"); }

// On a read-only medium SQLite cannot place its lock files. Without a log to replay
// the file alone is the whole database, and no process can be writing to it.
Result<sqlite::Connection> open_for_reading(const fs::path& path, SchemaState& state, bool& immutable) {
  auto connection = SIPPLAB_TRY(sqlite::Connection::open(path, sqlite::OpenMode::kReadOnly));
  auto inspected = inspect(connection, migrations());
  const bool unwritable = !inspected && inspected.error().kind == ErrorKind::kCannotOpen;
  for (const char* log : {"-wal", "-journal"}) {
    if (!unwritable || !has_file(path, log)) continue;
    return Unexpected{
        Error{ErrorKind::kCannotOpen,
              fmt::format("{0}: a program that was killed left {0}{1}, expected a copy of both where "
                          "it can be written, or the permission to write here",
                          path.string(), log)}};
  }
  immutable = unwritable;
  if (unwritable) {
    connection = SIPPLAB_TRY(sqlite::Connection::open(path, sqlite::OpenMode::kImmutable));
    inspected = inspect(connection, migrations());
  }
  if (!inspected) return Unexpected{inspected.error()};
  state = *inspected;
  return connection;
}

}  // namespace

fs::path database_path(const std::optional<std::string>& option) {
  if (option) return *option;
  const char* environment = std::getenv("SIPPLAB_DB");
  if (environment != nullptr && *environment != '\0') return environment;
  return "sipplab.db";
}

Database::Database(sqlite::Connection connection, fs::path path)
    : connection_(std::move(connection)), path_(std::move(path)) {}

Database::LogSweeper::~LogSweeper() {
  std::error_code code;
  const fs::path log = path_.string() + "-wal";
  if (!fs::exists(log, code) || has_write_ahead_log(path_) || !fs::exists(path_, code)) return;
  // What it is asked does not matter, but it has to look at the log to be one of its users.
  auto connection = sqlite::Connection::open(path_, sqlite::OpenMode::kReadWrite);
  if (connection) static_cast<void>(connection->query_int("PRAGMA schema_version", "closing it"));
}

int Database::latest_schema_version() { return migrations().back().version; }

Result<Database> Database::open(const fs::path& path, Journal journal) {
  if (auto error = find_path_error(path, false)) return Unexpected{*error};
  auto connection = SIPPLAB_TRY(sqlite::Connection::open(path, sqlite::OpenMode::kReadWrite));
  SIPPLAB_TRY(inspect(connection, migrations()));
  SIPPLAB_TRY(configure_for_writing(connection, journal));
  SIPPLAB_TRY(migrate(connection, migrations()));
  return Database{std::move(connection), path};
}

Result<Database> Database::open_read_only(const fs::path& path) {
  if (auto error = find_path_error(path, true)) return Unexpected{*error};
  SchemaState state;
  bool immutable = false;
  auto connection = SIPPLAB_TRY(open_for_reading(path, state, immutable));
  if (state.fresh) {
    return Unexpected{Error{
        ErrorKind::kNotADatabase,
        fmt::format("{}: an empty file, expected a history; `sipplab bench` makes one", path.string())}};
  }
  if (state.version < latest_schema_version()) {
    SIPPLAB_TRY(open(path));
    connection = SIPPLAB_TRY(open_for_reading(path, state, immutable));
  }
  Database database{std::move(connection), path};
  database.is_immutable_ = immutable;
  database.sweeper_ = std::make_unique<LogSweeper>(path);
  return database;
}

}  // namespace sipplab::db
