// Plans and best known costs as MAPF-tracker exchanges them: CSV with a row for each number of agents, and a
// string of moves for each agent, "3ru2l". Its `u` counts rows upwards: y + 1.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A scenario of MovingAI by its parts, and a number of its robots.
struct TrackerRow {
  std::string map_name;
  std::string scen_type;  ///< "random", "even"
  std::int64_t type_id = 0;
  std::int64_t agents = 0;
  std::int64_t lower_cost = 0;
  std::int64_t solution_cost = 0;
};

/// "maps/x-random-3.scen" is scenario 3 of type random on map x. Parts that the name does not state are
/// empty.
TrackerRow tracker_scenario(const std::string& file_name);

/// One string for each robot, with runs counted: "3ru2l".
std::string tracker_lines(const std::vector<std::vector<Cell>>& steps);
/// The header and one row, costs included: the lower one is that of each robot alone.
std::string tracker_csv(const Instance& instance, TrackerRow row,
                        const std::vector<std::vector<Cell>>& steps);

/// Reads rows of best known costs; plans are passed over. Columns are found by their names, in any order.
Input<std::vector<TrackerRow>> parse_tracker_rows(std::string_view text, const std::string& file_name);

}  // namespace sipplab
