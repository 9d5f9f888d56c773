// HTML pages from the templates of this folder, which the build embeds.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace sipplab::bench {

/// page.html, report.html, reproduction.html and solvers.html.
std::string_view page_template();
std::string_view report_template();
std::string_view reproduction_template();
std::string_view solvers_template();

/// The template with each {{name}} replaced by the field of that name, in page.html, which has the styles: a
/// page that needs nothing else. Fields are HTML; the title is a text. REQUIRES: a field for each name.
std::string filled_page(std::string_view body, const std::string& title,
                        const std::map<std::string, std::string, std::less<>>& fields);

}  // namespace sipplab::bench
