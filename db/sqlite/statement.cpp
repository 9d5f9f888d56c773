// Prepared statements over the C interface.
#include "db/sqlite/statement.hpp"

#include <sqlite3.h>

#include "db/sqlite/handle.hpp"

namespace sipplab::db::sqlite {

void Statement::GiveBack::operator()(sqlite3_stmt* statement) const { handle->idle.give_back(statement); }

Statement::Statement(Handle* handle, sqlite3_stmt* statement, std::string doing)
    : handle_(handle), statement_(statement, GiveBack{handle}), doing_(std::move(doing)) {}

Result<Statement> Statement::prepare(Connection& connection, std::string_view sql, std::string_view doing) {
  Handle& handle = connection.handle();
  sqlite3_stmt* statement = handle.idle.take(sql);
  if (statement != nullptr) return Statement{&handle, statement, std::string{doing}};
  // Preparing reads the schema, and so may meet a lock.
  const int code = retry_while_busy(handle, [&] {
    return sqlite3_prepare_v3(handle.db, sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT,
                              &statement, nullptr);
  });
  if (code != SQLITE_OK) return Unexpected{describe(handle, code, doing)};
  return Statement{&handle, statement, std::string{doing}};
}

Result<bool> Statement::step() {
  // Only a first step can be tried again: later ones stand in the middle of a result.
  const bool may_retry = sqlite3_stmt_busy(statement_.get()) == 0;
  int code = sqlite3_step(statement_.get());
  if (may_retry && is_busy(code)) {
    code = retry_while_busy(*handle_, [&] {
      sqlite3_reset(statement_.get());
      return sqlite3_step(statement_.get());
    });
  }
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const Error error = describe(*handle_, code, doing_);
  reset();
  return Unexpected{error};
}

Result<Done> Statement::run() {
  for (;;) {
    const auto row = SIPPLAB_TRY(step());
    if (!row) break;
  }
  reset();
  return Done{};
}

// A reset repeats the error of the step before it, which was reported there.
void Statement::reset() { sqlite3_reset(statement_.get()); }

int Statement::column(std::string_view name) const {
  const int count = sqlite3_column_count(statement_.get());
  int column = 0;
  while (column < count && name != sqlite3_column_name(statement_.get(), column)) ++column;
  PLANNER_ASSERT(column < count);
  return column;
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_text(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes == nullptr ? std::string{} : std::string{static_cast<const char*>(bytes), size};
}

std::optional<double> Statement::optional_real(int column) const {
  if (is_null(column)) return std::nullopt;
  return real(column);
}

std::optional<std::string> Statement::optional_text(int column) const {
  if (is_null(column)) return std::nullopt;
  return text(column);
}

void Statement::bind_one(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), index, value);
}

void Statement::bind_one(int index, double value) { sqlite3_bind_double(statement_.get(), index, value); }

void Statement::bind_one(int index, std::string_view value) {
  // A null pointer would bind NULL.
  const char* bytes = value.data() == nullptr ? "" : value.data();
  sqlite3_bind_text64(statement_.get(), index, bytes, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

void Statement::bind_one(int index, Bytes value) {
  sqlite3_bind_blob64(statement_.get(), index, value.bytes.data() == nullptr ? "" : value.bytes.data(),
                      value.bytes.size(), SQLITE_TRANSIENT);
}

void Statement::bind_one(int index, std::nullopt_t) { sqlite3_bind_null(statement_.get(), index); }

}  // namespace sipplab::db::sqlite
