// Histories that come together: whatever lies in whichever file, in whatever order they are merged and how
// often, what is there in the end is the same. Files are compared row by row, keys replaced by what they
// stand for.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "db/best_known.hpp"
#include "db/comparisons.hpp"
#include "db/merge.hpp"
#include "db/queries.hpp"
#include "db/run_names.hpp"
#include "db/summaries.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_merge_laws {
namespace {

/// Each makes, merges and reads several files: few of them.
constexpr int kManyFiles = (kCasesOfHistories + 19) / 20;

// --- files as text ------------------------------------------------------------------

/// What says in which file and when something was written, and no more.
const std::set<std::string> kOfTheFile = {"origin", "writer", "imported_utc", "finished_utc", "machine_load"};

/// Every row of every table as text, integer keys replaced by the rows that they stand for.
class Content {
 public:
  explicit Content(Database& database) : database_(database) {
    for (const auto& row :
         rows_of(database, "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%'")
             .rows) {
      tables_.push_back(std::get<std::string>(row[0]));
    }
  }

  std::map<std::string, std::multiset<std::string>> all() {
    std::map<std::string, std::multiset<std::string>> content;
    for (const std::string& table : tables_) {
      for (const auto& [id, text] : rows(table)) content[table].insert(text);
    }
    return content;
  }

 private:
  /// The table whose key a column holds; empty if it holds none.
  std::string target(const std::string& column) const {
    if (column.size() < 4 || column.substr(column.size() - 3) != "_id" || column == "type_id") return "";
    const std::string stem = column.substr(0, column.size() - 3);
    for (const std::string& table : tables_) {
      if (table == stem || table == stem + "_") return table;
    }
    return stem.find("commit") != std::string::npos ? "commit_" : "build";
  }

  const std::multimap<std::int64_t, std::string>& rows(const std::string& table) {
    const auto known = rows_.find(table);
    if (known != rows_.end()) return known->second;
    std::multimap<std::int64_t, std::string> texts;
    const Table content = rows_of(database_, "SELECT * FROM \"" + table + "\"");
    for (const auto& row : content.rows) {
      std::int64_t id = 0;
      std::string text;
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string& column = content.columns[i];
        if (column == "id") id = std::get<std::int64_t>(row[i]);
        if (column == "id" || kOfTheFile.count(column) > 0) continue;
        const std::string parent = target(column);
        const auto* key = std::get_if<std::int64_t>(&row[i]);
        text += column + "=";
        if (!parent.empty() && key != nullptr) {
          const auto found = rows(parent).find(*key);
          // Of what has columns that grow, its name is enough.
          text +=
              '[' + (found == rows(parent).end() ? "nothing" : name_of(parent, *key, found->second)) + ']';
        } else {
          text += format_csv({{"x"}, {{row[i]}}}).substr(3);
          text.resize(text.size() - 2);
        }
        text += ' ';
      }
      texts.emplace(id, text);
    }
    return rows_[table] = std::move(texts);
  }

  std::string name_of(const std::string& table, std::int64_t key, const std::string& text) {
    const char* name = table == "run" || table == "attempt" ? "uuid"
                       : table == "instance"                ? "content_hash"
                       : table == "commit_"                 ? "hash"
                                                            : nullptr;
    if (table == "cell") {
      return std::get<std::string>(
                 rows_of(
                     database_,
                     "SELECT uuid || '/' || case_id FROM cell JOIN run ON run.id = run_id WHERE cell.id = " +
                         std::to_string(key))
                     .rows[0][0])
                 .substr(0, 36) +
             name_of("case_", ask(database_, "SELECT case_id FROM cell WHERE id = " + std::to_string(key)),
                     rows("case_")
                         .find(ask(database_, "SELECT case_id FROM cell WHERE id = " + std::to_string(key)))
                         ->second);
    }
    if (name == nullptr) return text;
    return std::get<std::string>(rows_of(database_, std::string("SELECT ") + name + " FROM \"" + table +
                                                        "\" WHERE id = " + std::to_string(key))
                                     .rows[0][0]);
  }

  Database& database_;
  std::vector<std::string> tables_;
  std::map<std::string, std::multimap<std::int64_t, std::string>> rows_;
};

