// JSON documents as this project prints them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sipplab::db {

/// Indented, with a line break at the end. Bytes that are not UTF-8 are replaced.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace sipplab::db
