#include "bench/present/html_table.hpp"

#include <fmt/core.h>

#include "planner/io/text.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {
namespace {

std::string element(const char* tag, const HtmlCell& cell, char kind) {
  std::string style = kind == 'n' ? "n" : kind == 'w' ? "wrap" : "";
  if (!cell.style.empty()) style += (style.empty() ? "" : " ") + cell.style;
  return fmt::format("<{0}{1}>{2}</{0}>", tag, style.empty() ? "" : " class=\"" + style + "\"",
                     xml_escaped(cell.text));
}

}  // namespace

std::string html_table(const std::vector<std::string>& heading,
                       const std::vector<std::vector<HtmlCell>>& rows, std::string_view kinds) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t i = 0; i < heading.size(); ++i) {
    html += element("th", {heading[i]}, kinds.at(i) == 'n' ? 'n' : 't');
  }
  html += "</tr></thead><tbody>\n";
  for (const std::vector<HtmlCell>& row : rows) {
    PLANNER_ASSERT(row.size() == heading.size());
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += element("td", row[i], kinds.at(i));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace sipplab::bench
