// Tries a recorded counterexample again: by planning and validating its case, and by
// having the property's own program look at it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "planner/io/plan_case.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::bench {

using Planner = std::function<PlanResult(const Instance&, const PlannerOptions&)>;

struct CaseVerdict {
  bool holds = false;
  std::string text;  ///< one line for a person
  PlanResult result;
  ValidationReport report;
};

/// Plans the case and has the validator check the plan, its start-safe interval too. A
/// case without a plan holds: there is nothing that could be wrong. One that breaks a
/// rule of instances does not.
CaseVerdict replay_case(const PlanCase& plan_case, const Planner& planner);

/// Exit code of a room that has none of the properties that it is to reproduce.
inline constexpr int kNoSuchProperty = 3;

/// The shell command that tries a counterexample of a room again.
std::string replay_command(const std::filesystem::path& program, const std::string& room,
                           const std::string& reproduce);

enum class ProgramVerdict {
  kHolds,
  kFails,   ///< or crashed
  kNotRun,  ///< no such program, it cannot be started, or it has no such property
};

/// Runs a room of the program with RC_PARAMS set to `reproduce`; what it prints goes to stderr.
/// Nothing is logged.
ProgramVerdict replay_program(const std::filesystem::path& program, const std::string& room,
                              const std::string& reproduce);

}  // namespace sipplab::bench
