// Two sides of a comparison, each one run or all runs of a commit, and their results in pairs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// What a user named. Of several runs, the newest result of each case counts, so that shards
/// and partial sweeps of one commit add up.
struct ComparisonSide {
  /// "run 1a2b3c4d of commit 88a77295", "commit 88a77295 (2 runs)", "branch main at 88a77295 (1 run)",
  /// "commit 88a77295+ (uncommitted changes) (1 run)".
  std::string title;
  std::optional<std::string> commit_hash;
  std::vector<std::int64_t> run_ids;  ///< oldest first
};

/// `text`: "latest", a UUID or its beginning, the beginning of a commit's hash, or a branch
/// as recorded (its newest commit); "run:", "commit:" and "branch:" before it say which is
/// meant. Excluded runs do not count, nor do runs of builds with uncommitted changes if a commit or
/// branch has others. An error if it names nothing, or several things.
Result<ComparisonSide> resolve_side(Database& database, std::string_view text);

/// One instance as both sides planned it.
struct PairedResult {
  std::string instance;  ///< name
  std::string instance_hash;
  ResultRow base;
  ResultRow head;
};

struct PairedCell {
  CaseInfo parameters;  ///< of the head
  /// The planner of the base if its case is another; else empty.
  std::string base_planner;
  std::string base_run;  ///< UUID
  std::string head_run;
  /// Else a task beside planning, of the gate: whether its outcomes differ is compared, and no metric is of
  /// them.
  bool is_planning = true;
  bool same_machine = false;
  bool same_program = false;
  std::vector<PairedResult> results;
  std::size_t base_only = 0;  ///< results without a partner
  std::size_t head_only = 0;
};

/// The cases that both sides have finished, in order of environment, options and robots; the
/// results of each in order of position and repetition. A case that only one side has is paired with the only
/// one of the other side that has the same columns but for the planner; else with the only one that has some
/// of its instances and the same rules of motion. So planners are compared, and settings.
Result<std::vector<PairedCell>> paired_cells(Database& database, const ComparisonSide& base,
                                             const ComparisonSide& head);

}  // namespace sipplab::db
