// Paired results for tests of judgements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/judge/judgement.hpp"
#include "bench/sweep/sweep_case.hpp"

namespace sipplab::bench {

inline db::ResultRow solved(std::uint64_t plan, double flowtime_s) {
  db::ResultRow row;
  row.status = db::ResultStatus::kSolved;
  row.plan_hash = plan;
  row.makespan_s = flowtime_s / 2;
  row.flowtime_s = flowtime_s;
  row.planning_time_ns = 1000;
  row.tries = 1;
  row.expansions = 10;
  row.generations = 20;
  return row;
}

inline db::ResultRow failed() {
  db::ResultRow row;
  row.planning_time_ns = 1000;
  return row;
}

/// A cell of `count` instances that both sides solved alike.
inline db::PairedCell equal_cell(std::size_t count) {
  db::PairedCell cell;
  SweepCase warehouse;
  warehouse.environment = warehouse.map_spec = "warehouse";
  warehouse.robots = 64;
  warehouse.options.time_limit_s = db::kNoTimeLimit;
  cell.parameters = case_row(warehouse);
  cell.same_machine = true;
  for (std::size_t i = 0; i < count; ++i) {
    const db::ResultRow row = solved(i, 100 + static_cast<double>(i));
    cell.results.push_back(
        {"warehouse agents:64 seed:7 index:" + std::to_string(i), "hash " + std::to_string(i), row, row});
  }
  return cell;
}

inline Judgement judgement_of(std::vector<db::PairedCell> cells, const JudgeOptions& options = {}) {
  Judgement judgement = measured(std::move(cells));
  judge(judgement, options);
  return judgement;
}

inline const Difference& row(const Judgement& judgement, const Metric& metric,
                             std::optional<std::size_t> cell = 0) {
  return *judgement.find(metric, cell);
}

/// `cells` cells of some instances; the head's flowtimes are `factor` times as long.
inline std::vector<db::PairedCell> slower_arrivals(std::size_t cells, std::size_t instances, double factor) {
  std::vector<db::PairedCell> all(cells, equal_cell(instances));
  for (std::size_t cell = 0; cell < cells; ++cell) {
    all[cell].parameters.robots = 64 + static_cast<std::int64_t>(cell);
    for (std::size_t i = 0; i < instances; ++i) {
      db::PairedResult& result = all[cell].results[i];
      result.instance_hash = "cell " + std::to_string(cell) + " instance " + std::to_string(i);
      result.head.flowtime_s = *result.base.flowtime_s * factor;
      result.head.plan_hash = *result.base.plan_hash + 5000;
    }
  }
  return all;
}

}  // namespace sipplab::bench
