// A prepared statement that goes back to its connection when it goes out of scope.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"

struct sqlite3_stmt;

namespace sipplab::db::sqlite {

/// To be kept as a blob.
struct Bytes {
  std::string_view bytes;
};

/// Usage: bind, step until it says false, reset. Columns count from 0; a column is
/// readable until the next step or reset.
class Statement {
 public:
  /// `doing` completes "while ..." in the messages of this statement. The
  /// connection must outlive it.
  static Result<Statement> prepare(Connection& connection, std::string_view sql, std::string_view doing);
  /// With the values bound to its parameters.
  template <class... Values>
  static Result<Statement> prepare(Connection& connection, std::string_view sql, std::string_view doing,
                                   const Values&... values) {
    Statement statement = SIPPLAB_TRY(prepare(connection, sql, doing));
    statement.bind(values...);
    return statement;
  }

  /// Binds the values to parameters ?1, ?2, ... in turn. Text is copied.
  template <class... Values>
  Statement& bind(const Values&... values) {
    int index = 0;
    (bind_one(++index, values), ...);
    return *this;
  }
  /// Binds one value to parameter ?index.
  template <class Value>
  void bind_at(int index, const Value& value) {
    bind_one(index, value);
  }

  /// True when a row is there, false at the end.
  Result<bool> step();
  /// Calls `each` in every row that is left.
  template <class Each>
  Result<Done> for_each(Each each) {
    for (;;) {
      const auto row = SIPPLAB_TRY(step());
      if (!row) return Done{};
      each();
    }
  }
  /// What `read` makes of every row that is left.
  template <class Read>
  auto collect(Read read) -> Result<std::vector<decltype(read(*this))>> {
    std::vector<decltype(read(*this))> rows;
    SIPPLAB_TRY(for_each([&] { rows.push_back(read(*this)); }));
    return rows;
  }
  /// Runs to the end and resets, so that the statement can be bound again.
  Result<Done> run();
  void reset();

  /// The column of that name. REQUIRES: the statement has one.
  int column(std::string_view name) const;
  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  std::optional<double> optional_real(int column) const;
  std::optional<std::string> optional_text(int column) const;

  sqlite3_stmt* raw() const { return statement_.get(); }

 private:
  struct GiveBack {
    Handle* handle;
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(Handle* handle, sqlite3_stmt* statement, std::string doing);

  void bind_one(int index, std::int64_t value);
  void bind_one(int index, int value) { bind_one(index, static_cast<std::int64_t>(value)); }
  void bind_one(int index, bool value) { bind_one(index, static_cast<std::int64_t>(value)); }
  void bind_one(int index, double value);
  void bind_one(int index, std::string_view value);
  void bind_one(int index, const std::string& value) { bind_one(index, std::string_view{value}); }
  void bind_one(int index, const char* value) { bind_one(index, std::string_view{value}); }
  void bind_one(int index, Bytes value);
  void bind_one(int index, std::nullopt_t);
  template <class T>
  void bind_one(int index, const std::optional<T>& value) {
    if (value) {
      bind_one(index, *value);
    } else {
      bind_one(index, std::nullopt);
    }
  }

  Handle* handle_;
  std::unique_ptr<sqlite3_stmt, GiveBack> statement_;
  std::string doing_;
};

/// Runs a statement that returns no rows.
template <class... Values>
Result<Done> run(Connection& connection, std::string_view sql, std::string_view doing,
                 const Values&... values) {
  return SIPPLAB_TRY(Statement::prepare(connection, sql, doing, values...)).run();
}

}  // namespace sipplab::db::sqlite
