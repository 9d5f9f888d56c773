// Planners that other people wrote, and how each is called: a new one is a row of the table.
#pragma once

#include <span>
#include <string_view>

namespace sipplab::bench {

struct KnownPlanner {
  std::string_view name;          ///< "lacam3", as in --planner lacam3:PATH
  std::string_view words;         ///< what it is
  std::string_view command;       ///< with placeholders, {program} for the path
  std::string_view format;        ///< of its solution, as sipplab::solution_formats() has it
  std::string_view needs;         ///< of the instance and the machine, and how it is built
  std::string_view no_plan = {};  ///< what it prints if the file that it leaves is no plan
};

/// In the order of the list that people see.
std::span<const KnownPlanner> known_planners();
/// None if there is no such name.
const KnownPlanner* find_known_planner(std::string_view name);

}  // namespace sipplab::bench
