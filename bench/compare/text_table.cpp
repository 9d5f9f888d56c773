#include "bench/compare/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sipplab::bench {

std::string terminal_table(const std::vector<TextRow>& rows, std::size_t left) {
  if (rows.empty()) return "";
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const TextRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const TextRow& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line +=
          i < left ? fmt::format("{:<{}}  ", row[i], widths[i]) : fmt::format("{:>{}}  ", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string markdown_table(const std::vector<TextRow>& rows, std::size_t left) {
  if (rows.empty()) return "";
  std::string text;
  for (std::size_t number = 0; number < rows.size(); ++number) {
    for (const std::string& cell : rows[number]) text += "| " + cell + " ";
    text += "|\n";
    if (number > 0) continue;
    for (std::size_t i = 0; i < rows[number].size(); ++i) text += i < left ? "|---" : "|---:";
    text += "|\n";
  }
  return text;
}

std::string percent_slower(double log_ratio) {
  if (!std::isfinite(log_ratio)) return "-";
  return fmt::format("{:+.2f} %", 100 * std::expm1(log_ratio));
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  return fmt::format("{:.1f} %", 100 * share);
}

}  // namespace sipplab::bench
