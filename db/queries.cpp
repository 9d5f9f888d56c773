// Runs and their cells, read from the views.
#include "db/queries.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "db/columns.hpp"
#include "db/identity.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr std::string_view kListing = "listing runs";

constexpr const char* kSelectRuns =
    "SELECT v_runs.*, compiler || ' ' || compiler_version AS compiler_name FROM v_runs ";

/// What `latest` and a list without a kind are about: runs that can be compared and plotted.
constexpr const char* kComparable = "kind IN ('sweep', 'report')";

RunSummary read_run(const Statement& row) {
  RunSummary run;
  read_row(row, [&run](auto visit) { RunSummary::columns(run, visit); });
  run.compiler = row.text(row.column("compiler_name"));
  return run;
}

CellSummary read_cell(const Statement& row) {
  CellSummary cell;
  read_row(row, [&cell](auto visit) { CellSummary::measures(cell, visit); });
  cell.parameters = read_case(row, row.column("id"));
  cell.case_id = row.integer(row.column("case_id"));
  return cell;
}

Result<std::vector<CellSummary>> cells_of(Database& database, const std::string& uuid) {
  return SIPPLAB_TRY(Statement::prepare(
                         database.connection(),
                         "SELECT cell.*, case_.* FROM v_all_run_cells AS cell JOIN case_ ON case_.id = "
                         "cell.case_id WHERE cell.run = ? "
                         "ORDER BY cell.environment, cell.planner, cell.initial_order, "
                         "cell.reschedule, cell.ssi_s, cell.robots, id",
                         "reading the cells of a run", uuid))
      .collect(read_cell);
}

/// What the view of its kind says of a run that has no cells.
Result<Table> details_of(Database& database, const RunSummary& run) {
  const std::string kind = run.kind;
  const char* from = kind == "report"     ? "v_all_measurements WHERE run = ?"
                     : kind == "property" ? "v_property_runs WHERE property_run = ?"
                     : kind == "fuzz"     ? "v_fuzz_runs WHERE fuzz_run = ?"
                     : kind == "gate"     ? "v_all_gate_cells WHERE gate_run = ?"
                                          : nullptr;
  if (from == nullptr) return Table{};
  return rest_of(SIPPLAB_TRY(Statement::prepare(database.connection(), fmt::format("SELECT * FROM {}", from),
                                                "reading a run", run.uuid)));
}

Result<Done> set_exclusion(Database& database, std::string_view run,
                           const std::optional<std::string>& reason) {
  const auto uuid = SIPPLAB_TRY(resolve_run(database, run));
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(database.connection()));
  SIPPLAB_TRY(sqlite::run(database.connection(),
                          "UPDATE run SET excluded_reason = ?1, "
                          "excluded_utc = CASE WHEN ?1 IS NULL THEN NULL ELSE ?2 END, "
                          "included_utc = CASE WHEN ?1 IS NULL AND excluded_reason IS NOT NULL THEN ?2 "
                          "ELSE included_utc END WHERE uuid = ?3",
                          "excluding or including a run", reason, utc_now(), uuid));
  return transaction.commit();
}

bool is_uuid_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == '-';
  });
}

}  // namespace

Result<std::vector<RunSummary>> list_runs(Database& database, const RunFilter& filter) {
  // LIMIT inside, on the plain table: counts are then made for the runs that are shown.
  return SIPPLAB_TRY(
             Statement::prepare(
                 database.connection(),
                 fmt::format(
                     "{}WHERE run IN (SELECT uuid FROM run WHERE (?1 IS NULL OR suite = ?1) AND (?2 OR "
                     "excluded_reason "
                     "IS NULL) AND (?4 = 'all' OR kind = ?4 OR (?4 IS NULL AND {})) "
                     "ORDER BY started_utc DESC, id DESC LIMIT ?3) ORDER BY started_utc DESC, run DESC",
                     kSelectRuns, kComparable),
                 kListing, filter.suite, filter.include_excluded, sql_limit(filter.limit), filter.kind))
      .collect(read_run);
}

Result<std::string> resolve_run(Database& database, std::string_view text) {
  constexpr std::size_t kShortestPrefix = 4;
  const std::string file = database.path().string();
  if (text == "latest") {
    auto newest = database.connection().query_text(
        fmt::format("SELECT uuid FROM run WHERE {} AND excluded_reason IS NULL "
                    "ORDER BY started_utc DESC, id DESC LIMIT 1",
                    kComparable),
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
  std::vector<std::string> found;
  // Checks of properties are many: digits that fit one sweep name it, whatever else they fit.
  for (const char* kinds : {kComparable, "true"}) {
    auto select = SIPPLAB_TRY(Statement::prepare(
        database.connection(),
        fmt::format("SELECT uuid FROM run WHERE uuid LIKE ? || '%' AND {} ORDER BY uuid LIMIT 2", kinds),
        kListing, text));
    found = SIPPLAB_TRY(select.collect([](const Statement& row) { return row.text(0); }));
    if (!found.empty()) break;
  }
  if (found.empty()) {
    return Unexpected{
        Error{ErrorKind::kNotFound,
              fmt::format("{}: no run {}, expected one that `sipplab runs` lists", file, text)}};
  }
  if (found.size() > 1) {
    return Unexpected{Error{ErrorKind::kBadInput,
                            fmt::format("{}: {} fits more than one run, expected more digits", file, text)}};
  }
  return found.front();
}

Result<std::optional<std::string>> run_before(Database& database, const std::string& uuid) {
  auto select = SIPPLAB_TRY(
      Statement::prepare(database.connection(),
                         "SELECT other.uuid FROM run JOIN run AS other ON other.kind = run.kind AND "
                         "other.suite = run.suite AND other.excluded_reason IS NULL "
                         "AND (other.started_utc, other.id) < (run.started_utc, run.id) "
                         "WHERE run.uuid = ? ORDER BY other.started_utc DESC, other.id DESC LIMIT 1",
                         "looking for the run before", uuid));
  const auto row = SIPPLAB_TRY(select.step());
  if (!row) return std::optional<std::string>{};
  return std::optional<std::string>{select.text(0)};
}

Result<RunReport> show_run(Database& database, std::string_view run) {
  const auto uuid = SIPPLAB_TRY(resolve_run(database, run));
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(), std::string{kSelectRuns} + "WHERE run = ?", "reading a run", uuid));
  const auto runs = SIPPLAB_TRY(select.collect(read_run));
  auto cells = SIPPLAB_TRY(cells_of(database, uuid));
  auto details = SIPPLAB_TRY(details_of(database, runs.front()));
  return RunReport{runs.front(), std::move(cells), std::move(details)};
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
  const auto report = SIPPLAB_TRY(show_run(database, run));
  if (!report.run.excluded_reason) {
    return Unexpected{
        Error{ErrorKind::kBadInput,
              fmt::format("{}: run {} is not excluded, expected one that is (`sipplab runs --all`)",
                          database.path().string(), report.run.uuid)}};
  }
  return set_exclusion(database, run, std::nullopt);
}

}  // namespace sipplab::db
