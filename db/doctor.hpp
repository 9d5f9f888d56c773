// Whether a history is sound: what is wrong, and what to do about it.
#pragma once

#include <string>
#include <vector>

#include "db/database.hpp"

namespace sipplab::db {

struct DoctorFinding {
  std::string check;     ///< one of those in DoctorReport::checks
  std::string what;      ///< one line
  std::string advice;    ///< what the user can do
  bool fixable = false;  ///< examine(..., fix) sets it right without losing anything
  bool fixed = false;
};

struct DoctorReport {
  std::vector<std::string> checks;  ///< that were made
  std::vector<DoctorFinding> findings;

  bool sound() const;  ///< no finding is left that was not fixed
};

struct DoctorOptions {
  /// Leaves out what reads every result: the whole of the integrity check, stale summaries.
  bool quick = false;
  /// Sets right what can be without losing anything. REQUIRES: open for writing.
  bool fix = false;
};

/// What SQLite reports while it looks is a finding, too.
DoctorReport examine(Database& database, const DoctorOptions& options);

}  // namespace sipplab::db
