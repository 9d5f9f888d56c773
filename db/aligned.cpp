// Text in columns, by Unicode code points.
#include "db/aligned.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace sipplab::db {
namespace {

// Bytes that do not continue a code point of UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n') {
      shown += "\\n";
    } else if (c == '\t') {
      shown += "\\t";
    } else if (code < 0x20 || code == 0x7f) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned>(code));
    } else {
      shown += c;
    }
  }
  return shown;
}

std::string align(const std::vector<std::string>& heading, const std::vector<std::vector<std::string>>& rows,
                  const std::vector<bool>& to_the_right) {
  std::vector<std::size_t> widths;
  for (const std::string& column : heading) widths.push_back(width(column));
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text;
  const auto append = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0) line += "  ";
      const std::string padding(widths[i] - width(cells[i]), ' ');
      line += to_the_right[i] ? padding + cells[i] : cells[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  std::vector<std::string> rule;
  for (const std::size_t column_width : widths) rule.emplace_back(column_width, '-');
  append(heading);
  append(rule);
  for (const auto& row : rows) append(row);
  return text;
}

}  // namespace sipplab::db
