// Planners side by side: success as given and as re-timed, cost, time, memory.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/present/chart.hpp"
#include "db/queries.hpp"
#include "db/table.hpp"

namespace sipplab::bench {

/// A row for each environment, number of robots and planner of these runs.
db::Result<db::Table> solver_rows(const std::filesystem::path& database,
                                  const std::vector<std::string>& runs);

/// For each environment success after re-timing, and planning time, over the number of robots; with a name
/// fit for a file. `source` says in the captions which runs they are.
std::vector<std::pair<std::string, Chart>> solver_charts(const db::Table& rows, const std::string& source);

/// All of it as one page. Errors: one line if there is no gnuplot.
Expected<std::string, std::string> solvers_page(const db::Table& rows, const std::string& source);

}  // namespace sipplab::bench
