// A row of a table, read by the names of its columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "db/table.hpp"

namespace sipplab::bench {

/// REQUIRES of all: the table has the column; the text and the integer are what their names say.
class NamedRow {
 public:
  NamedRow(const db::Table& table, const std::vector<db::Value>& row) : table_(table), row_(row) {}

  const db::Value& operator[](std::string_view column) const {
    const auto found = std::find(table_.columns.begin(), table_.columns.end(), column);
    return row_.at(static_cast<std::size_t>(found - table_.columns.begin()));
  }
  const std::string& text(std::string_view column) const { return std::get<std::string>((*this)[column]); }
  std::int64_t integer(std::string_view column) const { return std::get<std::int64_t>((*this)[column]); }
  /// Of an integer, too; 0 for NULL.
  double real(std::string_view column) const {
    const db::Value& value = (*this)[column];
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    const auto* number = std::get_if<double>(&value);
    return number == nullptr ? 0 : *number;
  }

 private:
  const db::Table& table_;
  const std::vector<db::Value>& row_;
};

}  // namespace sipplab::bench
