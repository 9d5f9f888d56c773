// What runs of other kinds leave in the history: lives of findings, runs of properties and of fuzzing, and
// what the doctor finds in files that somebody else wrote to.
#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "db/doctor.hpp"
#include "db/merge.hpp"
#include "db/queries.hpp"
#include "db/run_names.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_campaigns_laws {
namespace {

constexpr int kFewer = (kCasesOfHistories + 3) / 4;
constexpr int kFewest = (kCasesOfHistories + 7) / 8;

std::string utc(int minute) {
  return "2026-01-01T00:" + std::string(minute < 10 ? "0" : "") + std::to_string(minute) + ":00.000Z";
}

// --- findings -----------------------------------------------------------------------

/// A finding as its life says.
struct Life {
  std::string state = "new";
  std::int64_t times_found = 1;
  int first = 0, last = 0;
  std::optional<int> first_commit, last_commit, fixed_commit;
  std::string input, minimal;
  std::vector<std::string> events = {"found"};
};

std::optional<std::string> hash_of(const std::optional<int>& commit) {
  return commit ? std::optional(commit_number(*commit).hash) : std::nullopt;
}

void see(Life& life, bool breaks, int minute, const std::optional<int>& commit) {
  const std::string before = life.state;
  if (breaks) {
    // What was fixed once and breaks again has regressed for good.
    life.state = before == "fixed" || before == "regressed" ? "regressed" : "reproduced";
    life.last = minute;
    life.last_commit = commit;
    life.fixed_commit.reset();
  } else {
    if (before != "fixed") life.fixed_commit = commit;
    life.state = "fixed";
  }
  if (life.state != before) life.events.push_back(life.state);
}

void findings_live_as_they_are_seen() {
  const NewHistory history;
  Database database = history.open();
  std::map<std::string, Life> lives;  // by target and kind
  const auto steps = static_cast<int>(any_whole(4, 16));
  for (int minute = 0; minute < steps; ++minute) {
    Finding finding = any_finding();
    // Mostly the same one, so that its life is long.
    if (any_whole(0, 3) > 0) finding.target = "plan";
    if (any_whole(0, 3) > 0) finding.kind = "claim";
    const std::string key = finding.target + ' ' + finding.kind;
    RunOrigin origin = any_origin();
    std::optional<int> commit;
    for (int number = 1; number <= 3; ++number) {
      if (origin.commit && origin.commit->hash == commit_number(number).hash) commit = number;
    }
    const auto known = lives.find(key);
    StoredFinding stored;
    if (known == lives.end()) {
      stored = must(record_finding(database, origin, finding, std::nullopt, utc(minute)));
      Life life;
      life.first = life.last = minute;
      life.first_commit = life.last_commit = commit;
      life.input = finding.input;
      life.minimal = finding.minimal;
      lives[key] = life;
    } else {
      Life& life = known->second;
      std::int64_t id = 0;
      for (const StoredFinding& one : must(list_findings(database, false))) {
        if (one.finding.target + ' ' + one.finding.kind == key) id = one.id;
      }
      const auto what = any_whole(0, 2);
      if (what == 0) {
        stored = must(record_finding(database, origin, finding, std::nullopt, utc(minute)));
        ++life.times_found;
        see(life, true, minute, commit);
        if (finding.minimal.size() < life.minimal.size()) life.minimal = finding.minimal;
      } else if (what == 1) {
        const bool breaks = any_flag();
        stored = must(record_replay(database, origin, id, breaks, utc(minute)));
        see(life, breaks, minute, commit);
      } else {
        stored = must(record_minimal(database, id, finding));
        if (finding.minimal.size() < life.minimal.size()) life.minimal = finding.minimal;
      }
    }
    const Life& life = lives.at(key);
    RC_LOG() << key << " is " << stored.state << ", expected " << life.state << '\n';
    RC_ASSERT(stored.state == life.state);
    RC_ASSERT(stored.times_found == life.times_found);
    RC_ASSERT(stored.first_utc == utc(life.first));
    RC_ASSERT(stored.last_utc == utc(life.last));
    RC_ASSERT(stored.first_commit == hash_of(life.first_commit));
    RC_ASSERT(stored.last_commit == hash_of(life.last_commit));
    RC_ASSERT(stored.fixed_commit == hash_of(life.fixed_commit));
    RC_ASSERT(stored.finding.input == life.input);
    RC_ASSERT(stored.finding.minimal == life.minimal);
    std::vector<std::string> events;
    for (const auto& row : must(finding_events(database, stored.id)).rows)
      events.push_back(std::get<std::string>(row[0]));
    RC_ASSERT(events == life.events);
  }
  const auto listed = must(list_findings(database, false));
  RC_ASSERT(listed.size() == lives.size());
  const auto open = std::count_if(lives.begin(), lives.end(),
                                  [](const auto& life) { return life.second.state != "fixed"; });
  RC_ASSERT(must(list_findings(database, true)).size() == static_cast<std::size_t>(open));
}

/// One finding in two files: together it is what its whole life says, whichever file is merged into which.
void lives_of_findings_come_together() {
  const NewHistory files[2];
  Finding finding = any_finding();
  bool reproduced = false;
  std::optional<int> fixed;
  int last = 0;
  int first = 100;
  std::size_t shortest = 100;
  for (int number = 0; number < 2; ++number) {
    Database database = files[number].open();
    // Each file its own minutes, so that no two things happen at once.
    int minute = number + static_cast<int>(any_whole(0, 3)) * 2;
    first = std::min(first, minute);
    finding.minimal.resize(static_cast<std::size_t>(any_whole(1, 3)), 'x');
    shortest = std::min(shortest, finding.minimal.size());
    const StoredFinding stored =
        must(record_finding(database, any_origin(), finding, std::nullopt, utc(minute)));
    last = std::max(last, minute);
    std::string state = "new";
    for (auto left = any_whole(0, 3); left > 0; --left) {
      minute += 2 * static_cast<int>(any_whole(1, 4));
      const bool breaks = any_flag();
      state = must(record_replay(database, any_origin(), stored.id, breaks, utc(minute))).state;
      if (breaks) last = std::max(last, minute);
      if (state == "reproduced") reproduced = true;
      // Of holding again and again the first time is when it was fixed.
      if (!breaks &&
          ask(database, "SELECT count(*) FROM finding_event WHERE event = 'fixed' AND happened_utc = '" +
                            utc(minute) + "'") == 1)
        fixed = std::max(fixed.value_or(0), minute);
    }
  }
  const std::string expected = !fixed          ? (reproduced ? "reproduced" : "new")
                               : last > *fixed ? "regressed"
                                               : "fixed";
  for (int number = 0; number < 2; ++number) {
    const NewHistory joined;
    Database database = joined.open();
    must(merge_into(database, files[number].path()));
    must(merge_into(database, files[1 - number].path()));
    const StoredFinding stored = must(list_findings(database, false)).at(0);
    RC_LOG() << stored.state << ", expected " << expected << '\n';
    RC_ASSERT(stored.state == expected);
    RC_ASSERT(stored.last_utc == utc(last));
    RC_ASSERT(stored.first_utc == utc(first));
    RC_ASSERT(stored.fixed_commit.has_value() ==
              (expected == "fixed" &&
               ask(database, "SELECT count(*) FROM finding_event WHERE event = 'fixed' AND happened_utc = '" +
                                 utc(fixed.value_or(0)) + "' AND commit_id IS NOT NULL") == 1));
    RC_ASSERT(stored.finding.minimal.size() == shortest);
  }
}

// --- properties ---------------------------------------------------------------------

void runs_of_properties_are_kept_once() {
  const NewHistory history;
  Database database = history.open();
  struct Kept {
    PropertyRun run;
    std::string mutant;
  };
  std::map<std::string, Kept> kept;  // by UUID
  std::vector<std::string> order;
  for (auto left = any_whole(1, 7); left > 0; --left) {
    PropertyRun run = any_property_run();
    // Now and then one of those that are there, as it was, or ended after all.
    if (!order.empty() && any_whole(0, 2) == 0)
      run.uuid = order[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(order.size()) - 1))];
    const std::string mutant = any_whole(0, 3) == 0 ? "a-mutant" : "";
    const auto known = kept.find(run.uuid);
    const bool replaces =
        known != kept.end() && known->second.run.status == "crashed" && run.status != "crashed";
    const PropertyRecorded recorded = must(record_property_runs(database, any_origin(), {run}, mutant));
    RC_ASSERT(recorded.added == (known == kept.end() || replaces ? 1U : 0U));
    RC_ASSERT(recorded.known == 1 - recorded.added);
    if (recorded.added == 0) continue;
    std::erase(order, run.uuid);
    order.push_back(run.uuid);
    kept[run.uuid] = {run, mutant};
  }
  std::map<std::string, std::int64_t> ids;
  for (const auto& row : rows_of(database, "SELECT property_run, id FROM v_property_runs").rows)
    ids[std::get<std::string>(row[0])] = std::get<std::int64_t>(row[1]);
  RC_ASSERT(ids.size() == kept.size());
  for (const auto& [uuid, one] : kept) {
    const PropertyReport report = must(show_property_run(database, ids.at(uuid)));
    std::string said;
    std::string meant;
    const auto put_into = [](std::string& text) {
      return [&text](const char* name, const auto& value) {
        using T = std::decay_t<decltype(value)>;
        text += name;
        if constexpr (std::is_same_v<T, std::optional<std::int64_t>>)
          text += value ? std::to_string(*value) : "none";
        else if constexpr (std::is_same_v<T, std::string>)
          text += value;
        else if constexpr (std::is_arithmetic_v<T>)
          text += std::to_string(value);
        else
          text += value.text;
      };
    };
    PropertyRun::origin_columns(report.run, put_into(said));
    PropertyRun::columns(report.run, put_into(said));
    PropertyRun::origin_columns(one.run, put_into(meant));
    PropertyRun::columns(one.run, put_into(meant));
    RC_ASSERT(said == meant);
    RC_ASSERT(report.run.classes == one.run.classes);
    RC_ASSERT(report.mutant == one.mutant);
  }
  // Of each property the newest without a planted bug.
  const auto is_newer = [&](const std::string& a, const std::string& b) {
    return std::tuple(kept.at(a).run.started_utc, ids.at(a)) >
           std::tuple(kept.at(b).run.started_utc, ids.at(b));
  };
  std::map<std::pair<std::string, std::string>, std::string> newest;
  std::optional<std::string> failed;
  for (const auto& [uuid, one] : kept) {
    if (!one.mutant.empty()) continue;
    const auto [place, is_new] = newest.try_emplace({one.run.room, one.run.title}, uuid);
    if (!is_new && is_newer(uuid, place->second)) place->second = uuid;
    if (one.run.status == "failed" && (!failed || is_newer(uuid, *failed))) failed = uuid;
  }
  const auto latest = latest_property_failure(database);
  RC_ASSERT(latest.has_value() == failed.has_value());
  if (latest) RC_ASSERT(*latest == ids.at(*failed));
  PropertyFilter filter;
  if (any_flag()) filter.room = any_flag() ? "grid" : "search";
  filter.failed = any_flag();
  filter.every_run = any_flag();
  filter.limit = static_cast<std::size_t>(any_whole(0, 3));
  std::vector<std::string> candidates;
  if (filter.every_run) {
    for (const auto& [uuid, one] : kept) candidates.push_back(uuid);
    std::sort(candidates.begin(), candidates.end(), is_newer);
  } else {
    for (const auto& [property, uuid] : newest) candidates.push_back(uuid);
  }
  std::vector<std::int64_t> expected;
  for (const std::string& uuid : candidates) {
    const PropertyRun& run = kept.at(uuid).run;
    const bool fits = run.room == filter.room.value_or(run.room) &&
                      (!filter.failed || run.status == "failed" || run.status == "crashed");
    if (fits && (filter.limit == 0 || expected.size() < filter.limit)) expected.push_back(ids.at(uuid));
  }
  std::vector<std::int64_t> found;
  for (const auto& row : must(list_property_runs(database, filter)).rows)
    found.push_back(std::get<std::int64_t>(row[0]));
  RC_ASSERT(found == expected);
}

