#include "bench/judge/text_table.hpp"

#include <algorithm>

#include "db/aligned.hpp"

namespace sipplab::bench {

std::string terminal_table(const std::vector<TextRow>& rows, std::size_t left) {
  if (rows.empty()) return "";
  std::vector<bool> to_the_right(rows.front().size(), true);
  std::fill_n(to_the_right.begin(), std::min(left, to_the_right.size()), false);
  return db::align(rows.front(), {rows.begin() + 1, rows.end()}, to_the_right);
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

}  // namespace sipplab::bench
