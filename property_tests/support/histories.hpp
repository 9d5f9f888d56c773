// Histories for rapidcheck: rows of every kind, drawn from small sets so that they meet, and files to put
// them in.
#pragma once

#include <rapidcheck.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/findings.hpp"
#include "db/fuzz_runs.hpp"
#include "db/gate_runs.hpp"
#include "db/measurements.hpp"
#include "db/property_runs.hpp"
#include "db/recorder.hpp"
#include "db/table.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/scratch_folder.hpp"

namespace sipplab::db {

/// The value; what is wrong fails the property.
template <class T>
T must(Result<T> result) {
  if (!result) RC_FAIL(result.error().message);
  return std::move(*result);
}

/// A number from least to most, at every size of rapidcheck.
std::int64_t any_whole(std::int64_t least, std::int64_t most);
bool any_flag();
/// The numbers below `size`, shuffled.
std::vector<std::size_t> any_order(std::size_t size);

using Texts = std::vector<std::string>;

/// Of properties whose histories hold some of everything and are asked everything: few cases.
inline constexpr int kWholeHistories = (kCasesOfHistories + 12) / 13;

/// The first column of the first row.
std::int64_t ask(Database& database, const std::string& sql);
/// All rows.
Table rows_of(Database& database, const std::string& sql);
/// The first column of all rows.
Texts texts_of(Database& database, const std::string& sql);
/// By name.
Texts views_of(Database& database);

/// A folder with an empty history in it: a copy, since making one takes longer than most
/// of what is done to it here.
class NewHistory {
 public:
  NewHistory();
  std::filesystem::path path() const { return folder_.path() / "history.db"; }
  Database open() const { return must(Database::open(path())); }

 private:
  ScratchFolder folder_;
};

// --- things with a name: each number always names the same ---------------------------

CommitInfo commit_number(int number);
MachineInfo machine_number(int number);
/// 2 has uncommitted changes.
BuildInfo build_number(int number);
/// Robots 1, 2, ... on one map; 0 to 3 differ in one option each.
CaseInfo case_number(int number);
InstanceInfo instance_number(int number);
/// "2026-01-01T00:00:0N.000Z"
std::string second_number(int number);

// --- runs ----------------------------------------------------------------------------

RunOrigin any_origin();
/// All that a result can have, with numbers from k/8 and small counts.
ResultRow any_result();

struct Planned {
  CaseInfo parameters;
  InstanceInfo instance;
  ResultRow row;
};
struct Sweep {
  RunInfo info;  ///< with a UUID
  std::vector<Planned> plannings;
  RunStatus status = RunStatus::kFinished;
};
/// Of two suites, some cases, each with some instances, planned once or twice.
Sweep any_sweep();
void record(const std::filesystem::path& file, const Sweep& sweep);

MeasurementRun any_report();
PropertyRun any_property_run();
FuzzRun any_fuzz_run();
GateRun any_gate_run();
Finding any_finding();

/// Some of everything; returns nothing that the file does not say.
void record_some_of_everything(const std::filesystem::path& file);

/// UUIDs of all runs of a file, of every kind, in order of their keys.
std::vector<std::string> all_runs(Database& database);

}  // namespace sipplab::db
