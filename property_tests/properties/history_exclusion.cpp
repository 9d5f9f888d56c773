// What an exclusion takes out of the views, and out of the answer to every question: all that would not be
// there if the run had never been.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "db/comparisons.hpp"
#include "db/queries.hpp"
#include "db/trends.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_exclusion_laws {
namespace {

/// Takes out a run, and all that belongs to it, as if it had never been recorded.
void purge(Database& database, const std::set<std::string>& runs) {
  auto& connection = database.connection();
  must(connection.execute("PRAGMA foreign_keys = OFF", "purging"));
  for (const std::string& run : runs)
    must(connection.execute("DELETE FROM run WHERE uuid = '" + run + "'", "purging"));
  const Texts tables =
      texts_of(database, "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%'");
  for (bool again = true; again;) {
    again = false;
    for (const std::string& table : tables) {
      std::map<std::int64_t, std::pair<std::string, std::string>> references;  // parent, condition
      for (const auto& row :
           rows_of(database,
                   "SELECT id, \"table\", \"from\", ifnull(\"to\", 'id') FROM pragma_foreign_key_list('" +
                       table + "')")
               .rows) {
        auto& [parent, condition] = references[std::get<std::int64_t>(row[0])];
        parent = std::get<std::string>(row[1]);
        condition += (condition.empty() ? "" : " AND ") + ("p." + std::get<std::string>(row[3]) + " = \"" +
                                                           table + "\"." + std::get<std::string>(row[2]));
        if (condition.find(" AND ") == std::string::npos)
          condition =
              "(" + condition + " OR \"" + table + "\"." + std::get<std::string>(row[2]) + " IS NULL)";
      }
      for (const auto& [id, reference] : references) {
        must(connection.execute("DELETE FROM \"" + table + "\" WHERE NOT EXISTS (SELECT 1 FROM \"" +
                                    reference.first + "\" AS p WHERE " + reference.second + ")",
                                "purging"));
        again = again || connection.changes() > 0;
      }
    }
  }
  must(connection.execute(
      "DELETE FROM instance_summary; INSERT INTO instance_summary SELECT instance_id, case_id, count(*), "
      "sum(status = 0), sum(iif(status = 0, planning_time_ns, 0)) FROM result JOIN cell ON cell.id = cell_id "
      "GROUP BY instance_id, case_id",
      "purging"));
}

/// Views that list runs, excluded ones too.
bool lists_all(const std::string& view) {
  static const std::set<std::string> kListing = {"v_runs",          "v_sweeps",    "v_attempts",
                                                 "v_property_runs", "v_gate_runs", "v_fuzz_runs"};
  return kListing.count(view) > 0 || view.substr(0, 6) == "v_all_" || view.substr(0, 13) == "v_recomputed_";
}

/// Rows as text, in order. Without those that belong to one of the runs.
std::multiset<std::string> rows_without(Database& database, const std::string& view,
                                        const std::set<Value>& runs) {
  std::multiset<std::string> rows;
  Table table = rows_of(database, "SELECT * FROM " + view);
  for (auto& row : table.rows) {
    if (std::any_of(row.begin(), row.end(), [&runs](const Value& value) { return runs.count(value) > 0; }))
      continue;
    rows.insert(format_csv({table.columns, {row}}));
  }
  return rows;
}

std::string text_of(const std::vector<TrendSeries>& series) {
  std::string text;
  for (const TrendSeries& one : series) {
    text += one.label + ' ' + one.instances + ' ' + one.context + '\n';
    for (const TrendPoint& point : one.points) {
      text += "  " + point.commit + ' ' + std::to_string(point.dirty) + ' ' + point.subject + ' ' +
              point.committed_utc + ' ' + point.started_utc + ' ' + std::to_string(point.ancestor_count) +
              ' ' + std::to_string(point.runs) + ' ' + std::to_string(point.value) + '\n';
    }
  }
  return text;
}

template <class T, class Text>
std::string text_or_error(const Result<T>& answer, const Text& text) {
  return answer ? text(*answer) : "none";
}

/// Everything that a command may ask, by what it is called.
std::map<std::string, std::string> answers(Database& database, const std::set<std::string>& counting) {
  std::map<std::string, std::string> said;
  const auto itself = [](const std::string& text) { return text; };
  RunFilter filter;
  filter.kind = "all";
  filter.limit = 0;
  said["runs"] = format_csv(table_of(must(list_runs(database, filter))));
  filter.kind.reset();
  filter.limit = static_cast<std::size_t>(2);
  said["the two newest runs"] = format_csv(table_of(must(list_runs(database, filter))));
  said["latest"] = text_or_error(resolve_run(database, "latest"), itself);
  for (const std::string& run : counting) {
    const auto before = must(run_before(database, run));
    said["the run before " + run] = before.value_or("none");
  }
  for (const TrendMetric& metric : trend_metrics()) {
    TrendQuery query;
    query.metric = &metric;
    said["trend " + std::string(metric.name)] = text_of(must(read_trend(database, query)));
  }
  std::string times;
  for (const CaseTime& time : must(case_times(database)))
    times += std::to_string(time.parameters.robots) + ' ' + std::to_string(time.mean_planning_time_s) + '\n';
  said["times of cases"] = times;
  for (int machine = 1; machine <= 2; ++machine) {
    for (int method = 1; method <= 2; ++method) {
      for (int eighths = 1; eighths <= 8; ++eighths) {
        std::string noise;
        for (const GateNoise& row :
             must(gate_noise(database, {machine_number(machine), "gate", method, eighths / 8.0}))) {
          noise += row.parameters ? std::to_string(row.parameters->robots) : "all";
          for (const auto& comparison : row.comparisons) {
            for (const double pair : comparison) noise += ' ' + std::to_string(pair);
            noise += ';';
          }
        }
        said["noise " + std::to_string(machine) + ' ' + std::to_string(method) + ' ' +
             std::to_string(eighths)] = noise;
      }
    }
  }
  for (const char* suite : {"smoke", "density"}) {
    for (int build = 1; build <= 2; ++build) {
      RunInfo info;
      info.suite = suite;
      info.options = "count=1 seed=1";
      info.build = build_number(build);
      const auto earlier = must(find_earlier_run(database, info));
      said[std::string("to resume ") + suite + std::to_string(build)] =
          earlier ? earlier->uuid + ' ' + std::to_string(earlier->results) : "none";
    }
  }
  for (const char* target : {"plan", "parse"}) {
    for (const char* hash : {"hash 1", "hash 2"}) {
      said[std::string("clean ") + target + hash] =
          must(is_fuzzed_clean(database, target, hash)) ? "yes" : "no";
    }
  }
  said["the latest campaign"] = text_or_error(latest_fuzz_campaign(database), itself);
  said["fuzz runs"] = format_csv(must(list_fuzz_runs(database, {})));
  for (const std::string& campaign : texts_of(database, "SELECT DISTINCT campaign FROM fuzz_coverage")) {
    said["coverage " + campaign] = format_csv(must(list_fuzz_coverage(database, campaign)));
  }
  said["properties"] = format_csv(must(list_property_runs(database, {})));
  said["the latest failure"] =
      text_or_error(latest_property_failure(database), [](std::int64_t id) { return std::to_string(id); });
  for (const std::string& side : Texts{"branch:main", "branch:topic", "commit:" + commit_number(1).hash,
                                       "commit:" + commit_number(2).hash, "run:latest"}) {
    said["side " + side] = text_or_error(resolve_side(database, side), [](const ComparisonSide& found) {
      std::string text = found.title;
      for (const std::int64_t id : found.run_ids) text += ' ' + std::to_string(id);
      return text;
    });
  }
  return said;
}

void excluded_is_as_if_never_recorded() {
  const NewHistory history;
  record_some_of_everything(history.path());
  std::set<std::string> counting;
  std::set<std::string> excluded;
  std::set<Value> names;  // of excluded runs: UUID, and key in the views that have one
  {
    Database database = history.open();
    for (const std::string& run : all_runs(database))
      (any_whole(0, 2) == 0 ? excluded : counting).insert(run);
  }
  const NewHistory purged;
  std::filesystem::copy_file(history.path(), purged.path(),
                             std::filesystem::copy_options::overwrite_existing);
  Database without = purged.open();
  purge(without, excluded);
  Database database = history.open();
  // Some of those that count were excluded for a time.
  for (const std::string& run : counting) {
    if (any_whole(0, 2) > 0) continue;
    must(exclude_run(database, run, "a mistake"));
    must(include_run(database, run));
  }
  for (const std::string& run : excluded) {
    must(exclude_run(database, run, "noise"));
    names.insert(run);
  }
  must(database.connection().execute("UPDATE run SET included_utc = NULL", "forgetting when"));
  for (const std::string& view : views_of(database)) {
    RC_LOG() << view << '\n';
    auto said = rows_without(database, view, lists_all(view) ? names : std::set<Value>{});
    if (view == "v_recomputed_cells") {
      said.clear();
      Table table = rows_of(database,
                            "SELECT * FROM v_recomputed_cells WHERE run_id IN (SELECT id FROM run WHERE "
                            "excluded_reason IS NULL)");
      for (const auto& row : table.rows) said.insert(format_csv({table.columns, {row}}));
    }
    if (view == "v_recomputed_instances") continue;  // keeps rows of nothing
    RC_ASSERT(said == rows_without(without, view, {}));
  }
  const auto here = answers(database, counting);
  const auto there = answers(without, counting);
  for (const auto& [question, answer] : here) {
    RC_LOG() << question << ": " << answer << "expected " << there.at(question) << '\n';
    RC_ASSERT(answer == there.at(question));
  }
  RC_CLASSIFY(!excluded.empty(), "some excluded");
}

const PropertyRoom room("history_exclusion", kCasesOfHistories, [] {
  return property("an excluded run is as if it had never been recorded, for every view and every question",
                  excluded_is_as_if_never_recorded, kWholeHistories);
});

}  // namespace
}  // namespace sipplab::db::history_exclusion_laws
