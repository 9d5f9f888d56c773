// Runs and their cells, read from the views.
#include "db/queries.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "db/identity.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr std::string_view kListing = "listing runs";

constexpr const char* kRunColumns =
    "SELECT run, suite, status, started_utc, ended_utc, commit_hash, commit_subject, branch, dirty, host, "
    "cpu_model, compiler || ' ' || compiler_version, build_type, command_line, cases, results, solved, "
    "invalid, "
    "excluded_reason FROM v_runs ";

RunSummary read_run(const Statement& row) {
  RunSummary run;
  int column = 0;
  run.uuid = row.text(column++);
  run.suite = row.text(column++);
  run.status = row.text(column++);
  run.started_utc = row.text(column++);
  run.ended_utc = row.optional_text(column++);
  run.commit_hash = row.optional_text(column++);
  run.commit_subject = row.optional_text(column++);
  run.branch = row.text(column++);
  run.dirty = row.integer(column++) != 0;
  run.host = row.text(column++);
  run.cpu_model = row.text(column++);
  run.compiler = row.text(column++);
  run.build_type = row.text(column++);
  run.command_line = row.text(column++);
  run.cases = row.integer(column++);
  run.results = row.integer(column++);
  run.solved = row.integer(column++);
  run.invalid = row.integer(column++);
  run.excluded_reason = row.optional_text(column);
  return run;
}

CellSummary read_cell(const Statement& row) {
  CellSummary cell;
  int column = 0;
  cell.environment = row.text(column++);
  cell.robots = row.integer(column++);
  cell.ssi_s = row.real(column++);
  cell.reschedule = row.text(column++);
  cell.order = row.text(column++);
  cell.planner = row.text(column++);
  cell.any_angle = row.integer(column++) != 0;
  cell.connectedness = row.integer(column++);
  cell.results = row.integer(column++);
  cell.solved = row.integer(column++);
  cell.limited = row.integer(column++);
  cell.invalid = row.integer(column++);
  for (std::optional<double>* value :
       {&cell.success_rate, &cell.mean_planning_time_s, &cell.median_planning_time_s, &cell.mean_makespan_s,
        &cell.median_makespan_s, &cell.mean_flowtime_s, &cell.median_flowtime_s, &cell.mean_tries,
        &cell.mean_expansions}) {
    *value = row.optional_real(column++);
  }
  return cell;
}

/// Reads all rows of `statement`, each with `read`.
template <class Row>
Result<std::vector<Row>> collect(Statement& statement, Row (*read)(const Statement&)) {
  std::vector<Row> rows;
  for (;;) {
    const auto row = statement.step();
    if (!row) return Unexpected{row.error()};
    if (!row.value()) return rows;
    rows.push_back(read(statement));
  }
}

Result<std::vector<CellSummary>> cells_of(Database& database, const std::string& uuid) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT environment, robots, ssi_s, reschedule, initial_order, planner, any_angle, connectedness, "
      "results, "
      "solved, limited, invalid, success_rate, mean_planning_time_s, median_planning_time_s, "
      "mean_makespan_s, "
      "median_makespan_s, mean_flowtime_s, median_flowtime_s, mean_tries, mean_expansions FROM v_run_cells "
      "WHERE run = ? ORDER BY environment, planner, any_angle, connectedness, initial_order, reschedule, "
      "ssi_s, "
      "robots, case_id",
      "reading the cells of a run");
  if (!select) return Unexpected{select.error()};
  select->bind(uuid);
  return collect(*select, read_cell);
}

Result<Done> set_exclusion(Database& database, std::string_view run,
                           const std::optional<std::string>& reason) {
  const auto uuid = resolve_run(database, run);
  if (!uuid) return Unexpected{uuid.error()};
  auto transaction = sqlite::Transaction::begin(database.connection());
  if (!transaction) return Unexpected{transaction.error()};
  auto update =
      Statement::prepare(database.connection(),
                         "UPDATE run SET excluded_reason = ?1, "
                         "excluded_utc = CASE WHEN ?1 IS NULL THEN NULL ELSE ?2 END, "
                         "included_utc = CASE WHEN ?1 IS NULL AND excluded_reason IS NOT NULL THEN ?2 "
                         "ELSE included_utc END WHERE uuid = ?3",
                         "excluding or including a run");
  if (!update) return Unexpected{update.error()};
  if (auto done = update->bind(reason, utc_now(), *uuid).run(); !done) return done;
  return transaction->commit();
}

bool is_uuid_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == '-';
  });
}

}  // namespace

