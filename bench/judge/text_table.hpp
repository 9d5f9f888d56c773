// Tables of reports, for a terminal or as Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sipplab::bench {

using TextRow = std::vector<std::string>;

/// The first row is the heading. The first `left` columns are aligned to the left.
std::string terminal_table(const std::vector<TextRow>& rows, std::size_t left);
std::string markdown_table(const std::vector<TextRow>& rows, std::size_t left);

}  // namespace sipplab::bench
