#include "property_tests/support/paired_results.hpp"

#include <string>
#include <utility>

#include "property_tests/support/histories.hpp"

namespace sipplab::bench {
using db::any_flag;
using db::any_whole;
using db::ResultRow;
using db::ResultStatus;

ResultRow changed(ResultRow row) {
  for (auto changes = any_whole(0, 2); changes > 0; --changes) {
    switch (any_whole(0, 9)) {
      case 0:
        row.status = static_cast<ResultStatus>(any_whole(0, 3));
        break;
      case 1:
        row.plan_hash = static_cast<std::uint64_t>(any_whole(1, 3));
        break;
      case 2:
        ++row.tries;
        break;
      case 3:
        row.expansions += 3;
        break;
      case 4:
        row.generations += 7;
        break;
      case 5:
        row.flowtime_s = row.flowtime_s.value_or(8) * 1.25;
        break;
      case 6:
        row.makespan_s = row.makespan_s.value_or(4) + 0.5;
        break;
      case 7:
        row.planning_time_ns *= 2;
        break;
      case 8:
        row.limit = any_flag() ? "time" : "expansions";
        break;
      default:
        row.peak_memory_bytes = any_whole(0, 1) << 21;
        break;
    }
  }
  return row;
}

ResultRow any_row() {
  ResultRow row;
  row.status = any_whole(0, 3) > 0 ? ResultStatus::kSolved : static_cast<ResultStatus>(any_whole(0, 3));
  row.planning_time_ns = any_whole(1, 8) * 1'000'000;
  row.makespan_s = static_cast<double>(any_whole(1, 8));
  row.flowtime_s = static_cast<double>(any_whole(8, 32));
  row.tries = static_cast<std::uint64_t>(any_whole(1, 3));
  row.expansions = static_cast<std::uint64_t>(any_whole(0, 40));
  row.generations = static_cast<std::uint64_t>(any_whole(0, 40));
  row.plan_hash = 1;
  row.message = "words";
  if (any_flag()) row.instructions = any_whole(1, 9);
  if (any_flag()) row.peak_memory_bytes = any_whole(0, 3) << 20;
  return row;
}

std::vector<db::PairedCell> any_cells() {
  std::vector<db::PairedCell> cells;
  for (auto left = any_whole(1, 3); left > 0; --left) {
    db::PairedCell cell;
    cell.parameters = db::case_number(static_cast<int>(left));
    if (any_flag()) cell.parameters.options["time_limit_s"] = 8.0;
    cell.same_machine = any_flag();
    cell.base_only = static_cast<std::size_t>(any_whole(0, 2));
    cell.head_only = static_cast<std::size_t>(any_whole(0, 2));
    const bool all_alike = any_flag();
    const double shift = any_flag()   ? 1
                         : any_flag() ? 1.5
                                      : 0.5;  // of every flowtime, so that something is certain
    for (auto results = any_whole(0, 12); results > 0; --results) {
      const int number = static_cast<int>(any_whole(0, 9));
      db::PairedResult result{
          "name " + std::to_string(number), "hash " + std::to_string(number), any_row(), {}};
      result.head = all_alike ? result.base : changed(result.base);
      if (result.head.flowtime_s) *result.head.flowtime_s *= shift;
      result.base.position = result.head.position = static_cast<std::int64_t>(cell.results.size());
      cell.results.push_back(std::move(result));
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace sipplab::bench
