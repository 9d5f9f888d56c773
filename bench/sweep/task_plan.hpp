// A sweep split into the tasks of a job array: what is written once, and read by each task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/sweep/expand.hpp"
#include "db/database.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// DIR/sweep.json. Task i of n is shard i/n, and is recorded in DIR/i.db; counted from 1.
struct TaskPlan {
  std::string sweep;  ///< UUID of the run that all tasks write together
  std::size_t tasks = 1;
  std::int64_t plannings = 0;  ///< of all tasks
  std::string suite;
  std::string options;                 ///< as RunInfo::options: a task that reads it otherwise does not run
  std::string binary_hash;             ///< of the program; another one does not run
  std::string folder;                  ///< where it was planned: relative paths count from there
  std::vector<std::string> arguments;  ///< of `sipplab`
  std::vector<double> seconds;         ///< expected of a planning of each case
};

inline std::filesystem::path task_database(const std::filesystem::path& folder, std::size_t task) {
  return folder / (std::to_string(task) + ".db");
}

/// Errors: one line.
Expected<TaskPlan, std::string> read_task_plan(const std::filesystem::path& folder);
/// The error, if it cannot be written.
std::optional<std::string> write_task_plan(const std::filesystem::path& folder, const TaskPlan& plan);

/// What a planning of each case is expected to take: what it took in the history, else by its robots, in the
/// scale of those that are known.
db::Result<std::vector<double>> expected_seconds(const ExpandedSweep& sweep, db::Database* history);
/// Of all plannings, if one of each case takes so long.
double seconds_of_all(const ExpandedSweep& sweep, std::int64_t repetitions,
                      const std::vector<double>& seconds);
/// So many that each takes about `seconds_per_task`, from 1 to what Slurm allows as a rule.
std::size_t tasks_for(double seconds, double seconds_per_task);

/// A command line without some options, which have a value each.
std::vector<std::string> arguments_without(const std::vector<std::string>& arguments,
                                           const std::set<std::string>& options);

/// Where a task leaves the code with which its program ended.
inline std::filesystem::path exit_file(const std::filesystem::path& folder, std::size_t task) {
  return folder / (std::to_string(task) + ".exit");
}

struct TaskStates {
  std::vector<std::size_t> done;
  std::vector<std::size_t> missing;  ///< not begun, without results, or ended by something else
  std::vector<std::pair<std::size_t, int>> failed;  ///< with the code
};
/// Of tasks 1 to `tasks`, by what their programs said when they ended.
TaskStates states_of(const std::filesystem::path& folder, std::size_t tasks);

/// Numbers in ascending order as job arrays are told of them: "1-3,7".
std::string ranges(const std::vector<std::size_t>& numbers);

}  // namespace sipplab::bench