void expect_same(Database& a, Database& b) {
  const auto here = Content(a).all();
  const auto there = Content(b).all();
  RC_ASSERT(here.size() == there.size());
  for (const auto& [table, rows] : here) {
    const auto& others = there.at(table);
    for (const std::string& row : rows) {
      if (others.count(row) != rows.count(row)) RC_LOG() << table << ", only here: " << row << '\n';
    }
    for (const std::string& row : others) {
      if (others.count(row) != rows.count(row)) RC_LOG() << table << ", only there: " << row << '\n';
    }
    if (rows != others) RC_FAIL("histories differ");
  }
}

void expect_sound(Database& database) {
  RC_ASSERT(must(count_stale_summaries(database.connection())) == 0);
  RC_ASSERT(ask(database, "SELECT count(*) FROM pragma_foreign_key_check") == 0);
  RC_ASSERT(ask(database,
                "SELECT count(*) FROM cell WHERE result_count <> (SELECT count(*) FROM result WHERE cell_id "
                "= cell.id)") == 0);
}

std::map<std::string, std::int64_t> sizes_of(Database& database) {
  std::map<std::string, std::int64_t> sizes;
  for (const auto& row :
       rows_of(database, "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%'")
           .rows) {
    const auto& table = std::get<std::string>(row[0]);
    sizes[table] = ask(database, "SELECT count(*) FROM \"" + table + "\"");
  }
  return sizes;
}

/// Merges, and checks what the report says of it.
void merge(Database& database, const std::filesystem::path& source) {
  const auto before = sizes_of(database);
  const MergeReport report = must(merge_into(database, source));
  for (const auto& [table, size] : sizes_of(database)) {
    if (table == "instance_summary" || table == "cell_summary") continue;  // made, not merged
    const std::int64_t grown = size - before.at(table);
    // A sweep of several machines is given one of its own.
    const bool is_right =
        table == "machine" ? report.rows_of(table) <= grown : report.rows_of(table) == grown;
    if (!is_right) RC_FAIL("the report is wrong of " + table);
  }
}

using Files = std::vector<std::unique_ptr<NewHistory>>;

Files some_files(std::int64_t least, std::int64_t most) {
  Files files;
  for (auto left = any_whole(least, most); left > 0; --left) files.push_back(std::make_unique<NewHistory>());
  return files;
}

// --- laws ---------------------------------------------------------------------------

void order_and_repetition_change_nothing() {
  const Files files = some_files(2, 3);
  for (const auto& file : files) record_some_of_everything(file->path());
  const NewHistory first;
  const NewHistory second;
  Database one = first.open();
  for (const auto& file : files) merge(one, file->path());
  Database other = second.open();
  for (const std::size_t i : any_order(files.size())) merge(other, files[i]->path());
  expect_sound(one);
  expect_same(one, other);
  const auto before = Content(other).all();
  const MergeReport again = must(merge_into(
      other,
      files[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(files.size()) - 1))]->path()));
  RC_ASSERT(again.added.empty());
  if (before != Content(other).all()) RC_FAIL("merging again changed something");
  // All at once.
  std::vector<std::filesystem::path> sources;
  for (const std::size_t i : any_order(files.size())) sources.push_back(files[i]->path());
  const NewHistory fourth;
  Database together = fourth.open();
  RC_ASSERT(must(merge_into(together, sources)).refused.empty());
  expect_sound(together);
  expect_same(one, together);
  // By way of a third file.
  const NewHistory third;
  Database last = third.open();
  other = third.open();  // closes the second
  merge(last, second.path());
  expect_same(one, last);
  // A run comes from the file that it was recorded in, by whatever way.
  std::set<std::string> origins;
  for (const auto& row : rows_of(last, "SELECT DISTINCT origin FROM run").rows)
    origins.insert(std::get<std::string>(row[0]));
  for (const auto& file : files) RC_ASSERT(origins.erase(file->path().string()) == 1U);
  RC_ASSERT(origins.empty());
}

