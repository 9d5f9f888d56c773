// Texts that the build puts into the libraries: see cmake/embed.cmake.
#pragma once

#include <span>
#include <string_view>

namespace sipplab::db {

struct EmbeddedText {
  std::string_view name;  ///< of its file, without the suffix
  std::string_view text;
};

}  // namespace sipplab::db
