// How a history comes about: runs that are interrupted, taken over, excluded and taken up
// again, against lists of what was done. What one run holds is checked in history.cpp.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/migrate.hpp"
#include "db/queries.hpp"
#include "db/recorder.hpp"
#include "db/sqlite/statement.hpp"
#include "db/statistics/statistics.hpp"
#include "db/tests/plain_case.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/texts.hpp"

namespace sipplab::db::recording_laws {
namespace {

namespace fs = std::filesystem;

CaseInfo the_case(int number) {
  CaseInfo info = test::plain_case();
  info.robots = number;
  return info;
}

RunInfo the_run(const std::string& suite) {
  RunInfo info;
  info.suite = suite;
  info.machine.host = "host";
  info.build.compiler = "gcc";
  return info;
}

InstanceInfo the_instance(int number) {
  InstanceInfo info;
  info.content_hash = "instance " + std::to_string(number);
  return info;
}

/// The planning of one instance of a case.
void add_planning(RunRecorder& recorder, int number, int position) {
  ResultRow row;
  row.position = position;
  recorder.add(the_case(number), the_instance(position), row);
}

// --- interruptions ------------------------------------------------------------------

constexpr int kMostSessions = 3;

/// What one start of a sweep gets done before it is interrupted.
struct Session {
  int plannings = 0;        ///< that it commits
  bool begins_one = false;  ///< of which nothing may be kept
  bool aborted = false;     ///< ended by its user, else killed
};

Session any_session() {
  return {*rc::gen::inRange(0, 7), *rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()};
}

void ends_as_if_never_interrupted() {
  const NewHistory history;
  const fs::path path = history.path();
  const int cases = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 5));
  const int instances = *rc::gen::inRange(1, 4);
  std::set<std::pair<int, int>> left;
  for (int number = 0; number < cases; ++number) {
    for (int position = 0; position < instances; ++position) left.emplace(number, position);
  }
  std::string uuid;
  int sessions = 0;
  for (bool finished = false; !finished; ++sessions) {
    // The last one of many does all that is left.
    const Session session =
        sessions < kMostSessions ? any_session() : Session{cases * instances, false, false};
    Database database = must(Database::open(path));
    const auto found = must(find_earlier_run(database, the_run("smoke")));
    RC_ASSERT(found.has_value() == (sessions > 0));
    if (found) {
      RC_ASSERT(found->uuid == uuid);
      RC_ASSERT(static_cast<std::size_t>(found->results) + left.size() ==
                static_cast<std::size_t>(cases * instances));
      for (const RecordedCase& recorded : must(recorded_cases(database, uuid))) {
        for (const ResultRow& row : recorded.rows) {
          for (int number = 0; number < cases; ++number) {
            const std::pair planning{number, static_cast<int>(row.position)};
            RC_ASSERT(!(recorded.parameters == the_case(number) && left.count(planning) > 0));
          }
        }
      }
    }
    RunRecorder recorder = must(found ? RunRecorder::resume(std::move(database), uuid, the_run("smoke"))
                                      : RunRecorder::begin(std::move(database), the_run("smoke")));
    uuid = recorder.run_uuid();
    // In batches of any size, in which cases interleave.
    for (int done = 0; done < session.plannings && !left.empty(); ++done) {
      const auto next = std::next(left.begin(), *rc::gen::inRange(0, static_cast<int>(left.size())));
      add_planning(recorder, next->first, next->second);
      left.erase(next);
      if (*rc::gen::arbitrary<bool>()) must(recorder.commit());
    }
    must(recorder.commit());
    if (session.begins_one) add_planning(recorder, cases, 0);
    finished = left.empty();
    if (finished) {
      must(recorder.finish(RunStatus::kFinished));
    } else if (session.aborted) {
      must(recorder.finish(RunStatus::kAborted));
    } else {
      // As after a kill: the writer lives no more.
      Database killed = must(Database::open(path));
      must(killed.connection().execute("UPDATE run SET writer = ''", "ending a process"));
    }
  }
  Database database = must(Database::open(path));
  RC_ASSERT(must(find_earlier_run(database, the_run("smoke")))->status == RunStatus::kFinished);
  RC_ASSERT(ask(database, "SELECT count(*) FROM run") == 1);
  RC_ASSERT(ask(database, "SELECT count(*) FROM attempt") == sessions);
  // Whatever ended them, all attempts but the last are known to be over before the end.
  RC_ASSERT(ask(database, "SELECT count(*) FROM attempt WHERE status = 'finished'") == 1);
  RC_ASSERT(ask(database, "SELECT count(*) FROM attempt WHERE status = 'aborted'") == sessions - 1);
  RC_ASSERT(ask(database, "SELECT count(*) FROM result WHERE attempt_id IS NULL") == 0);
  RC_ASSERT(ask(database, "SELECT count(*) FROM v_results") == cases * instances);
  RC_ASSERT(ask(database,
                "SELECT count(*) FROM cell WHERE result_count <> (SELECT count(*) FROM result "
                "WHERE cell_id = cell.id)") == 0);
  RC_ASSERT(must(recorded_cases(database, uuid)).size() == static_cast<std::size_t>(cases));
  RC_CLASSIFY(sessions > 1, "resumed");
}

