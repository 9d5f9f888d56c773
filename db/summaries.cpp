// Summaries of cells, in SQL.
#include "db/summaries.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

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

CellMedians medians_of(const std::vector<const ResultRow*>& results) {
  constexpr double kNanosecondsPerSecond = 1e9;
  const auto in_seconds = [](std::optional<double> time_ns) {
    if (time_ns) *time_ns /= kNanosecondsPerSecond;
    return time_ns;
  };
  std::vector<double> times_ns;
  std::vector<double> solved_times_ns;
  std::vector<double> makespans_s;
  std::vector<double> flowtimes_s;
  for (const ResultRow* row : results) {
    times_ns.push_back(static_cast<double>(row->planning_time_ns));
    if (row->status != ResultStatus::kSolved) continue;
    solved_times_ns.push_back(static_cast<double>(row->planning_time_ns));
    if (row->makespan_s) makespans_s.push_back(*row->makespan_s);
    if (row->flowtime_s) flowtimes_s.push_back(*row->flowtime_s);
  }
  return {in_seconds(median(std::move(times_ns))), median(std::move(makespans_s)),
          median(std::move(flowtimes_s)), in_seconds(median(solved_times_ns)),
          in_seconds(median(solved_times_ns, results.size()))};
}

Result<CellSummariser> CellSummariser::prepare(sqlite::Connection& connection) {
  auto insert = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection,
      fmt::format(
          "INSERT INTO cell_summary ({0}, {1}) SELECT {0}, ?2, ?3, ?4, ?5, ?6 FROM v_recomputed_cells "
          "WHERE cell_id = ?1",
          kColumns, kMedians),
      "summarising a finished case"));
  return CellSummariser{std::move(insert)};
}

Result<Done> CellSummariser::summarise(std::int64_t cell_id, const CellMedians& medians) {
  return insert_
      .bind(cell_id, medians.planning_time_s, medians.makespan_s, medians.flowtime_s, medians.solved_time_s,
            medians.time_to_solve_s)
      .run();
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
