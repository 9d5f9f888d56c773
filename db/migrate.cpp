// Schema inspection and migration.
#include "db/migrate.hpp"

#include <fmt/core.h>

#include <charconv>
#include <vector>

#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"
#include "sipplab/error.hpp"

namespace sipplab::db {
namespace {

constexpr std::string_view kReadingHeader = "reading its schema version";

Error not_ours(const sqlite::Connection& connection) {
  return {ErrorKind::kNotADatabase,
          fmt::format("{}: a database of another program, expected a sipplab history", connection.name())};
}

Error newer(const sqlite::Connection& connection, std::int64_t version, int latest) {
  return {ErrorKind::kNewerSchema,
          fmt::format("{}: schema version {}, expected at most {}: a newer sipplab wrote it",
                      connection.name(), version, latest)};
}

Error older(const sqlite::Connection& connection, std::int64_t version, int first) {
  return {
      ErrorKind::kOlderSchema,
      fmt::format("{}: schema version {}, expected at least {}: a sipplab before the first release wrote it",
                  connection.name(), version, first)};
}

Result<Done> check_foreign_keys(sqlite::Connection& connection, const Migration& step) {
  const auto orphans =
      SIPPLAB_TRY(connection.query_int("SELECT count(*) FROM pragma_foreign_key_check", step.name));
  if (orphans == 0) return Done{};
  return Unexpected{
      Error{ErrorKind::kInternal,
            fmt::format("{}: {} rows point to rows that are not there, expected none after migration {}",
                        connection.name(), orphans, step.name)}};
}

Result<Done> apply(sqlite::Connection& connection, const Migration& step) {
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  // Another process may have been faster.
  const auto version = SIPPLAB_TRY(connection.query_int("PRAGMA user_version", kReadingHeader));
  if (version >= step.version) return Done{};

  const std::string doing = fmt::format("applying migration {}", step.name);
  SIPPLAB_TRY(connection.execute(std::string{step.sql}, doing));
  SIPPLAB_TRY(check_foreign_keys(connection, step));
  const std::string header =
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, step.version);
  SIPPLAB_TRY(connection.execute(header, doing));
  return transaction.commit();
}

std::vector<Migration> numbered(std::span<const EmbeddedText> files) {
  std::vector<Migration> steps;
  for (const auto& [name, sql] : files) {
    Migration& step = steps.emplace_back(Migration{0, name, sql});
    std::from_chars(name.data(), name.data() + name.size(), step.version);  // "0009_initial"
    PLANNER_ASSERT(steps.size() < 2 || step.version == steps[steps.size() - 2].version + 1);
  }
  return steps;
}

}  // namespace

std::span<const Migration> migrations() {
  static const std::vector<Migration> steps = numbered(migration_files());
  return steps;
}

Result<SchemaState> inspect(sqlite::Connection& connection, std::span<const Migration> steps) {
  // Most files are up to date: what these two say is set last, and known without reading the schema.
  if (SIPPLAB_TRY(connection.query_int("PRAGMA user_version", kReadingHeader)) == steps.back().version &&
      SIPPLAB_TRY(connection.query_int("PRAGMA application_id", kReadingHeader)) == kApplicationId) {
    return SchemaState{false, steps.back().version};
  }
  // One statement, so that a schema made by another process meanwhile is seen whole.
  auto header = SIPPLAB_TRY(sqlite::Statement::prepare(connection,
                                                       "SELECT application_id, user_version, "
                                                       "(SELECT count(*) FROM sqlite_schema) "
                                                       "FROM pragma_application_id, pragma_user_version",
                                                       kReadingHeader));
  SIPPLAB_TRY(header.step());
  const std::int64_t application = header.integer(0);
  const std::int64_t version = header.integer(1);
  const std::int64_t objects = header.integer(2);

  SchemaState state;
  state.fresh = application == 0 && version == 0 && objects == 0;
  if (!state.fresh && (application != kApplicationId || version < 1)) return Unexpected{not_ours(connection)};
  const int latest = steps.back().version;
  if (version > latest) return Unexpected{newer(connection, version, latest)};
  const int first = steps.front().version;
  if (!state.fresh && version < first) return Unexpected{older(connection, version, first)};
  state.version = static_cast<int>(version);
  return state;
}

Result<Done> migrate(sqlite::Connection& connection, std::span<const Migration> steps) {
  const auto version = SIPPLAB_TRY(connection.query_int("PRAGMA user_version", kReadingHeader));
  if (version >= steps.back().version) return Done{};
  const auto enforced = SIPPLAB_TRY(connection.query_int("PRAGMA foreign_keys", kReadingHeader));
  // A table that others refer to can be dropped and rebuilt only without enforcement, which
  // cannot change within a transaction. Each step checks its result instead.
  SIPPLAB_TRY(connection.execute("PRAGMA foreign_keys = OFF", "preparing migrations"));
  Result<Done> done = Done{};
  for (const Migration& step : steps) {
    if (done && step.version > version) done = apply(connection, step);
  }
  if (enforced == 0) return done;
  const auto restored = connection.execute("PRAGMA foreign_keys = ON", "ending migrations");
  return done ? restored : done;
}

}  // namespace sipplab::db