// --- fuzzing ------------------------------------------------------------------------

void a_clean_program_is_known() {
  const NewHistory history;
  Database database = history.open();
  std::vector<FuzzRun> runs;
  for (auto left = any_whole(0, 4); left > 0; --left) {
    FuzzRun run = any_fuzz_run();
    run.budget_s = 10;
    if (any_flag()) run.target_hash = "hash 1";
    if (any_flag()) run.status = "clean";
    must(record_fuzz_run(database, any_origin(), run));
    runs.push_back(run);
  }
  for (const char* target : {"plan", "parse"}) {
    const auto is_it = [&](const FuzzRun& run) {
      return run.target == target && run.target_hash == "hash 1";
    };
    const bool has_findings = std::any_of(
        runs.begin(), runs.end(), [&](const FuzzRun& run) { return is_it(run) && run.status == "findings"; });
    // For a time, all of which was used if an input seemed slow.
    const bool has_run = std::any_of(runs.begin(), runs.end(), [&](const FuzzRun& run) {
      return is_it(run) && run.status == "clean" && run.mode != "smoke" &&
             (run.timeouts == 0 || static_cast<double>(run.wall_time_ns) / 1e9 >= 9);
    });
    RC_ASSERT(must(is_fuzzed_clean(database, target, "hash 1")) == (has_run && !has_findings));
  }
  FuzzRunFilter filter;
  if (any_flag()) filter.target = any_flag() ? "plan" : "parse";
  filter.limit = static_cast<std::size_t>(any_whole(0, 3));
  std::size_t fitting = 0;
  for (const FuzzRun& run : runs) fitting += run.target == filter.target.value_or(run.target) ? 1U : 0U;
  const Table listed = must(list_fuzz_runs(database, filter));
  RC_ASSERT(listed.rows.size() == (filter.limit == 0 ? fitting : std::min(fitting, filter.limit)));
  std::string last = "9999";
  for (const auto& row : listed.rows) {
    RC_ASSERT(std::get<std::string>(row[1]) <= last);
    last = std::get<std::string>(row[1]);
  }
}

