// Density curves of a run: success and runtime over the number of robots.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/present/chart.hpp"
#include "db/queries.hpp"

namespace sipplab::bench {

struct DensityChart {
  std::string name;  ///< fit for a file: "success-warehouse-deterministic-shortest-sipplab-connectedness-3"
  Chart chart;
};

/// A picture of success and one of runtime for each environment and method; one line for each
/// start-safe interval, that of the base dashed.
std::vector<DensityChart> density_charts(const db::RunReport& run, const std::optional<db::RunReport>& base);

}  // namespace sipplab::bench
