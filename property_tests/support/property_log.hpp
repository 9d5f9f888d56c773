// The log of property runs: a text file with one JSON object in
// each line. Programs that run at once may append to one file.
#pragma once

#include <optional>
#include <string>

#include "db/property_run.hpp"
#include "db/run_names.hpp"

namespace sipplab {

/// One line, with its line break.
std::string to_json_line(const db::PropertyRun& run);

/// Appends the line, which ends with its line break, in one piece. An error is one line
/// for a person.
std::optional<std::string> append_to_log(const std::string& path, const std::string& line);
std::optional<std::string> append_to_log(const std::string& path, const db::PropertyRun& run);

}  // namespace sipplab