void resumes_only_its_like() {
  const NewHistory history;
  const fs::path path = history.path();
  {
    RunRecorder recorder = must(RunRecorder::begin(must(Database::open(path)), the_run("smoke")));
    must(recorder.finish(RunStatus::kAborted));
  }
  RunInfo info = the_run("smoke");
  const std::vector<std::string*> texts = {
      &info.suite,       &info.options,          &info.build.compiler,   &info.build.compiler_version,
      &info.build.flags, &info.build.build_type, &info.build.sanitizers, &info.build.binary_hash};
  Database database = must(Database::open(path));
  RC_ASSERT(must(find_earlier_run(database, info)).has_value());
  const auto which = *rc::gen::inRange<std::size_t>(0, texts.size() + 3);
  if (which < texts.size()) {
    *texts[which] += " and more";
  } else if (which == texts.size()) {
    info.build.assertions = !info.build.assertions;
  } else if (which == texts.size() + 1) {
    info.build.dirty = !info.build.dirty;
  } else {
    must(exclude_run(database, "latest", "noise"));
  }
  RC_ASSERT(!must(find_earlier_run(database, info)).has_value());
}

/// Of several the newest that is not finished, else the newest; of one that was asked for, that one.
void resumes_the_newest_unfinished() {
  const NewHistory history;
  struct Run {
    std::string uuid;
    bool finished, excluded, merged;
  };
  std::vector<Run> runs;
  for (auto left = any_whole(0, 4); left > 0; --left) {
    RunRecorder recorder = must(RunRecorder::begin(history.open(), the_run("smoke")));
    Run run{recorder.run_uuid(), any_flag(), any_whole(0, 3) == 0, any_whole(0, 3) == 0};
    add_planning(recorder, 1, 0);
    must(recorder.commit());
    must(recorder.finish(run.finished ? RunStatus::kFinished : RunStatus::kAborted));
    Database database = history.open();
    if (run.excluded) must(exclude_run(database, run.uuid, "noise"));
    if (run.merged)
      must(database.connection().execute("UPDATE run SET origin = 'other.db' WHERE uuid = '" + run.uuid + "'",
                                         "merging"));
    runs.push_back(run);
  }
  std::optional<Run> expected;
  for (const Run& run : runs) {
    if (run.excluded || run.merged) continue;
    if (!expected || !run.finished || expected->finished) expected = run;
  }
  Database database = history.open();
  const auto found = must(find_earlier_run(database, the_run("smoke")));
  RC_ASSERT(found.has_value() == expected.has_value());
  if (found) {
    RC_ASSERT(found->uuid == expected->uuid);
    RC_ASSERT(found->status == (expected->finished ? RunStatus::kFinished : RunStatus::kAborted));
    RC_ASSERT(found->results == 1);
    RC_ASSERT(!found->being_written);
    RC_ASSERT(found->has_shard);
    RunInfo other = the_run("smoke");
    other.shard = "2/3";
    RC_ASSERT(!must(find_earlier_run(database, other))->has_shard);
  }
  for (const Run& run : runs)
    RC_ASSERT(must(find_earlier_run(database, the_run("smoke"), run.uuid))->uuid == run.uuid);
  for (const Run& run : runs)
    RC_ASSERT(!find_earlier_run(database, the_run("density"), run.uuid).has_value());
}

