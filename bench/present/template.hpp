// HTML pages from the templates of this folder, which the build embeds.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "db/embedded_text.hpp"

namespace sipplab::bench {

/// The files of this folder, by name without ".html".
std::span<const db::EmbeddedText> page_templates();

/// The template of this name with each {{name}} replaced by the field of that name, in page.html, which has
/// the styles: a page that needs nothing else. Fields are HTML; the title is a text. REQUIRES: there is such
/// a template, and a field for each name in it.
std::string filled_page(std::string_view name, const std::string& title,
                        const std::map<std::string, std::string, std::less<>>& fields);

}  // namespace sipplab::bench