// --- runs ---------------------------------------------------------------------------

/// Lists of runs by what is asked for, newest first.
void lists_of_runs_are_narrowed() {
  const NewHistory history;
  record_some_of_everything(history.path());
  Database database = history.open();
  for (const std::string& run : all_runs(database)) {
    if (any_whole(0, 3) == 0) must(exclude_run(database, run, "noise"));
  }
  RunFilter filter;
  if (any_flag())
    filter.kind = std::vector<std::string>{
        "sweep", "report", "property", "fuzz", "gate", "all"}[static_cast<std::size_t>(any_whole(0, 5))];
  if (any_flag())
    filter.suite =
        std::vector<std::string>{"smoke", "micro", "plan", "gate"}[static_cast<std::size_t>(any_whole(0, 3))];
  filter.include_excluded = any_flag();
  filter.limit = static_cast<std::size_t>(any_whole(0, 3));
  std::vector<std::string> expected;
  for (const auto& row : rows_of(database,
                                 "SELECT uuid, kind, suite, excluded_reason IS NULL, started_utc FROM run "
                                 "ORDER BY started_utc DESC, id DESC")
                             .rows) {
    const auto& kind = std::get<std::string>(row[1]);
    const bool is_kind =
        filter.kind ? *filter.kind == "all" || *filter.kind == kind : kind == "sweep" || kind == "report";
    const bool fits = is_kind &&
                      std::get<std::string>(row[2]) == filter.suite.value_or(std::get<std::string>(row[2])) &&
                      (filter.include_excluded || std::get<std::int64_t>(row[3]) == 1);
    if (fits && (filter.limit == 0 || expected.size() < filter.limit))
      expected.push_back(std::get<std::string>(row[0]));
  }
  std::vector<std::string> found;
  std::string last = "9999";
  for (const RunSummary& run : must(list_runs(database, filter))) {
    found.push_back(run.uuid);
    RC_ASSERT(run.started_utc <= last);
    last = run.started_utc;
  }
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  RC_ASSERT(found == expected);
}

