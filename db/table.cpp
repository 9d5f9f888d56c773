// Tables as aligned text, CSV and JSON.
#include "db/table.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "db/aligned.hpp"
#include "db/json_text.hpp"

namespace sipplab::db {
namespace {

using Json = nlohmann::ordered_json;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

// Shortest text that reads back as the same number; infinity as users type it.
std::string real_text(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{}", value);
}

std::string hexadecimal(const std::string& bytes) {
  std::string text;
  for (const char c : bytes)
    text += fmt::format("{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return text;
}

std::string shown(const Value& value) {
  return std::visit(Overloaded{[](Null) -> std::string { return "NULL"; },
                               [](std::int64_t integer) { return fmt::format("{}", integer); },
                               [](double real) { return real_text(real); },
                               [](const std::string& text) { return escaped(text); },
                               [](const Blob& blob) { return "x'" + hexadecimal(blob.bytes) + "'"; }},
                    value);
}

bool is_number(const Value& value) {
  return std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value);
}

std::string csv_field(const std::string& text) {
  if (!text.empty() && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_value(const Value& value) {
  return std::visit(Overloaded{[](Null) { return std::string{}; },
                               [](std::int64_t integer) { return fmt::format("{}", integer); },
                               [](double real) { return real_text(real); },
                               [](const std::string& text) { return csv_field(text); },
                               [](const Blob& blob) { return hexadecimal(blob.bytes); }},
                    value);
}

Json json_value(const Value& value) {
  return std::visit(
      Overloaded{[](Null) { return Json(nullptr); }, [](std::int64_t integer) { return Json(integer); },
                 [](double real) { return std::isinf(real) ? Json(real_text(real)) : Json(real); },
                 [](const std::string& text) { return Json(text); },
                 [](const Blob& blob) { return Json(hexadecimal(blob.bytes)); }},
      value);
}

std::vector<std::string> unique_names(const std::vector<std::string>& columns) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const std::string& column : columns) {
    std::string candidate = column;
    for (int i = 1; !taken.insert(candidate).second; ++i) candidate = fmt::format("{}:{}", column, i);
    names.push_back(candidate);
  }
  return names;
}

}  // namespace

std::optional<OutputFormat> parse_output_format(std::string_view text) {
  if (text == "table") return OutputFormat::kTable;
  if (text == "csv") return OutputFormat::kCsv;
  if (text == "json") return OutputFormat::kJson;
  return std::nullopt;
}

std::string format_aligned(const Table& table) {
  std::vector<std::string> heading;
  std::vector<bool> to_the_right;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    heading.push_back(escaped(table.columns[i]));
    bool numbers = false;
    bool others = false;
    for (const auto& row : table.rows) {
      const bool null = std::holds_alternative<Null>(row[i]);
      numbers = numbers || is_number(row[i]);
      others = others || !(null || is_number(row[i]));
    }
    to_the_right.push_back(numbers && !others);
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (const Value& value : row) rows.back().push_back(shown(value));
  }
  return align(heading, rows, to_the_right);
}

std::string format_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text += ',';
    text += csv_field(table.columns[i]);
  }
  text += "\r\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      text += csv_value(row[i]);
    }
    text += "\r\n";
  }
  return text;
}

std::string format_json(const Table& table) {
  const std::vector<std::string> names = unique_names(table.columns);
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[names[i]] = json_value(row[i]);
    rows.push_back(std::move(object));
  }
  // Text that is not UTF-8 is shown with replacement characters.
  return json_text(rows);
}

std::string format(const Table& table, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable:
      return format_aligned(table);
    case OutputFormat::kCsv:
      return format_csv(table);
    case OutputFormat::kJson:
      return format_json(table);
  }
  return {};
}

}  // namespace sipplab::db
