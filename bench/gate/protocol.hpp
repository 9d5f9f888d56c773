// What the gate and its workers say to each other: one JSON document a line, over pipes.
// The two builds of a comparison may be of different age, so a worker says first which
// version of this protocol it speaks.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "db/records.hpp"
#include "sipplab/error.hpp"
#include "sipplab/options.hpp"

namespace sipplab::bench {

/// Rises when a line changes its meaning.
inline constexpr int kGateProtocol = 1;

/// The first line of a worker: what it is.
struct WorkerGreeting {
  int protocol = kGateProtocol;
  db::BuildInfo build;
  std::string program;  ///< path of its file
  std::string unfit;    ///< as unfit_for_timing() says
  double injected_slowdown = 0;
};

/// What one planning of a job gave.
struct WorkerAnswer {
  db::ResultRow row;        ///< `valid` only if the job's plan was checked
  std::int64_t cpu_ns = 0;  ///< processor time of planning
};

nlohmann::json to_json(const PlannerOptions& options);
Expected<PlannerOptions, std::string> options_from_json(const nlohmann::json& json);

nlohmann::json to_json(const WorkerGreeting& greeting);
Expected<WorkerGreeting, std::string> greeting_from_json(const nlohmann::json& json);

nlohmann::json to_json(const WorkerAnswer& answer);
Expected<WorkerAnswer, std::string> answer_from_json(const nlohmann::json& json);

}  // namespace sipplab::bench
