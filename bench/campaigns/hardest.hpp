// Which of many small cases are the hardest to plan: what performance fuzzing leaves behind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "planner/io/plan_case.hpp"
#include "planner/solve/plan.hpp"

namespace sipplab::bench {

struct HardCase {
  std::filesystem::path file;
  PlanCase plan_case;
  PlanStatus status = PlanStatus::kFailed;
  std::uint64_t expansions = 0;
  std::size_t tries = 0;

  double expansions_per_robot() const {
    return static_cast<double>(expansions) / static_cast<double>(plan_case.instance.agents.size());
  }
};

/// Expansions and restarts of one case: what the target planning_effort_climbs allows.
inline constexpr std::uint64_t kHardestExpansions = 20000;
inline constexpr std::uint64_t kHardestRestarts = 100;

/// Plans all cases below the folders, within these limits; those with the most expansions per robot first.
/// Files that are no case, break a rule or hold no robot are passed over.
std::vector<HardCase> hardest_cases(const std::vector<std::string>& folders);

/// The first `keep`, but of cases that ask for the same kind of plan (re-scheduling, any-angle, robots) one
/// only.
std::vector<HardCase> distinct_cases(std::vector<HardCase> cases, std::size_t keep);

}  // namespace sipplab::bench
