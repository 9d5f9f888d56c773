// From what the user asked for to the list of cases and their instances.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/sweep/instance_set.hpp"
#include "bench/sweep/suites.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "planner/core/expected.hpp"

namespace sipplab::bench {

/// A suite or folders of instances, and what replaces dimensions of the suite. Empty
/// lists and options leave the suite's own.
struct SweepRequest {
  const Suite* suite = nullptr;  ///< none where folders are given
  /// A folder with empty/N/ and warehouse/N/, as the archive of AAMAS 2018 has them: the
  /// suite's instances are read from there instead of being generated. Cells that it lacks
  /// are left out.
  std::optional<std::string> archive;
  std::optional<std::uint64_t> random_seeds;  ///< instead of the suite's, where something is random
  std::vector<std::string> folders;           ///< planned with PlannerOptions' defaults unless replaced
  std::optional<std::string> map;
  std::vector<std::size_t> robots;
  std::vector<double> ssi_s;
  std::vector<Rescheduling> reschedules;
  std::vector<InitialOrder> orders;
  std::vector<int> connectedness;
  std::optional<bool> any_angle;
  std::vector<double> weights;
  /// Overwrites what the user chose of the rules of motion; none: nothing.
  std::function<void(MotionRules&)> change_rules;
  std::optional<Method> method;
  std::optional<Fallback> fallback;
  std::optional<Refinement> refinement;
  std::optional<std::uint64_t> count;
  std::optional<double> time_limit_s;
  std::optional<std::uint64_t> max_expansions;
  std::optional<std::uint64_t> max_restarts;
  std::uint64_t seed = 1;
  std::string command;  ///< name of the program that plans instead; empty: this planner
};

struct NamedCase {
  std::string name;
  SweepCase parameters;
};

struct ExpandedSweep {
  std::vector<NamedCase> cases;  ///< names are unique
  std::vector<InstanceSet> sets;
};

/// Makes or reads all instances. Errors: one line; also where an instance lies beyond the
/// complete planner and a case asks for it.
Expected<ExpandedSweep, std::string> expand(const SweepRequest& request);

}  // namespace sipplab::bench
