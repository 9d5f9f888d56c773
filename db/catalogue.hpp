// The public views in words, taken from schema.md when the program is built.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "db/embedded_text.hpp"

namespace sipplab::db {

struct ViewDescription {
  std::string name;
  std::string since;    ///< schema version: "Since version 3"
  std::string purpose;  ///< first sentence
  std::string example;  ///< a query; `:run` and `:other` stand for UUIDs
};

/// In the order of schema.md.
const std::vector<ViewDescription>& view_catalogue();

/// The whole of schema.md, as the one text.
std::span<const EmbeddedText> schema_document();

}  // namespace sipplab::db