Result<std::vector<RunSummary>> list_runs(Database& database, const RunFilter& filter) {
  // LIMIT inside, on the plain table: counts are then made for the runs that are shown.
  auto select = Statement::prepare(database.connection(),
                                   std::string{kRunColumns} +
                                       "WHERE run IN (SELECT uuid FROM run WHERE (?1 IS NULL OR suite = ?1) "
                                       "AND (?2 OR excluded_reason IS NULL) "
                                       "ORDER BY started_utc DESC, id DESC LIMIT ?3) "
                                       "ORDER BY started_utc DESC, run DESC",
                                   kListing);
  if (!select) return Unexpected{select.error()};
  const std::int64_t no_limit = -1;
  select->bind(filter.suite, filter.include_excluded,
               filter.limit == 0 ? no_limit : static_cast<std::int64_t>(filter.limit));
  return collect(*select, read_run);
}

Result<std::string> resolve_run(Database& database, std::string_view text) {
  constexpr std::size_t kShortestPrefix = 4;
  const std::string file = database.path().string();
  if (text == "latest") {
    auto newest = database.connection().query_text(
        "SELECT uuid FROM run WHERE excluded_reason IS NULL ORDER BY started_utc DESC, id DESC LIMIT 1",
        kListing);
    if (!newest && newest.error().kind == ErrorKind::kNotFound) {
      return Unexpected{
          Error{ErrorKind::kNotFound, fmt::format("{}: no run yet, expected at least one", file)}};
    }
    return newest;
  }
  if (text.size() < kShortestPrefix || !is_uuid_text(text)) {
    return Unexpected{Error{ErrorKind::kBadInput,
                            fmt::format("{}: run '{}', expected latest, a UUID, or at least {} digits of one",
                                        file, text, kShortestPrefix)}};
  }
  auto select = Statement::prepare(
      database.connection(), "SELECT uuid FROM run WHERE uuid LIKE ? || '%' ORDER BY uuid LIMIT 2", kListing);
  if (!select) return Unexpected{select.error()};
  select->bind(text);
  const auto found = collect<std::string>(*select, [](const Statement& row) { return row.text(0); });
  if (!found) return Unexpected{found.error()};
  if (found->empty()) {
    return Unexpected{
        Error{ErrorKind::kNotFound,
              fmt::format("{}: no run {}, expected one that `sipplab runs` lists", file, text)}};
  }
  if (found->size() > 1) {
    return Unexpected{Error{ErrorKind::kBadInput,
                            fmt::format("{}: {} fits more than one run, expected more digits", file, text)}};
  }
  return found->front();
}

Result<std::optional<std::string>> run_before(Database& database, const std::string& uuid) {
  auto select =
      Statement::prepare(database.connection(),
                         "SELECT other.uuid FROM run JOIN run AS other ON other.suite = run.suite AND "
                         "other.excluded_reason IS NULL "
                         "AND (other.started_utc, other.id) < (run.started_utc, run.id) "
                         "WHERE run.uuid = ? ORDER BY other.started_utc DESC, other.id DESC LIMIT 1",
                         "looking for the run before");
  if (!select) return Unexpected{select.error()};
  const auto row = select->bind(uuid).step();
  if (!row) return Unexpected{row.error()};
  if (!row.value()) return std::optional<std::string>{};
  return std::optional<std::string>{select->text(0)};
}

Result<RunReport> show_run(Database& database, std::string_view run) {
  const auto uuid = resolve_run(database, run);
  if (!uuid) return Unexpected{uuid.error()};
  auto select =
      Statement::prepare(database.connection(), std::string{kRunColumns} + "WHERE run = ?", "reading a run");
  if (!select) return Unexpected{select.error()};
  select->bind(*uuid);
  const auto runs = collect(*select, read_run);
  if (!runs) return Unexpected{runs.error()};
  auto cells = cells_of(database, *uuid);
  if (!cells) return Unexpected{cells.error()};
  return RunReport{runs->front(), std::move(*cells)};
}

Result<Done> exclude_run(Database& database, std::string_view run, const std::string& reason) {
  if (reason.empty()) {
    return Unexpected{
        Error{ErrorKind::kBadInput,
              fmt::format("{}: no reason, expected why the run is left out", database.path().string())}};
  }
  return set_exclusion(database, run, reason);
}

Result<Done> include_run(Database& database, std::string_view run) {
  const auto report = show_run(database, run);
  if (!report) return Unexpected{report.error()};
  if (!report->run.excluded_reason) {
    return Unexpected{
        Error{ErrorKind::kBadInput,
              fmt::format("{}: run {} is not excluded, expected one that is (`sipplab runs --all`)",
                          database.path().string(), report->run.uuid)}};
  }
  return set_exclusion(database, run, std::nullopt);
}

}  // namespace sipplab::db
