// What is kept of one property run, and the log: a text file with one JSON object in
// each line. Programs that run at once may append to one file.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace sipplab {

/// Names of members are the keys of the JSON object.
struct PropertyRecord {
  std::string uuid;  ///< a line that is recorded twice is stored once
  std::string started_utc;
  std::string room;  ///< the program, without "property_"
  std::string title;
  std::uint64_t seed = 0;
  int max_success = 0;  ///< cases that were asked for
  /// "started", then, in a second line with the same UUID, "passed", "failed" or "gave_up"
  /// (too many discards). A run of which there is no second line has crashed.
  std::string status;
  std::int64_t cases = 0;     ///< tested, the failing one included
  std::int64_t discards = 0;  ///< drawn, but the property says nothing about them
  std::int64_t shrinks = 0;   ///< steps from the first counterexample to the smallest
  std::int64_t shrink_tries = 0;
  std::int64_t wall_time_ns = 0;
  std::map<std::string, std::int64_t> classes;  ///< name to cases in it

  // Of a failure; else empty.
  std::string message;         ///< what did not hold, or why it gave up
  std::string reproduce;       ///< value of RC_PARAMS that leads to the counterexample
  std::string counterexample;  ///< everything that was drawn, as rapidcheck prints it
  std::string plan_case;       ///< in the text of case_codec.hpp, where there is one
  std::optional<std::size_t> case_robots;
  std::optional<std::size_t> case_cells;
};

/// "2026-01-31T12:00:00.123Z".
std::string utc_text(std::chrono::system_clock::time_point time);

/// A random UUID (version 4).
std::string new_property_uuid();

/// One line, with its line break.
std::string to_json_line(const PropertyRecord& record);

/// Appends the line, which ends with its line break, in one piece. An error is one line
/// for a person.
std::optional<std::string> append_to_log(const std::string& path, const std::string& line);
std::optional<std::string> append_to_log(const std::string& path, const PropertyRecord& record);

}  // namespace sipplab