// --- the doctor ---------------------------------------------------------------------

struct Damage {
  const char* check;  ///< that is to find it
  const char* sql;
  bool fixable;
};
constexpr Damage kDamages[] = {
    {"schema", "DROP VIEW v_slowest", false},
    {"schema", "DROP INDEX attempt_by_run", false},
    {"foreign keys", "UPDATE run SET build_id = 99 WHERE id = 1", false},
    {"foreign keys", "DELETE FROM machine", false},
    {"results", "UPDATE cell SET result_count = result_count + 1", false},
    {"results", "DELETE FROM progress; DELETE FROM retiming; DELETE FROM reported; DELETE FROM result",
     false},
    {"summaries", "UPDATE cell_summary SET mean_tries = mean_tries + 1", true},
    {"summaries", "UPDATE cell_summary SET max_planning_time_s = 2 * max_planning_time_s", true},
    {"summaries", "UPDATE cell_summary SET mean_solved_time_s = ifnull(mean_solved_time_s, 0) + 1", true},
    {"summaries", "UPDATE cell_summary SET median_time_to_solve_s = ifnull(median_time_to_solve_s, 0) + 1",
     true},
    {"summaries", "UPDATE cell_summary SET solved = solved + 1, failed = failed - 1 WHERE failed > 0", true},
    {"summaries", "DELETE FROM cell_summary", true},
    {"summaries", "UPDATE instance_summary SET results = results + 1", true},
    {"summaries", "UPDATE instance_summary SET solved_time_ns = solved_time_ns + 1", true},
    {"unfinished runs",
     "UPDATE run SET status = 'running', ended_utc = NULL, writer = 'nobody' WHERE kind = 'sweep'", true},
    {"empty runs",
     "INSERT INTO run (uuid, kind, suite, started_utc, ended_utc, status, outcome, machine_id, build_id, "
     "branch, command_line, options, seed, "
     "time_limit_s, writer, origin, shard) SELECT '00000000-0000-4000-8000-000000000009', 'sweep', suite, "
     "started_utc, started_utc, 'aborted', '', machine_id, "
     "build_id, branch, command_line, options, seed, time_limit_s, writer, '', '' FROM run WHERE id = 1",
     true}};

