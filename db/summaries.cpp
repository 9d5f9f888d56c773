// Summaries of cells, in SQL.
#include "db/summaries.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "db/rows.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

constexpr const char* kColumns =
    "case_id, run_id, results, solved, failed, limited, invalid, mean_planning_time_s, "
    "max_planning_time_s, par2_time_s, mean_makespan_s, mean_flowtime_s, mean_tries, mean_expansions, "
    "mean_generations, mean_solved_time_s";
constexpr const char* kMedians =
    "median_planning_time_s, median_makespan_s, median_flowtime_s, median_solved_time_s, "
    "median_time_to_solve_s";
constexpr const char* kSummarising = "summarising a case";
constexpr std::array kRealColumns{"mean_planning_time_s",   "max_planning_time_s",   "par2_time_s",
                                  "mean_makespan_s",        "mean_flowtime_s",       "mean_tries",
                                  "mean_expansions",        "mean_generations",      "mean_solved_time_s",
                                  "median_planning_time_s", "median_makespan_s",     "median_flowtime_s",
                                  "median_solved_time_s",   "median_time_to_solve_s"};
/// Share of a sum that two ways to add up the same numbers may differ by: rounding of 2^-53 each
/// over some thousands of them.
constexpr double kSummationError = 1e-12;

/// Mean of the two in the middle of `count` places, as SQLite's avg takes it; places behind the values are
/// of greater ones. None if the middle is among those.
std::optional<double> median(std::vector<double> values, std::size_t count) {
  const std::size_t upper = count / 2;
  if (upper >= values.size()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(upper);
  std::nth_element(values.begin(), middle, values.end());
  if (count % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

std::optional<double> median(std::vector<double> values) {
  const std::size_t count = values.size();
  return median(std::move(values), count);
}

}  // namespace

Result<CellSummariser> CellSummariser::prepare(sqlite::Connection& connection) {
  auto select = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection, "SELECT planning_time_ns, status, makespan_s, flowtime_s FROM result WHERE cell_id = ?",
      kSummarising));
  auto insert = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection,
      fmt::format("INSERT OR REPLACE INTO cell_summary ({0}, {1}) SELECT {0}, ?2, ?3, ?4, ?5, ?6 "
                  "FROM v_recomputed_cells WHERE cell_id = ?1",
                  kColumns, kMedians),
      kSummarising));
  return CellSummariser{std::move(select), std::move(insert)};
}

Result<Done> CellSummariser::summarise(std::int64_t cell_id) {
  constexpr double kNanosecondsPerSecond = 1e9;
  const auto in_seconds = [](std::optional<double> time_ns) {
    if (time_ns) *time_ns /= kNanosecondsPerSecond;
    return time_ns;
  };
  std::vector<double> times_ns;
  std::vector<double> solved_times_ns;
  std::vector<double> makespans_s;
  std::vector<double> flowtimes_s;
  select_.reset();
  SIPPLAB_TRY(select_.bind(cell_id).for_each([&] {
    times_ns.push_back(select_.real(0));
    if (select_.integer(1) != static_cast<int>(ResultStatus::kSolved)) return;
    solved_times_ns.push_back(select_.real(0));
    if (!select_.is_null(2)) makespans_s.push_back(select_.real(2));
    if (!select_.is_null(3)) flowtimes_s.push_back(select_.real(3));
  }));
  const std::size_t results = times_ns.size();
  return insert_
      .bind(cell_id, in_seconds(median(std::move(times_ns))), median(std::move(makespans_s)),
            median(std::move(flowtimes_s)), in_seconds(median(solved_times_ns)),
            in_seconds(median(solved_times_ns, results)))
      .run();
}

Result<std::vector<CaseTime>> case_times(Database& database) {
  return SIPPLAB_TRY(
             sqlite::Statement::prepare(
                 database.connection(),
                 "SELECT sum(results * mean_planning_time_s) / sum(results), case_.* FROM cell_summary "
                 "JOIN case_ ON case_.id = case_id JOIN run ON run.id = run_id "
                 "WHERE results > 0 AND run.excluded_reason IS NULL GROUP BY case_.id",
                 "reading what cases take"))
      .collect([](const sqlite::Statement& row) {
        return CaseTime{read_case(row, 1), row.real(0)};
      });
}

Result<std::int64_t> count_stale_summaries(sqlite::Connection& connection) {
  // From release 3.43 on SQLite adds up in another way, so the last bits may differ.
  std::string differs;
  for (const char* column : kRealColumns) {
    differs += fmt::format(
        " OR (made.{0} IS NULL) <> (kept.{0} IS NULL) "
        "OR abs(made.{0} - kept.{0}) > {1} * abs(made.{0})",
        column, kSummationError);
  }
  const auto cells = SIPPLAB_TRY(connection.query_int(
      fmt::format("SELECT count(*) FROM v_recomputed_cells AS made LEFT JOIN cell_summary AS kept "
                  "USING (case_id, run_id) WHERE kept.run_id IS NULL OR (made.results, made.solved, "
                  "made.failed, made.limited, made.invalid) <> (kept.results, kept.solved, kept.failed, "
                  "kept.limited, kept.invalid){}",
                  differs),
      "comparing summaries with results"));
  const auto instances = SIPPLAB_TRY(connection.query_int(
      "SELECT count(*) FROM (SELECT * FROM v_recomputed_instances EXCEPT SELECT * FROM instance_summary)",
      "comparing summaries with results"));
  return cells + instances;
}

Result<Done> summarise_cells(sqlite::Connection& connection) {
  auto select = SIPPLAB_TRY(
      sqlite::Statement::prepare(connection,
                                 "SELECT cell.id FROM cell LEFT JOIN cell_summary USING (case_id, run_id) "
                                 "WHERE cell_summary.run_id IS NULL",
                                 kSummarising));
  const auto cells = SIPPLAB_TRY(select.collect([](const sqlite::Statement& row) { return row.integer(0); }));
  auto summariser = SIPPLAB_TRY(CellSummariser::prepare(connection));
  for (const std::int64_t cell : cells) SIPPLAB_TRY(summariser.summarise(cell));
  return Done{};
}

Result<Done> rebuild_summaries(sqlite::Connection& connection) {
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  SIPPLAB_TRY(connection.execute("DELETE FROM cell_summary", "clearing summaries"));
  SIPPLAB_TRY(connection.execute(
      fmt::format("INSERT INTO cell_summary ({0}, {1}) SELECT {0}, {1} FROM v_recomputed_cells", kColumns,
                  kMedians),
      "computing all summaries"));
  SIPPLAB_TRY(connection.execute(
      "DELETE FROM instance_summary; INSERT INTO instance_summary SELECT * FROM v_recomputed_instances",
      "computing all summaries"));
  return transaction.commit();
}

}  // namespace sipplab::db
