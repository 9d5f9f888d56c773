#include "bench/present/template.hpp"

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

}  // namespace

std::string filled_page(std::string_view body, const std::string& title, const Fields& fields) {
  return filled(page_template(), {{"title", xml_escaped(title)}, {"body", filled(body, fields)}});
}

}  // namespace sipplab::bench