/// The parts of one sweep, recorded in as many files, each some of its plannings.
void parts_become_one_run() {
  Sweep whole = any_sweep();
  if (whole.plannings.empty()) RC_DISCARD("nothing to plan");
  whole.status = RunStatus::kFinished;
  whole.info.planned = static_cast<std::int64_t>(whole.plannings.size());
  const Files files = some_files(2, 3);
  std::vector<Sweep> parts(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    parts[i].info = whole.info;
    parts[i].info.shard = std::to_string(i + 1) + "/" + std::to_string(files.size());
    parts[i].info.machine = machine_number(static_cast<int>(any_whole(1, 2)));
  }
  for (const Planned& planned : whole.plannings) {
    parts[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(files.size()) - 1))]
        .plannings.push_back(planned);
  }
  // One of them may be missing.
  const bool is_whole = any_flag() || parts.back().plannings.empty();
  std::size_t results = 0;
  std::set<std::string> machines;
  const NewHistory joined;
  Database database = joined.open();
  for (std::size_t i = 0; i < files.size(); ++i) record(files[i]->path(), parts[i]);
  for (const std::size_t i : any_order(files.size())) {
    if (i + 1 == files.size() && !is_whole) continue;
    merge(database, files[i]->path());
    results += parts[i].plannings.size();
    machines.insert(fingerprint(parts[i].info.machine));
  }
  expect_sound(database);
  RC_ASSERT(ask(database, "SELECT count(*) FROM run") == 1);
  RC_ASSERT(ask(database, "SELECT count(*) FROM result") == static_cast<std::int64_t>(results));
  const std::size_t merged = files.size() - (is_whole ? 0 : 1);
  RC_ASSERT(ask(database, "SELECT count(*) FROM attempt") == static_cast<std::int64_t>(merged));
  const auto run =
      rows_of(database,
              "SELECT run.status, run.shard, run.started_utc = (SELECT min(started_utc) FROM attempt), "
              "run.ended_utc >= (SELECT max(ended_utc) FROM attempt), host, cpu_model, cores, fingerprint "
              "FROM run JOIN machine ON machine.id = machine_id")
          .rows.at(0);
  if (merged > 1) {
    RC_ASSERT(std::get<std::string>(run[0]) == (is_whole ? "finished" : "aborted"));
    RC_ASSERT(std::get<std::string>(run[1]).empty());
    RC_ASSERT(std::get<std::int64_t>(run[3]) == 1);
  }
  if (machines.size() > 1) {
    RC_ASSERT(std::get<std::string>(run[4]) == "host 1, host 2");
    RC_ASSERT(std::get<std::string>(run[5]) == "2 machines: processor");
    RC_ASSERT(machines.count(std::get<std::string>(run[7])) == 0U);
  } else {
    RC_ASSERT(machines.count(std::get<std::string>(run[7])) == 1U);
  }
  // Each result knows its attempt, and through it its machine.
  for (std::size_t i = 0; i < merged; ++i) {
    const std::string of_part =
        " FROM result JOIN attempt ON attempt.id = attempt_id JOIN machine ON machine.id = "
        "attempt.machine_id WHERE shard = '" +
        parts[i].info.shard + "'";
    RC_ASSERT(ask(database, "SELECT count(*)" + of_part) ==
              static_cast<std::int64_t>(parts[i].plannings.size()));
    RC_ASSERT(ask(database,
                  "SELECT count(*)" + of_part + " AND host <> '" + parts[i].info.machine.host + "'") == 0);
  }
  // And each is as it was planned.
  for (std::size_t i = 0; i < merged; ++i) {
    for (const Planned& planned : parts[i].plannings) {
      RC_ASSERT(ask(database,
                    "SELECT count(*) FROM result JOIN cell ON cell.id = cell_id JOIN case_ ON case_.id = "
                    "case_id JOIN instance ON instance.id = instance_id "
                    "WHERE content_hash = '" +
                        planned.instance.content_hash +
                        "' AND position = " + std::to_string(planned.row.position) +
                        " AND repetition = " + std::to_string(planned.row.repetition) +
                        " AND case_.robots = " + std::to_string(planned.parameters.robots) +
                        " AND planning_time_ns = " + std::to_string(planned.row.planning_time_ns) +
                        " AND expansions = " + std::to_string(planned.row.expansions)) == 1);
    }
  }
  RC_CLASSIFY(merged > 1 && machines.size() > 1, "on two machines");
  RC_CLASSIFY(!is_whole, "some missing");
}

