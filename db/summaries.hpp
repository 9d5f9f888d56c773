// Summaries of cells: a cache of what the results of a case say, so that questions over
// thousands of runs need not read them. Filled and checked from one definition, the view
// v_recomputed_cells.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db {

/// Writes summaries of single cells. Prepared once: reading the view takes as long as using it.
class CellSummariser {
 public:
  static Result<CellSummariser> prepare(sqlite::Connection& connection);

  /// To be called within the transaction that writes results of the cell, after them; replaces an earlier
  /// summary. In SQL medians take longer than all other columns together: they are computed here, bit for
  /// bit what v_recomputed_cells says.
  Result<Done> summarise(std::int64_t cell_id);

 private:
  CellSummariser(sqlite::Statement select, sqlite::Statement insert)
      : select_(std::move(select)), insert_(std::move(insert)) {}

  sqlite::Statement select_;
  sqlite::Statement insert_;
};

/// What planning an instance of a case took on average, over all runs that count.
struct CaseTime {
  CaseInfo parameters;
  double mean_planning_time_s = 0;
};
Result<std::vector<CaseTime>> case_times(Database& database);

/// Cells without a summary, or with one that is not what the results say, and instances of cases of
/// which that is true. Reads all results.
Result<std::int64_t> count_stale_summaries(sqlite::Connection& connection);

/// Makes the summaries that are missing. REQUIRES: a transaction.
Result<Done> summarise_cells(sqlite::Connection& connection);

/// Computes all summaries again, in one transaction.
Result<Done> rebuild_summaries(sqlite::Connection& connection);

}  // namespace sipplab::db
