// Rows that name things (commits, machines, builds, cases, instances): each is
// written once and found again by its identity. Internal to db/.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "db/columns.hpp"
#include "db/records.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"
#include "db/sqlite/statement.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// Integers in SQLite are signed: counts beyond 2^63 - 1 mean "no limit" and stay
/// there; hashes and seeds keep their 64 bits, so that a large one reads as negative.
std::int64_t to_count(std::uint64_t value);
std::int64_t to_bits(std::uint64_t value);

/// LIMIT of SQL: 0 sets none.
inline std::int64_t sql_limit(std::size_t limit) {
  return limit == 0 ? -1 : static_cast<std::int64_t>(limit);
}
/// The value of a column in the current row.
Value value_of(sqlite3_stmt* row, int column);
/// All rows that are left, under the names of their columns.
Result<Table> rest_of(sqlite::Statement statement);

/// The key of the row, which is written if it is missing. To be called within a
/// write transaction.
Result<std::int64_t> commit_id(sqlite::Connection& connection, const CommitInfo& commit);
Result<std::int64_t> machine_id(sqlite::Connection& connection, const MachineInfo& machine);
Result<std::int64_t> build_id(sqlite::Connection& connection, const BuildInfo& build);
Result<std::optional<std::int64_t>> commit_id(sqlite::Connection& connection,
                                              const std::optional<CommitInfo>& commit);
Result<std::int64_t> case_id(sqlite::Connection& connection, const CaseInfo& parameters);
/// The columns of case_; an option that has none is a member of the JSON object in `options`.
Result<std::set<std::string>> case_columns(sqlite::Connection& connection);

/// What all runs have, whatever their kind: the columns of the table run.
struct RunRow {
  std::string uuid;
  std::string kind;   ///< "sweep", "report", "property", "fuzz", "gate"
  std::string suite;  ///< what ran: a suite, the folder of a property, the target of fuzzing
  std::string started_utc;
  std::optional<std::int64_t> wall_time_ns;  ///< none: it is still running
  std::string outcome;                       ///< of a kind that has results, not cases
  std::uint64_t seed = 0;
  // Of sweeps.
  double time_limit_s = kNoTimeLimit;
  std::string shard;
  std::string command_line;
  std::string options;
  std::string writer;
};

/// The row of a run that is over, of a kind whose struct has the same names.
template <class Run>
RunRow finished_run(const char* kind, const std::string& suite, const std::string& outcome, const Run& run) {
  RunRow row;
  row.uuid = run.uuid;
  row.kind = kind;
  row.suite = suite;
  row.started_utc = run.started_utc;
  row.wall_time_ns = run.wall_time_ns;
  row.outcome = outcome;
  row.seed = run.seed;
  return row;
}

/// Lists a run; gives its key. None if the history has one of that UUID: nothing is written then. To
/// be called within a write transaction, as the rows of its kind are.
Result<std::optional<std::int64_t>> insert_run(sqlite::Connection& connection, const RunOrigin& origin,
                                               const RunRow& run);

/// The same for instances, of which a case has hundreds: the statements are prepared
/// once, and an instance that is known costs no write.
class InstanceKeys {
 public:
  static Result<InstanceKeys> prepare(sqlite::Connection& connection);
  Result<std::int64_t> key(const InstanceInfo& instance);

 private:
  InstanceKeys(sqlite::Connection* connection, sqlite::Statement select, sqlite::Statement insert)
      : connection_(connection), select_(std::move(select)), insert_(std::move(insert)) {}

  sqlite::Connection* connection_;
  sqlite::Statement select_;
  sqlite::Statement insert_;
};

/// The columns of case_ by their names, the options from `column` on: SELECT ..., case_.*.
CaseInfo read_case(const sqlite::Statement& row, int column);

}  // namespace sipplab::db