/// Merged now and then while it grows, a run ends as if it was merged once.
void growing_runs_are_followed() {
  Sweep sweep = any_sweep();
  const NewHistory source;
  const NewHistory followed;
  const NewHistory once;
  Database database = followed.open();
  {
    RunRecorder recorder = must(RunRecorder::begin(source.open(), sweep.info));
    for (const Planned& planned : sweep.plannings) {
      recorder.add(planned.parameters, planned.instance, planned.row);
      if (any_flag()) must(recorder.commit({planned.row.planning_time_ns, 1}));
      if (any_whole(0, 2) == 0) merge(database, source.path());
    }
    must(recorder.commit());
    if (any_flag()) must(recorder.finish(RunStatus::kAborted));
  }
  merge(database, source.path());
  if (any_flag()) {
    // Taken up again, and finished after all.
    must(source.open().connection().execute("UPDATE run SET writer = ''", "ending a process"));
    RunRecorder recorder = must(RunRecorder::resume(source.open(), sweep.info.uuid, sweep.info));
    Planned more{case_number(3), instance_number(3), any_result()};
    more.row.position = 30;
    recorder.add(more.parameters, more.instance, more.row);
    must(recorder.commit());
    must(recorder.finish(RunStatus::kFinished));
  }
  merge(database, source.path());
  expect_sound(database);
  Database other = once.open();
  merge(other, source.path());
  expect_same(database, other);
}

/// What both hold stays as it came first, and is there once.
void what_both_hold_is_there_once() {
  const Sweep sweep = any_sweep();
  const NewHistory here;
  const NewHistory there;
  std::size_t in_either = 0;
  Sweep parts[] = {{sweep.info, {}, RunStatus::kFinished}, {sweep.info, {}, RunStatus::kFinished}};
  std::vector<Planned> expected;
  for (const Planned& planned : sweep.plannings) {
    const auto where = any_whole(0, 2);
    if (where != 1) parts[0].plannings.push_back(planned);
    expected.push_back(planned);
    if (where == 0) continue;
    parts[1].plannings.push_back(planned);
    parts[1].plannings.back().row.planning_time_ns += 1'000'000'000;
    if (where == 1) expected.back() = parts[1].plannings.back();
  }
  parts[0].info.shard = "1/2";
  parts[1].info.shard = "2/2";
  record(here.path(), parts[0]);
  record(there.path(), parts[1]);
  in_either = expected.size();
  Database database = here.open();
  merge(database, there.path());
  expect_sound(database);
  RC_ASSERT(ask(database, "SELECT count(*) FROM result") == static_cast<std::int64_t>(in_either));
  std::int64_t total_ns = 0;
  for (const Planned& planned : expected) total_ns += planned.row.planning_time_ns;
  RC_ASSERT(ask(database, "SELECT ifnull(sum(planning_time_ns), 0) FROM result") == total_ns);
}

/// Of exclusion and inclusion the later one counts, whichever file knows of it.
void the_later_exclusion_counts() {
  const NewHistory here;
  Sweep sweep = any_sweep();
  record(here.path(), sweep);
  const NewHistory there;
  std::filesystem::copy_file(here.path(), there.path(), std::filesystem::copy_options::overwrite_existing);
  // When each file last excluded the run and included it; 0: never.
  struct State {
    int excluded = 0;
    int included = 0;
    bool is_out() const { return excluded > included; }
    int last() const { return std::max(excluded, included); }
  };
  State states[2];
  const NewHistory* files[] = {&here, &there};
  for (int i = 0; i < 2; ++i) {
    states[i] = {static_cast<int>(any_whole(0, 8)), static_cast<int>(any_whole(0, 8))};
    if (states[i].excluded == states[i].included) states[i] = {};
    if (i == 1 && states[0].last() == states[1].last()) states[1] = {9, 0};
    Database database = files[i]->open();
    const std::string excluded = states[i].is_out() ? "'" + second_number(states[i].excluded) + "'" : "NULL";
    const std::string included =
        states[i].included > 0 ? "'" + second_number(states[i].included) + "'" : "NULL";
    must(database.connection().execute(
        "UPDATE run SET excluded_reason = " +
            std::string(states[i].is_out() ? "'noise " + std::to_string(i) + "'" : "NULL") +
            ", excluded_utc = " + excluded + ", included_utc = " + included,
        "setting a state"));
  }
  // What a file knows is when it was excluded, as long as it is, and when it was last included.
  const auto known = [](const State& state) { return state.is_out() ? state.last() : state.included; };
  const State& later = known(states[1]) > known(states[0]) ? states[1] : states[0];
  Database database = here.open();
  merge(database, there.path());
  RC_ASSERT((ask(database, "SELECT excluded_reason IS NOT NULL FROM run") == 1) == later.is_out());
  if (later.is_out()) {
    RC_ASSERT(std::get<std::string>(rows_of(database, "SELECT excluded_reason FROM run").rows[0][0]) ==
              "noise " + std::to_string(&later - states));
  }
  expect_sound(database);
}