void has_one_writer() {
  const NewHistory history;
  const fs::path path = history.path();
  RunRecorder recorder = must(RunRecorder::begin(must(Database::open(path)), the_run("smoke")));
  const int before = *rc::gen::inRange(0, 3);
  for (int number = 0; number < before; ++number) {
    add_planning(recorder, number, 0);
    must(recorder.commit());
  }
  Database other = must(Database::open(path));
  must(other.connection().execute("UPDATE run SET writer = writer || ', another one'", "taking over"));
  add_planning(recorder, before, 0);
  RC_ASSERT(!recorder.commit().has_value());
  RC_ASSERT(!recorder.finish(RunStatus::kFinished).has_value());
  RC_ASSERT(ask(other, "SELECT count(*) FROM v_results") == before);
  RC_ASSERT(ask(other, "SELECT count(*) FROM run WHERE status = 'running'") == 1);
}

void writes_batches_whole() {
  const NewHistory history;
  const fs::path path = history.path();
  RunRecorder recorder = must(RunRecorder::begin(must(Database::open(path)), the_run("smoke")));
  std::int64_t expected = 0;
  int refused = 0;
  for (int batch = 0; batch < 3; ++batch) {
    const int plannings = *rc::gen::inRange(0, 5);
    // Each batch has positions of its own, dealt out to two cases.
    for (int i = 0; i < plannings; ++i) add_planning(recorder, i % 2, 10 * batch + i);
    const bool twice = plannings > 0 && *rc::gen::arbitrary<bool>();
    if (twice) add_planning(recorder, 0, 10 * batch);
    RC_ASSERT(recorder.commit().has_value() == !twice);
    refused += twice;
    if (!twice) expected += plannings;
    Database database = must(Database::open(path));
    RC_ASSERT(ask(database, "SELECT count(*) FROM result") == expected);
    RC_ASSERT(ask(database, "SELECT ifnull(sum(results), 0) FROM cell_summary") == expected);
    if (twice) recorder.discard();
  }
  RC_CLASSIFY(refused > 0, "some refused");
}

// --- what is kept of commits, limits and exclusions ---------------------------------

constexpr std::size_t kMostCommits = 3;

void known_counts_stay() {
  const NewHistory history;
  const fs::path path = history.path();
  const auto commits = *rc::gen::container<std::vector<std::pair<int, bool>>>(
      kMostCommits, rc::gen::pair(rc::gen::inRange(1, 3), rc::gen::arbitrary<bool>()));
  std::map<int, bool> known;
  for (const auto& [number, shallow] : commits) {
    RunInfo info = the_run("smoke");
    const std::int64_t count = shallow ? 0 : 10 * number;
    CommitInfo commit;
    commit.hash = "0123456789abcdef" + std::to_string(number);
    commit.ancestor_count = count;
    commit.first_parent_count = count;
    info.commit = commit;
    must(RunRecorder::begin(must(Database::open(path)), info));
    known[number] = known[number] || !shallow;
  }
  Database database = must(Database::open(path));
  for (const auto& [number, is_known] : known) {
    const std::string of = " FROM commit_ WHERE hash = '0123456789abcdef" + std::to_string(number) + "'";
    RC_ASSERT(ask(database, "SELECT ancestor_count" + of) == (is_known ? 10 * number : 0));
    RC_ASSERT(ask(database, "SELECT first_parent_count" + of) == (is_known ? 10 * number : 0));
  }
}

/// Counts around the largest that SQL can hold.
std::uint64_t any_huge_count() { return kNoCountLimit - 2 + *rc::gen::inRange<std::uint64_t>(0, 5); }

void huge_counts_are_no_limit() {
  const NewHistory history;
  const fs::path path = history.path();
  RunRecorder recorder = must(RunRecorder::begin(must(Database::open(path)), the_run("smoke")));
  const CaseInfo info = the_case(1);
  ResultRow row;
  row.expansions = any_huge_count();
  row.generations = any_huge_count();
  recorder.add(info, the_instance(1), row);
  must(recorder.commit());
  Database database = must(Database::open(path));
  RC_ASSERT(must(recorded_cases(database, recorder.run_uuid())).front().parameters == info);
  RC_ASSERT(static_cast<std::uint64_t>(ask(database, "SELECT expansions FROM result")) ==
            std::min(row.expansions, kNoCountLimit));
  RC_ASSERT(static_cast<std::uint64_t>(ask(database, "SELECT generations FROM result")) ==
            std::min(row.generations, kNoCountLimit));
}

