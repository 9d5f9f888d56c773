// Opening a file, and statements that need no typed rows.
#include "db/sqlite/connection.hpp"

#include <fmt/core.h>
#include <sqlite3.h>

#include "db/sqlite/handle.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db::sqlite {

// SQLite reads %, ? and # in a URI as syntax.
std::string immutable_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02x}", static_cast<unsigned>(c));
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

Connection::Connection(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
Connection::Connection(Connection&& other) noexcept = default;
Connection& Connection::operator=(Connection&& other) noexcept = default;
Connection::~Connection() = default;

Result<Connection> Connection::open(const std::string& target, const std::string& name, int flags) {
  auto handle = std::make_unique<Handle>(name);
  const int code = sqlite3_open_v2(target.c_str(), &handle->db, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) return Unexpected{describe(*handle, code, "opening it")};
  sqlite3_extended_result_codes(handle->db, 1);
  sqlite3_busy_handler(handle->db, wait_for_lock, handle.get());
  return Connection{std::move(handle)};
}

Result<Connection> Connection::open(const std::filesystem::path& path, OpenMode mode) {
  const std::string name = path.string();
  // Names that SQLite takes for something else than a file of that name.
  const bool special = name.rfind("file:", 0) == 0 || name.rfind(':', 0) == 0;
  const std::string target = special ? "./" + name : name;
  switch (mode) {
    case OpenMode::kReadWrite:
      return open(target, name, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_URI);
    case OpenMode::kReadOnly:
      return open(target, name, SQLITE_OPEN_READONLY);
    case OpenMode::kImmutable:
      break;
  }
  return open(immutable_uri(target), name, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
}

Result<Connection> Connection::open_in_memory() {
  return open(":memory:", "a database in memory",
              SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_URI);
}

Result<Done> Connection::execute(const std::string& sql, std::string_view doing) {
  const int code = retry_while_busy(
      *handle_, [&] { return sqlite3_exec(handle_->db, sql.c_str(), nullptr, nullptr, nullptr); });
  if (code != SQLITE_OK) return Unexpected{describe(*handle_, code, doing)};
  return Done{};
}

Result<Done> Connection::attach_copy(const Connection& other, const char* schema, std::string_view doing) {
  SIPPLAB_TRY(execute(fmt::format("ATTACH ':memory:' AS {}", schema), doing));
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(other.raw(), "main", &size, 0);
  const int code = bytes == nullptr ? SQLITE_NOMEM
                                    : sqlite3_deserialize(handle_->db, schema, bytes, size, size,
                                                          SQLITE_DESERIALIZE_FREEONCLOSE);
  if (code == SQLITE_OK) return Done{};
  const Error error{ErrorKind::kInternal,
                    fmt::format("{}: {} while {}", name(), sqlite3_errstr(code), doing)};
  SIPPLAB_TRY(execute(fmt::format("DETACH {}", schema), doing));
  return Unexpected{error};
}

Result<std::int64_t> Connection::query_int(const std::string& sql, std::string_view doing) {
  auto statement = SIPPLAB_TRY(Statement::prepare(*this, sql, doing));
  const auto row = SIPPLAB_TRY(statement.step());
  if (!row) return Unexpected{Error{ErrorKind::kNotFound, name() + ": no row while " + std::string{doing}}};
  return statement.integer(0);
}

Result<std::string> Connection::query_text(const std::string& sql, std::string_view doing) {
  auto statement = SIPPLAB_TRY(Statement::prepare(*this, sql, doing));
  const auto row = SIPPLAB_TRY(statement.step());
  if (!row) return Unexpected{Error{ErrorKind::kNotFound, name() + ": no row while " + std::string{doing}}};
  return statement.text(0);
}

std::int64_t Connection::last_insert_rowid() const { return sqlite3_last_insert_rowid(handle_->db); }
std::int64_t Connection::changes() const { return sqlite3_changes64(handle_->db); }
sqlite3* Connection::raw() const { return handle_->db; }
const std::string& Connection::name() const { return handle_->name; }

}  // namespace sipplab::db::sqlite
