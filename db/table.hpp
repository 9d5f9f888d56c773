// Typed rows under named columns, and the three forms in which users read them.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sipplab::db {

struct Null {
  friend auto operator<=>(Null, Null) = default;
};
struct Blob {
  std::string bytes;
  friend auto operator<=>(const Blob&, const Blob&) = default;
};
/// One of SQLite's five storage classes. A REAL may be infinite, never NaN.
using Value = std::variant<Null, std::int64_t, double, std::string, Blob>;

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;  ///< each as long as `columns`
};

enum class OutputFormat { kTable, kCsv, kJson };
/// "table", "csv", "json".
std::optional<OutputFormat> parse_output_format(std::string_view text);

/// Aligned columns for a person: numbers to the right, NULL spelled out, control
/// characters escaped, values exact (shortest text that reads back as the same number).
std::string format_aligned(const Table& table);

/// RFC 4180: a header line, CRLF, quotes where needed. NULL is an empty field, an
/// empty text is "", infinity is inf, a blob is hexadecimal.
std::string format_csv(const Table& table);

/// An array of objects, one per row. JSON has no infinity: it becomes the string
/// "inf" or "-inf", which --ssi reads as well. A blob is a hexadecimal string;
/// columns of one name get :1, :2 appended, as SQLite does in views.
std::string format_json(const Table& table);

std::string format(const Table& table, OutputFormat format);

}  // namespace sipplab::db
