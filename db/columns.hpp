// Rows of structs that name their columns once, written and read by these names. `each` is a
// function that calls its argument with the name and the member of each column in turn.
// Internal to db/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "db/column_tags.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"
#include "db/sqlite/statement.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// An empty text is absent.
std::optional<std::string> null_if_empty(const std::string& text);

namespace detail {

template <class T>
const T& to_sql(const T& value) {
  return value;
}
/// Seeds keep their 64 bits, so that a large one reads as negative.
inline std::int64_t to_sql(std::uint64_t value) { return static_cast<std::int64_t>(value); }
template <class Text>
std::optional<std::string> to_sql(const MaybeEmpty<Text>& value) {
  return null_if_empty(value.text);
}

template <class Text>
sqlite::Bytes to_sql(const AsBlob<Text>& value) {
  return {value.text};
}

template <class T>
void bind(sqlite::Statement& statement, int index, const T& value) {
  statement.bind_at(index, to_sql(value));
}
/// A number or a text; of a blob, which no parameter has, NULL.
void bind(sqlite::Statement& statement, int index, const Value& value);

inline void from_sql(const sqlite::Statement& row, int column, std::string& value) {
  value = row.text(column);
}
inline void from_sql(const sqlite::Statement& row, int column, std::int64_t& value) {
  value = row.integer(column);
}
inline void from_sql(const sqlite::Statement& row, int column, std::uint64_t& value) {
  value = static_cast<std::uint64_t>(row.integer(column));
}
inline void from_sql(const sqlite::Statement& row, int column, double& value) { value = row.real(column); }
inline void from_sql(const sqlite::Statement& row, int column, bool& value) {
  value = row.integer(column) != 0;
}
template <class T>
void from_sql(const sqlite::Statement& row, int column, std::optional<T>& value) {
  value.reset();
  if (!row.is_null(column)) from_sql(row, column, value.emplace());
}
inline void from_sql(const sqlite::Statement& row, int column, const MaybeEmpty<std::string>& value) {
  value.text = row.optional_text(column).value_or("");
}

inline void from_sql(const sqlite::Statement& row, int column, const AsBlob<std::string>& value) {
  value.text = row.text(column);
}

inline Value to_value(const Value& value) { return value; }
inline Value to_value(std::int64_t value) { return value; }
inline Value to_value(double value) { return value; }
inline Value to_value(bool value) { return std::int64_t{value ? 1 : 0}; }
inline Value to_value(const std::string& value) { return value; }
template <class T>
Value to_value(const std::optional<T>& value) {
  return value ? to_value(*value) : Value{Null{}};
}

}  // namespace detail

/// Names with ", " between.
template <class Each>
std::string column_names(const Each& each) {
  std::string names;
  each([&names](std::string_view name, const auto&) { (names += names.empty() ? "" : ", ") += name; });
  return names;
}

/// "INSERT INTO TABLE (...) VALUES (?, ...)" with a place for each column.
template <class Each>
std::string insert_sql(const std::string& table, const Each& each) {
  std::string places;
  each([&places](std::string_view, const auto&) { places += places.empty() ? "?" : ", ?"; });
  return "INSERT INTO " + table + " (" + column_names(each) + ") VALUES (" + places + ")";
}

/// Binds the value of each column to its place.
template <class Each>
sqlite::Statement& bind_row(sqlite::Statement& insert, const Each& each) {
  int index = 0;
  each([&insert, &index](std::string_view, const auto& value) { detail::bind(insert, ++index, value); });
  return insert;
}

/// Writes one row; gives its rowid.
template <class Each>
Result<std::int64_t> insert_row(sqlite::Connection& connection, const std::string& table,
                                std::string_view doing, const Each& each) {
  auto insert = SIPPLAB_TRY(sqlite::Statement::prepare(connection, insert_sql(table, each), doing));
  SIPPLAB_TRY(bind_row(insert, each).run());
  return connection.last_insert_rowid();
}

/// Reads each member from the column of its name in the current row.
template <class Each>
void read_row(const sqlite::Statement& row, const Each& each) {
  each([&row](std::string_view name, auto&& value) { detail::from_sql(row, row.column(name), value); });
}

/// Rows with `columns(row, visit)` as a table with these columns.
template <class Row>
Table table_of(const std::vector<Row>& rows) {
  Table table;
  Row::columns(Row{}, [&table](std::string_view name, const auto&) { table.columns.emplace_back(name); });
  for (const Row& row : rows) {
    std::vector<Value>& values = table.rows.emplace_back();
    Row::columns(
        row, [&values](std::string_view, const auto& value) { values.push_back(detail::to_value(value)); });
  }
  return table;
}

}  // namespace sipplab::db
