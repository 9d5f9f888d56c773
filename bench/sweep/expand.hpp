// From what the user asked for to the list of cases and their instances.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/sweep/case_outcome.hpp"
#include "bench/sweep/instance_set.hpp"
#include "bench/sweep/suites.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "sipplab/error.hpp"

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
  bool strict = false;                        ///< as FolderRequest::strict
  std::optional<std::string> map;
  /// Instead of the suite's bodies; of MovingAI files, which state none, one value each.
  std::vector<double> radii_cells = {};
  std::vector<double> speeds_cells_per_s = {};
  std::vector<std::size_t> robots;
  /// Of options: instead of the suite's, each with each. A dimension of the suite is replaced.
  std::vector<OptionValues> values;
  std::optional<std::uint64_t> count;
  std::uint64_t seed = 1;
  std::string command;  ///< name of the program that plans instead; empty: this planner
};

/// Which planning of a case: a place in its set of instances, and which repetition. Both counted from 0.
struct Planning {
  std::int64_t position = 0;
  std::int64_t repetition = 0;

  friend auto operator<=>(const Planning&, const Planning&) = default;
};

struct NamedCase {
  std::string name;
  SweepCase parameters;
  std::vector<Planning> plannings = {};  ///< what is to be done; expand() leaves it empty
  CaseOutcome outcome = {};              ///< of what was recorded before
};

struct ExpandedSweep {
  std::vector<NamedCase> cases;  ///< names are unique
  std::vector<InstanceSet> sets;
  std::vector<std::string> notes = {};  ///< as LoadedSets::notes
};

/// Makes or reads all instances. Errors: one line; also where an instance lies beyond the
/// LaCAM and a case asks for it.
Expected<ExpandedSweep, std::string> expand(const SweepRequest& request);

}  // namespace sipplab::bench
