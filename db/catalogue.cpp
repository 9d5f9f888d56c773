// Reads the sections of schema.md that describe views.
#include "db/catalogue.hpp"

#include <sstream>

namespace sipplab::db {
namespace {

constexpr std::string_view kHeading = "### `v_";
constexpr std::string_view kCode = "    ";

/// "Since version 3. One row per run. More." -> "Since version 3" and "One row per run".
void split_description(const std::string& text, ViewDescription& view) {
  const std::size_t first = text.find(". ");
  view.since = text.substr(0, text.find(" (") < first ? text.find(" (") : first);
  if (first == std::string::npos) return;
  const std::string rest = text.substr(first + 2);
  const std::size_t end = rest.find(". ");
  view.purpose = rest.substr(0, end == std::string::npos ? rest.find_last_not_of(". ") + 1 : end);
}

ViewDescription read_view(const std::string& heading, std::istream& lines) {
  ViewDescription view;
  view.name = heading.substr(5, heading.rfind('`') - 5);
  std::string description;
  for (std::string line; std::getline(lines, line) && line.rfind("|", 0) != 0;) {
    std::string& text = line.rfind(kCode, 0) == 0 ? view.example : description;
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    if (!text.empty()) text += ' ';
    text.append(line, begin);
  }
  split_description(description, view);
  return view;
}

}  // namespace

const std::vector<ViewDescription>& view_catalogue() {
  static const std::vector<ViewDescription> catalogue = [] {
    std::vector<ViewDescription> views;
    std::istringstream lines{std::string(schema_document().front().text)};
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind(kHeading, 0) == 0) views.push_back(read_view(line, lines));
    }
    return views;
  }();
  return catalogue;
}

}  // namespace sipplab::db
