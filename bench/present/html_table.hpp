// The one form of tables on pages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sipplab::bench {

struct HtmlCell {
  std::string text;        ///< as it is to be read: what HTML would take for its own is escaped
  std::string style = {};  ///< class: "good", "bad"
};

/// `kinds` has a letter for each column: t text, n number, w text that wraps.
/// REQUIRES: every row has as many cells as the heading and the kinds.
std::string html_table(const std::vector<std::string>& heading,
                       const std::vector<std::vector<HtmlCell>>& rows, std::string_view kinds);

}  // namespace sipplab::bench
