// A connection to one SQLite file that is closed when it goes out of scope, and
// that waits for other processes instead of failing.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "db/sqlite/error.hpp"

struct sqlite3;

namespace sipplab::db::sqlite {

/// Wall-clock time for which a lock is awaited. Writers hold it for milliseconds
/// (one case), so a minute means that a program forgot to end a transaction.
inline constexpr std::chrono::seconds kBusyTimeout{60};

/// The name by which such a connection, or ATTACH, opens a file on read-only media.
std::string immutable_uri(const std::string& path);

enum class OpenMode {
  kReadWrite,  ///< the file is made if it is missing
  kReadOnly,
  kImmutable,  ///< read-only media: no locks, no files next to the database
};

/// The open file and what an error message needs to know of it. Its address stays
/// the same when the Connection moves.
struct Handle;

class Connection {
 public:
  /// Opens the file; nothing is read from it yet.
  static Result<Connection> open(const std::filesystem::path& path, OpenMode mode);
  /// An empty database without a file.
  static Result<Connection> open_in_memory();

  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&& other) noexcept;
  ~Connection();

  /// Runs statements and drops their rows. `doing` completes "while ..." in an
  /// error message. Waits while the file is locked; REQUIRES, for the wait to be
  /// sound, that a first statement outside a transaction stands alone.
  Result<Done> execute(const std::string& sql, std::string_view doing);

  /// Attaches a copy in memory of what `other` holds, to be read.
  Result<Done> attach_copy(const Connection& other, const char* schema, std::string_view doing);

  /// First column of the first row of a query; an error if there is no row.
  Result<std::int64_t> query_int(const std::string& sql, std::string_view doing);
  Result<std::string> query_text(const std::string& sql, std::string_view doing);

  std::int64_t last_insert_rowid() const;
  /// Rows changed by the last INSERT, UPDATE or DELETE.
  std::int64_t changes() const;

  Handle& handle() const { return *handle_; }
  sqlite3* raw() const;
  /// The path as it was given, for messages.
  const std::string& name() const;

 private:
  explicit Connection(std::unique_ptr<Handle> handle);
  /// `target` as SQLite takes it, `name` for messages.
  static Result<Connection> open(const std::string& target, const std::string& name, int flags);

  std::unique_ptr<Handle> handle_;
};

}  // namespace sipplab::db::sqlite
