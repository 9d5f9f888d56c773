// Planning time over the number of robots, of one run or of several side by side.
#pragma once

#include <vector>

#include "bench/present/chart.hpp"
#include "db/queries.hpp"
#include "db/trends.hpp"

namespace sipplab::bench {

/// One line of medians for each run, environment, method and start-safe interval that the filter
/// admits, named by what tells it from the others. CaseFilter::id and map select nothing here.
Chart runtime_chart(const std::vector<db::RunReport>& runs, const db::CaseFilter& filter);

}  // namespace sipplab::bench
