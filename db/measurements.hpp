// Runs of other benchmark programs: recorded whole.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// Names and units are those of the table measurement.
struct Measurement {
  std::string benchmark;
  std::int64_t repetition = 0;
  std::int64_t iterations = 0;
  std::optional<double> real_time_ns;
  std::optional<double> cpu_time_ns;
  std::string error;  ///< empty: it ran
  std::vector<std::pair<std::string, double>> counters;
  /// Of repetitions that are not known one by one: "median" or "mean"; empty: one repetition.
  std::string aggregate = "";
  std::int64_t threads = 1;
  std::string label = "";
};

struct MeasurementRun {
  std::string uuid;  ///< made of the content, so that a report that is imported twice is stored once
  std::string started_utc;
  RunInfo info;
  std::vector<Measurement> measurements;
};

struct MeasurementsRecorded {
  bool known = false;  ///< was there already; nothing was written
};

/// All or nothing.
Result<MeasurementsRecorded> record_measurements(Database& database, const MeasurementRun& run);

}  // namespace sipplab::db
