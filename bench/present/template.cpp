#include "bench/present/template.hpp"

#include <algorithm>

#include "planner/io/text.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

namespace {

using Fields = std::map<std::string, std::string, std::less<>>;

std::string filled(std::string_view text, const Fields& fields) {
  std::string out;
  for (std::size_t open = text.find("{{"); open != std::string_view::npos; open = text.find("{{")) {
    const std::size_t close = text.find("}}", open);
    const auto field = fields.find(text.substr(open + 2, close - open - 2));
    PLANNER_ASSERT(close != std::string_view::npos && field != fields.end());
    out += text.substr(0, open);
    out += field->second;
    text.remove_prefix(close + 2);
  }
  out += text;
  return out;
}

std::string_view template_called(std::string_view name) {
  const std::span<const db::EmbeddedText> templates = page_templates();
  const auto found =
      std::find_if(templates.begin(), templates.end(), [&](const auto& page) { return page.name == name; });
  PLANNER_ASSERT(found != templates.end());
  return found->text;
}

}  // namespace

std::string filled_page(std::string_view name, const std::string& title, const Fields& fields) {
  return filled(template_called("page"),
                {{"title", xml_escaped(title)}, {"body", filled(template_called(name), fields)}});
}

}  // namespace sipplab::bench
