// A sweep split into the tasks of a job array: what is written once, and read by each task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
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

}  // namespace sipplab::bench
