// Text in columns, for all reports.
#pragma once

#include <string>
#include <vector>

namespace sipplab::db {

/// Writes control characters as escapes: a cell must neither break the lines nor
/// speak to the terminal.
std::string escaped(const std::string& text);

/// A heading, a rule, and rows; all rows as long as the heading. `to_the_right`
/// says for each column whether it is aligned to the right.
std::string align(const std::vector<std::string>& heading, const std::vector<std::vector<std::string>>& rows,
                  const std::vector<bool>& to_the_right);

}  // namespace sipplab::db
