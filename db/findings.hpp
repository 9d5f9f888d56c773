// Findings of fuzzing, each with a life of its own: new when first seen, reproduced when seen
// again, fixed when its input holds, regressed when it breaks once more.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/column_tags.hpp"
#include "db/database.hpp"
#include "db/fuzz_runs.hpp"
#include "db/sqlite/error.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// What broke, and the input that did it. Known by target and signature.
struct Finding {
  std::string target;
  std::string kind;     ///< claim, invariant, sanitizer, crash, timeout, memory, leak, flaky
  std::string claim;    ///< what did not hold
  std::string frames;   ///< innermost functions, " < " between; may be empty
  std::string message;  ///< one line
  std::string input;    ///< as it was found
  std::string minimal;  ///< the smallest that breaks the same; replays the finding
  std::optional<std::int64_t> robots;
  std::optional<std::int64_t> cells;

  std::string signature() const { return kind + " | " + claim + " | " + frames; }

  template <class Self, class Visit>
  static void columns(Self& self, Visit&& visit) {
    visit("target", self.target);
    visit("kind", self.kind);
    visit("claim", self.claim);
    visit("frames", self.frames);
    visit("message", self.message);
    visit("input", AsBlob{self.input});
    visit("minimal", AsBlob{self.minimal});
    visit("robots", self.robots);
    visit("cells", self.cells);
  }
};

/// A finding as it is stored.
struct StoredFinding {
  std::int64_t id = 0;
  Finding finding;
  std::string state;  ///< new, reproduced, fixed, regressed
  std::string first_utc;
  std::string last_utc;
  std::optional<std::string> first_commit;
  std::optional<std::string> last_commit;
  std::optional<std::string> fixed_commit;
  std::int64_t times_found = 0;

  template <class Self, class Visit>
  static void columns(Self& self, Visit&& visit) {
    visit("id", self.id);
    Finding::columns(self.finding, visit);
    visit("state", self.state);
    visit("first_utc", self.first_utc);
    visit("last_utc", self.last_utc);
    visit("first_commit", self.first_commit);
    visit("last_commit", self.last_commit);
    visit("fixed_commit", self.fixed_commit);
    visit("times_found", self.times_found);
  }
};

/// Stores it, or notes that it was found again: the state moves on, the smaller of two
/// minimal inputs stays. `fuzz_run` is the run that found it. Gives what is stored then.
Result<StoredFinding> record_finding(Database& database, const RunOrigin& origin, const Finding& finding,
                                     std::optional<std::int64_t> fuzz_run, const std::string& now_utc);

/// Takes the minimal input of a finding with this signature if it is smaller than the stored one.
Result<StoredFinding> record_minimal(Database& database, std::int64_t id, const Finding& finding);

/// Notes what replaying its minimal input gave: it breaks as before, or it holds.
Result<StoredFinding> record_replay(Database& database, const RunOrigin& origin, std::int64_t id, bool breaks,
                                    const std::string& now_utc);

/// All findings, or those that are not fixed; in order of their id.
Result<std::vector<StoredFinding>> list_findings(Database& database, bool open_only);

/// An error if there is none of that id.
Result<StoredFinding> find_finding(Database& database, std::int64_t id);

/// What happened to it, in turn: event, happened_utc, commit_hash.
Result<Table> finding_events(Database& database, std::int64_t id);

}  // namespace sipplab::db
