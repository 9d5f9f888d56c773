// Waiting for locks, and SQLite's error codes in words.
#include "db/sqlite/handle.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <thread>

#include "db/sqlite/connection.hpp"
#include "planner/core/random.hpp"

namespace sipplab::db::sqlite {
namespace {

// A writer needs the lock for about a millisecond per case: the first waits are of
// that size, and none is so long that a free lock goes unnoticed. Random lengths
// keep many writers from waking together.
constexpr int kShortestWaitUs = 500;
constexpr int kLongestWaitUs = 20'000;
constexpr int kDoublings = 6;

// More than recording, the most frequent use, has; a program that asks many questions
// once must not keep them all.
constexpr std::size_t kMostIdleStatements = 64;

bool disk_is_full(const Handle& handle, int code) {
  if ((code & 0xff) == SQLITE_FULL) return true;
  if ((code & 0xff) != SQLITE_IOERR || handle.db == nullptr) return false;
  const int system_error = sqlite3_system_errno(handle.db);
  return system_error == ENOSPC || system_error == EDQUOT;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

IdleStatements::~IdleStatements() {
  for (const auto& [text, statement] : by_text_) sqlite3_finalize(statement);
}

sqlite3_stmt* IdleStatements::take(std::string_view sql) {
  const auto found = by_text_.find(std::string{sql});
  if (found == by_text_.end()) return nullptr;
  sqlite3_stmt* statement = found->second;
  by_text_.erase(found);
  return statement;
}

void IdleStatements::give_back(sqlite3_stmt* statement) {
  if (statement == nullptr) return;
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  const char* text = sqlite3_sql(statement);
  if (text == nullptr || by_text_.size() >= kMostIdleStatements ||
      !by_text_.emplace(text, statement).second) {
    sqlite3_finalize(statement);
  }
}

int wait_for_lock(void* handle, int attempts) {
  auto* waiting = static_cast<Handle*>(handle);
  const auto now = std::chrono::steady_clock::now();
  if (attempts == 0) waiting->wait_began = now;
  if (now - waiting->wait_began > kBusyTimeout) return 0;

  static thread_local Random random{std::random_device{}()};
  const int longest = std::min(kLongestWaitUs, kShortestWaitUs << std::min(attempts + 1, kDoublings));
  const auto more_us = random.below(static_cast<std::uint64_t>(longest - kShortestWaitUs) + 1);
  std::this_thread::sleep_for(std::chrono::microseconds{kShortestWaitUs + static_cast<int>(more_us)});
  return 1;
}

bool is_busy(int code) {
  // SQLITE_PROTOCOL: two processes raced for the first use of the write-ahead log.
  return (code & 0xff) == SQLITE_BUSY || (code & 0xff) == SQLITE_PROTOCOL;
}

Error describe(const Handle& handle, int code, std::string_view doing) {
  const std::string& file = handle.name;
  const std::string reason = handle.db != nullptr ? sqlite3_errmsg(handle.db) : sqlite3_errstr(code);
  if (disk_is_full(handle, code)) {
    return {ErrorKind::kFull,
            fmt::format("{}: no space left while {}, expected room for the database and its -wal file; "
                        "what was committed before is kept",
                        file, doing)};
  }
  if (is_busy(code)) {
    return {ErrorKind::kBusy,
            fmt::format("{}: locked by another process for {} s while {}, expected it to finish", file,
                        kBusyTimeout.count(), doing)};
  }
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      return {ErrorKind::kNotADatabase, fmt::format("{}: not a database, expected a sipplab history", file)};
    case SQLITE_CORRUPT:
      return {ErrorKind::kNotADatabase,
              fmt::format("{}: damaged database ({}), expected a whole one; `sqlite3 FILE .recover` may save "
                          "its rows",
                          file, one_line(reason))};
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
    case SQLITE_IOERR:
      return {ErrorKind::kCannotOpen,
              fmt::format("{}: {} while {}, expected a file and a folder with permission to write", file,
                          one_line(reason), doing)};
    case SQLITE_CONSTRAINT:
    case SQLITE_MISMATCH:
    case SQLITE_TOOBIG:
      return {ErrorKind::kBadInput, fmt::format("{}: {} while {}", file, one_line(reason), doing)};
    default:
      return {ErrorKind::kInternal,
              fmt::format("{}: {} while {} (SQLite error {})", file, one_line(reason), doing, code)};
  }
}

}  // namespace sipplab::db::sqlite
