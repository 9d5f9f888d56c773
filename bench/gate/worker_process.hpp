// One process of a judged build, and the pipes to it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/gate/protocol.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// Cores that this process may run on.
std::vector<int> allowed_cores();

/// The program of a build: the path itself, or "sipplab" in that folder. Errors: one line.
Expected<std::string, std::string> find_program(const std::string& build);

/// Ends the process when it goes out of scope.
class WorkerProcess {
 public:
  struct Start {
    std::string program;
    std::string title;                ///< "base", "head": what messages call it
    std::optional<int> core;          ///< to run on; none: wherever the system wants
    std::vector<std::string> extras;  ///< "NAME=value" beside the few variables that are passed on
  };

  /// Starts `program gate --serve` and waits for its greeting. Errors: one line.
  static Expected<WorkerProcess, std::string> start(const Start& start);

  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;
  WorkerProcess& operator=(WorkerProcess&&) = delete;
  ~WorkerProcess();

  const WorkerGreeting& greeting() const { return greeting_; }

  /// Loads an instance file; returns its content hash.
  Expected<std::string, std::string> load(const std::string& file);
  /// Adds a job: to plan the instance that was loaded as number `instance`.
  Expected<std::size_t, std::string> add_job(std::size_t instance, const PlannerOptions& options);
  /// Plans a job; `check`: has the validator speak.
  Expected<WorkerAnswer, std::string> plan(std::size_t job, bool check);

 private:
  WorkerProcess(std::string title, pid_t process, int to, int from);

  Expected<nlohmann::json, std::string> ask(const nlohmann::json& request);
  Expected<nlohmann::json, std::string> read_line();
  std::string complaint(const std::string& what) const { return title_ + " build: " + what; }

  std::string title_;
  pid_t process_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::string buffer_;
  WorkerGreeting greeting_;
};

}  // namespace sipplab::bench
