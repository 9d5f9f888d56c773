// How the pages look: one head for all of them.
#pragma once

#include <string>

namespace sipplab::bench {

/// From the doctype to the opened body, styles included. `title` is escaped.
std::string page_head(const std::string& title);

}  // namespace sipplab::bench