/// As commands exclude and include: what was done last is so everywhere.
void exclusions_are_taken_along() {
  const NewHistory here;
  const Sweep sweep = any_sweep();
  record(here.path(), sweep);
  const NewHistory there;
  std::filesystem::copy_file(here.path(), there.path(), std::filesystem::copy_options::overwrite_existing);
  bool is_out = false;
  {
    Database database = there.open();
    for (auto left = any_whole(1, 3); left > 0; --left) {
      if (!is_out) must(exclude_run(database, sweep.info.uuid, "noise"));
      if (is_out) must(include_run(database, sweep.info.uuid));
      is_out = !is_out;
      // Clocks tell times apart that are a millisecond apart.
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  Database database = here.open();
  merge(database, there.path());
  const std::string counted = "SELECT count(*) FROM run WHERE excluded_reason IS NOT NULL";
  RC_ASSERT(ask(database, counted) == (is_out ? 1 : 0));
  // And back again, after another change of mind.
  if (is_out) must(include_run(database, sweep.info.uuid));
  if (!is_out) must(exclude_run(database, sweep.info.uuid, "noise"));
  Database other = there.open();
  merge(other, here.path());
  RC_ASSERT(ask(other, counted) == (is_out ? 0 : 1));
  merge(database, there.path());
  RC_ASSERT(ask(database, counted) == (is_out ? 0 : 1));
  expect_sound(other);
}

/// Best known costs and findings, which both files know, in the better and later state.
void best_known_costs_are_the_best() {
  const NewHistory files[2];
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<std::int64_t, std::int64_t>> best;
  for (const NewHistory& file : files) {
    Database database = file.open();
    for (auto left = any_whole(0, 4); left > 0; --left) {
      const BestKnownRow row{"map",           "random",        any_whole(1, 2),
                             any_whole(1, 2), any_whole(0, 5), any_whole(6, 9)};
      must(record_best_known(database, {row}));
      const auto [known, is_new] =
          best.try_emplace({row.type_id, row.agents}, row.lower_cost, row.solution_cost);
      known->second = {std::max(known->second.first, row.lower_cost),
                       std::min(known->second.second, row.solution_cost)};
    }
  }
  Database database = files[0].open();
  merge(database, files[1].path());
  const Table table = rows_of(database, "SELECT type_id, agents, lower_cost, solution_cost FROM best_known");
  RC_ASSERT(table.rows.size() == best.size());
  for (const auto& row : table.rows) {
    const auto& [lower, solution] = best.at({std::get<std::int64_t>(row[0]), std::get<std::int64_t>(row[1])});
    RC_ASSERT(std::get<std::int64_t>(row[2]) == lower);
    RC_ASSERT(std::get<std::int64_t>(row[3]) == solution);
  }
}

const PropertyRoom room("history_merge", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("merging in any order, once or twice, gives the same history",
                     order_and_repetition_change_nothing, kManyFiles);
  passed &= property("parts of a sweep become one run", parts_become_one_run, kManyFiles);
  passed &= property("a run that is merged while it grows ends as if it was merged once",
                     growing_runs_are_followed, kManyFiles);
  passed &= property("a planning that both files hold is there once, as it came first",
                     what_both_hold_is_there_once, kManyFiles);
  passed &=
      property("of exclusion and inclusion the later one counts", the_later_exclusion_counts, kManyFiles);
  passed &= property("what was excluded or included last is so in every file", exclusions_are_taken_along,
                     kManyFiles);
  passed &= property("of best known costs the best are kept", best_known_costs_are_the_best, kManyFiles);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_merge_laws