void the_doctor_finds_each_damage() {
  const NewHistory history;
  Sweep sweep = any_sweep();
  Planned planned{case_number(0), instance_number(7), any_result()};
  planned.row.position = 70;
  planned.row.status = ResultStatus::kFailed;
  sweep.plannings.push_back(planned);
  planned.row.position = 71;
  planned.row.status = ResultStatus::kLimit;
  sweep.plannings.push_back(planned);
  record(history.path(), sweep);
  Database database = history.open();
  const Damage& damage = kDamages[any_whole(0, static_cast<std::int64_t>(std::size(kDamages)) - 1)];
  RC_LOG() << damage.sql << '\n';
  must(database.connection().execute("PRAGMA foreign_keys = OFF", "damaging"));
  must(database.connection().execute(damage.sql, "damaging"));
  DoctorOptions options;
  const DoctorReport report = examine(database, options);
  RC_ASSERT(!report.sound());
  const auto found =
      std::find_if(report.findings.begin(), report.findings.end(),
                   [&](const DoctorFinding& finding) { return finding.check == damage.check; });
  RC_ASSERT(found != report.findings.end());
  RC_ASSERT(found->fixable == damage.fixable);
  RC_ASSERT(!found->fixed);
  options.fix = true;
  const DoctorReport fixing = examine(database, options);
  RC_ASSERT(fixing.sound() == damage.fixable);
}

void the_doctor_finds_nothing_where_nothing_is() {
  const NewHistory history;
  Sweep sweep = any_sweep();
  sweep.plannings.push_back({case_number(0), instance_number(7), any_result()});
  sweep.plannings.back().row.position = 70;
  record(history.path(), sweep);
  Database database = history.open();
  DoctorOptions options;
  options.quick = any_flag();
  const DoctorReport report = examine(database, options);
  for (const DoctorFinding& finding : report.findings)
    RC_LOG() << finding.check << ": " << finding.what << '\n';
  RC_ASSERT(report.sound());
  RC_ASSERT(report.findings.empty());
}

const PropertyRoom room("history_campaigns", kCasesOfHistories, [] {
  bool passed = true;

  passed &=
      property("a finding lives as it is seen to break and to hold", findings_live_as_they_are_seen, kFewer);
  passed &=
      property("the lives of a finding in two files come together", lives_of_findings_come_together, kFewest);
  passed &= property("a run of a property is kept once, and a crash until its end is known",
                     runs_of_properties_are_kept_once, kFewer);
  passed &= property("a program is clean if it ran for its time without findings", a_clean_program_is_known,
                     kFewer);
  passed &= property("runs are listed by kind, suite and exclusion, newest first", lists_of_runs_are_narrowed,
                     kFewest);
  passed &= property("the doctor finds each damage, and mends what can be mended",
                     the_doctor_finds_each_damage, kFewest);
  passed &=
      property("the doctor finds nothing where nothing is", the_doctor_finds_nothing_where_nothing_is, 3);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_campaigns_laws
