// The log of property runs: a text file with one JSON object in
// each line. Programs that run at once may append to one file.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "db/property_run.hpp"

namespace sipplab {

/// "2026-01-31T12:00:00.123Z".
std::string utc_text(std::chrono::system_clock::time_point time);

/// A random UUID (version 4).
std::string new_property_uuid();

/// One line, with its line break.
std::string to_json_line(const db::PropertyRun& run);

/// Appends the line, which ends with its line break, in one piece. An error is one line
/// for a person.
std::optional<std::string> append_to_log(const std::string& path, const std::string& line);
std::optional<std::string> append_to_log(const std::string& path, const db::PropertyRun& run);

}  // namespace sipplab
