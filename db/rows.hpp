// Rows that name things (commits, machines, builds, cases, instances): each is
// written once and found again by its identity. Internal to db/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "db/error.hpp"
#include "db/records.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/statement.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// Integers in SQLite are signed: counts beyond 2^63 - 1 mean "no limit" and stay
/// there; hashes and seeds keep their 64 bits, so that a large one reads as negative.
std::int64_t to_count(std::uint64_t value);
std::int64_t to_bits(std::uint64_t value);

/// An empty text is absent.
std::optional<std::string> null_if_empty(const std::string& text);
/// A number that may be absent.
Value value_of(const sqlite::Statement& row, int column, bool real);

/// The key of the row, which is written if it is missing. To be called within a
/// write transaction.
Result<std::int64_t> commit_id(sqlite::Connection& connection, const CommitInfo& commit);
Result<std::int64_t> machine_id(sqlite::Connection& connection, const MachineInfo& machine);
Result<std::int64_t> build_id(sqlite::Connection& connection, const BuildInfo& build);
Result<std::optional<std::int64_t>> commit_id(sqlite::Connection& connection,
                                              const std::optional<CommitInfo>& commit);
Result<std::int64_t> case_id(sqlite::Connection& connection, const CaseInfo& parameters);

/// Where something that is recorded comes from.
struct OriginKeys {
  std::optional<std::int64_t> commit;  ///< none outside a checkout
  std::int64_t machine = 0;
  std::int64_t build = 0;
};
Result<OriginKeys> origin_keys(sqlite::Connection& connection, const std::optional<CommitInfo>& commit,
                               const MachineInfo& machine, const BuildInfo& build);

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

/// The columns of case_ that read_case expects, in its order; `case_` must be in FROM.
inline constexpr const char* kCaseColumns =
    "case_.environment, case_.map_spec, case_.instance_set, case_.robots, case_.ssi_s, case_.planner, "
    "case_.initial_order, case_.reschedule, case_.any_angle, case_.connectedness, case_.radius_cells, "
    "case_.speed_cells_per_s, case_.time_limit_s, case_.max_expansions, case_.max_restarts, case_.seed";
CaseInfo read_case(const sqlite::Statement& row, int column);

}  // namespace sipplab::db
