// Summaries of cells: a cache of what the results of a case say, so that questions over
// thousands of runs need not read them. Filled and checked from one definition, the view
// v_recomputed_cells.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "db/records.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db {

/// The medians of a cell; none without values. In SQL they take longer than all other columns
/// together; the writer of the results computes them in passing.
struct CellMedians {
  std::optional<double> planning_time_s;
  std::optional<double> makespan_s;  ///< of solved results, as the next
  std::optional<double> flowtime_s;
  std::optional<double> solved_time_s;
  std::optional<double> time_to_solve_s;  ///< unsolved ones counted as the longest; none if in the middle
};
/// Bit for bit what v_recomputed_cells says.
CellMedians medians_of(const std::vector<const ResultRow*>& results);

/// Writes summaries of single cells. Prepared once: reading the view takes as long as using it.
class CellSummariser {
 public:
  static Result<CellSummariser> prepare(sqlite::Connection& connection);

  /// To be called within the transaction that writes the results of the cell, after them.
  Result<Done> summarise(std::int64_t cell_id, const CellMedians& medians);

 private:
  explicit CellSummariser(sqlite::Statement insert) : insert_(std::move(insert)) {}

  sqlite::Statement insert_;
};

/// Cells without a summary, or with one that is not what the results say, and instances of cases of
/// which that is true. Reads all results.
Result<std::int64_t> count_stale_summaries(sqlite::Connection& connection);

/// Computes all summaries again, in one transaction.
Result<Done> rebuild_summaries(sqlite::Connection& connection);

}  // namespace sipplab::db
