// Gate runs: written whole, read back as noise.
#include "db/gate_runs.hpp"

#include <fmt/core.h>

#include "db/identity.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Connection;
using sqlite::Statement;

constexpr std::string_view kWritingGateRun = "writing a gate run";

Result<std::int64_t> insert_gate_run(Connection& connection, const GateRun& run) {
  const auto base_build = SIPPLAB_TRY(build_id(connection, run.base_build));
  const auto base_commit = SIPPLAB_TRY(commit_id(connection, run.base_commit));
  const auto run_id =
      SIPPLAB_TRY(insert_run(connection, run, finished_run("gate", run.suite, run.verdict, run)));
  return insert_row(connection, "gate_run", kWritingGateRun, [&](auto visit) {
    visit("run_id", run_id);
    visit("kind", run.calibration ? "calibration" : "comparison");
    visit("method", run.method);
    visit("base_build_id", base_build);
    visit("base_commit_id", base_commit);
    visit("pair_seconds", run.pair_seconds);
    visit("tolerance", run.tolerance);
    visit("injected_slowdown", run.injected_slowdown);
    visit("wall_time_ns", run.wall_time_ns);
    visit("compared", run.compared);
    visit("differing", run.differing);
    visit("reason", run.reason);
  });
}

Result<Done> insert_pairs(Connection& connection, std::int64_t cell, const GateCellRow& row) {
  for (const int stage : {1, 2}) {
    const std::vector<double>& pairs = stage == 1 ? row.pairs : row.fresh_pairs;
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
      SIPPLAB_TRY(sqlite::run(
          connection, "INSERT INTO gate_pair (gate_cell_id, stage, pair, slowdown) VALUES (?, ?, ?, ?)",
          kWritingGateRun, cell, stage, static_cast<std::int64_t>(pair), pairs[pair]));
    }
  }
  return Done{};
}

Result<Done> insert_cells(Connection& connection, std::int64_t run, const std::vector<GateCellRow>& cells) {
  for (std::size_t position = 0; position < cells.size(); ++position) {
    const GateCellRow& row = cells[position];
    std::optional<std::int64_t> case_key;
    if (row.parameters) case_key = SIPPLAB_TRY(case_id(connection, *row.parameters));
    SIPPLAB_TRY(sqlite::run(
        connection,
        "INSERT INTO gate_cell (gate_run_id, position, case_id, slowdown, p_value, confirm_slowdown, "
        "confirm_p_value, "
        "at_most, noise, effect_floor, detectable, verdict) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        kWritingGateRun, run, static_cast<std::int64_t>(position), case_key, row.slowdown, row.p_value,
        row.confirm_slowdown, row.confirm_p_value, row.at_most, row.noise, row.effect_floor, row.detectable,
        row.verdict));
    SIPPLAB_TRY(insert_pairs(connection, connection.last_insert_rowid(), row));
  }
  return Done{};
}

Result<Done> insert_differences(Connection& connection, std::int64_t run,
                                const std::vector<GateDifferenceRow>& differences) {
  auto keys = SIPPLAB_TRY(InstanceKeys::prepare(connection));
  for (const GateDifferenceRow& row : differences) {
    const auto case_key = SIPPLAB_TRY(case_id(connection, row.parameters));
    const auto instance = SIPPLAB_TRY(keys.key(row.instance));
    SIPPLAB_TRY(sqlite::run(
        connection,
        "INSERT OR IGNORE INTO gate_difference (gate_run_id, case_id, instance_id, what, base, head) "
        "VALUES (?, ?, ?, ?, ?, ?)",
        kWritingGateRun, run, case_key, instance, row.what, row.base, row.head));
  }
  return Done{};
}

}  // namespace

Result<std::string> record_gate_run(Database& database, GateRun run) {
  Connection& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  run.uuid = new_uuid();
  const auto id = SIPPLAB_TRY(insert_gate_run(connection, run));
  SIPPLAB_TRY(insert_cells(connection, id, run.cells));
  SIPPLAB_TRY(insert_differences(connection, id, run.differences));
  SIPPLAB_TRY(transaction.commit());
  return run.uuid;
}

Result<std::vector<GateNoise>> gate_noise(Database& database, const GateKind& kind) {
  // Enough for a quantile, few enough to follow a machine that changes.
  constexpr std::int64_t kNewest = 20;
  auto select = SIPPLAB_TRY(
      Statement::prepare(database.connection(),
                         "SELECT gate_cell.id, gate_cell.case_id, gate_pair.slowdown, case_.* FROM gate_cell "
                         "JOIN gate_pair ON gate_pair.gate_cell_id = gate_cell.id AND gate_pair.stage = 1 "
                         "LEFT JOIN case_ ON case_.id = gate_cell.case_id "
                         "WHERE gate_cell.gate_run_id IN (SELECT gate_run.id FROM gate_run "
                         "  JOIN run ON run.id = gate_run.run_id JOIN machine ON machine.id = run.machine_id "
                         "  WHERE machine.fingerprint = ? AND run.suite = ? AND gate_run.method = ? "
                         "    AND gate_run.pair_seconds = ? AND gate_run.kind = 'calibration' "
                         "    AND run.excluded_reason IS NULL ORDER BY run.started_utc DESC LIMIT ?) "
                         "ORDER BY gate_cell.case_id, gate_cell.id, gate_pair.pair",
                         "reading the noise of this machine", fingerprint(kind.machine), kind.suite,
                         kind.method, kind.pair_seconds, kNewest));
  std::vector<GateNoise> noise;
  std::optional<std::int64_t> cell;
  SIPPLAB_TRY(select.for_each([&] {
    std::optional<CaseInfo> parameters;
    if (!select.is_null(1)) parameters = read_case(select, 3);
    if (noise.empty() || noise.back().parameters != parameters) noise.push_back({parameters, {}});
    if (cell != select.integer(0)) noise.back().comparisons.emplace_back();
    cell = select.integer(0);
    noise.back().comparisons.back().push_back(select.real(2));
  }));
  return noise;
}

}  // namespace sipplab::db