void exclusion_hides_and_comes_back() {
  const NewHistory history;
  const fs::path path = history.path();
  std::vector<std::string> uuids;
  for (int i = 0; i < 2; ++i) {
    RunRecorder recorder = must(RunRecorder::begin(must(Database::open(path)), the_run("smoke")));
    must(recorder.finish(RunStatus::kFinished));
    uuids.push_back(recorder.run_uuid());
  }
  Database database = must(Database::open(path));
  std::set<std::string> excluded;
  const auto steps = *rc::gen::container<std::vector<std::pair<int, bool>>>(
      rc::gen::pair(rc::gen::inRange(0, 2), rc::gen::arbitrary<bool>()));
  for (const auto& [which, out] : steps) {
    const std::string& uuid = uuids[static_cast<std::size_t>(which)];
    // A run is excluded once, and taken back once: the rest is an error and changes nothing.
    if (out && excluded.count(uuid) == 0) {
      must(exclude_run(database, uuid, "noise"));
      excluded.insert(uuid);
    } else if (!out && excluded.count(uuid) > 0) {
      must(include_run(database, uuid));
      excluded.erase(uuid);
    }
  }
  std::set<std::string> listed;
  for (const RunSummary& run : must(list_runs(database))) listed.insert(run.uuid);
  for (const std::string& uuid : uuids) RC_ASSERT(listed.count(uuid) == 1 - excluded.count(uuid));
  RunFilter all;
  all.include_excluded = true;
  RC_ASSERT(must(list_runs(database, all)).size() == uuids.size());
  RC_ASSERT(resolve_run(database, "latest").has_value() == (excluded.size() < uuids.size()));
  RC_CLASSIFY(!excluded.empty(), "some excluded");
}

void newer_schemas_are_refused() {
  const NewHistory history;
  const fs::path path = history.path();
  const int version = Database::latest_schema_version() + *rc::gen::inRange(1, 100);
  {
    auto connection = must(sqlite::Connection::open(path, sqlite::OpenMode::kReadWrite));
    must(connection.execute("PRAGMA user_version = " + std::to_string(version), "ageing"));
  }
  for (const auto& opened : {Database::open(path), Database::open_read_only(path)}) {
    RC_ASSERT(!opened.has_value());
    RC_ASSERT(opened.error().kind == ErrorKind::kNewerSchema);
  }
  auto connection = must(sqlite::Connection::open(path, sqlite::OpenMode::kReadWrite));
  RC_ASSERT(must(connection.query_int("PRAGMA user_version", "asking")) == version);
}

// --- statistics ---------------------------------------------------------------------

/// The quantile by its definition: values as equally spaced points of a broken line.
double on_the_line(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double steps = static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    const double left = static_cast<double>(i) / steps;
    const double right = static_cast<double>(i + 1) / steps;
    if (p > right) continue;
    const double part = (p - left) / (right - left);
    return values[i] * (1 - part) + values[i + 1] * part;
  }
  return values.back();
}

void quantiles_are_on_the_line() {
  const auto sixteenths = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-99, 99)));
  std::vector<double> values;
  for (const int number : sixteenths) values.push_back(number / 16.0);
  const double p = *rc::gen::inRange(0, 65) / 64.0;
  const auto quantile = statistics::quantile(values, p);
  RC_ASSERT(quantile.has_value());
  RC_ASSERT(std::abs(*quantile - on_the_line(values, p)) < 1e-9);
  RC_ASSERT(*statistics::median(values) == *statistics::quantile(values, 0.5));
  RC_ASSERT(!statistics::quantile({}, p).has_value());
}

const PropertyRoom room("recording", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("a run that is resumed any number of times ends as if it was never interrupted",
                     ends_as_if_never_interrupted);
  passed &= property("a run is resumed by its like only, and not once it is excluded", resumes_only_its_like);
  passed &= property("the newest run that is not finished is resumed first", resumes_the_newest_unfinished);
  passed &= property("a run that another process took over is not written to", has_one_writer);
  passed &= property("a batch is recorded whole or not at all", writes_batches_whole);
  passed &= property("what is known of a commit's place in history is not forgotten", known_counts_stay);
  passed &=
      property("counts that SQL cannot hold are no limit, and none turns negative", huge_counts_are_no_limit);
  passed &= property("excluded runs are left out until they are taken back", exclusion_hides_and_comes_back);
  passed &=
      property("a history of any newer schema is refused and stays as it is", newer_schemas_are_refused);
  passed &= property("a quantile lies on the line through the sorted values", quantiles_are_on_the_line);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::recording_laws
