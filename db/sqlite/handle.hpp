// What stands behind a Connection, shared with its statements: the C handle, the
// waiting for locks, and SQLite's error codes in words.
#pragma once

#include <sqlite3.h>

#include <chrono>
#include <string>
#include <string_view>
#include <unordered_map>

#include "db/sqlite/error.hpp"

namespace sipplab::db::sqlite {

/// Prepared statements that are not in use, kept because compiling one takes longer than
/// running it. They are reset, so they hold no lock; SQLite compiles one again by itself
/// when the schema changed.
class IdleStatements {
 public:
  IdleStatements() = default;
  IdleStatements(const IdleStatements&) = delete;
  IdleStatements& operator=(const IdleStatements&) = delete;
  ~IdleStatements();

  /// One of this very text for the caller to own, or null.
  sqlite3_stmt* take(std::string_view sql);
  /// Takes it over: kept while there is room, else finalized.
  void give_back(sqlite3_stmt* statement);

 private:
  std::unordered_map<std::string, sqlite3_stmt*> by_text_;
};

struct Handle {
  explicit Handle(std::string file_name) : name(std::move(file_name)) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { sqlite3_close_v2(db); }  // closes when the last statement is gone

  sqlite3* db = nullptr;
  std::string name;
  std::chrono::steady_clock::time_point wait_began{};
  IdleStatements idle;
};

/// SQLite's busy handler (context: a Handle): sleeps for a random time that grows
/// with the number of attempts; gives up after kBusyTimeout.
int wait_for_lock(void* handle, int attempts);

/// Whether `code` says that another process is in the way.
bool is_busy(int code);

/// Calls `attempt` (which returns an SQLite code) until it is not busy or until
/// kBusyTimeout has passed. SQLite does not ask the busy handler if waiting could
/// be a deadlock: when several processes change a fresh file to WAL, each from a read
/// lock; nor when they race for the first use of the log (SQLITE_PROTOCOL).
template <class Attempt>
int retry_while_busy(Handle& handle, Attempt attempt) {
  const auto began = std::chrono::steady_clock::now();
  int code = attempt();
  for (int attempts = 0; is_busy(code); ++attempts) {
    if (attempts == 0) handle.wait_began = began;
    if (wait_for_lock(&handle, attempts + 1) == 0) break;
    code = attempt();
  }
  return code;
}

/// `code` as one line that names the file; `doing` completes "while ...".
Error describe(const Handle& handle, int code, std::string_view doing);

}  // namespace sipplab::db::sqlite
