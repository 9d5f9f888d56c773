// The questions behind the report.
#include "bench/present/report_data.hpp"

#include <algorithm>
#include <set>

#include "bench/present/named_row.hpp"
#include "db/database.hpp"

namespace sipplab::bench {
namespace {

using Parameters = std::vector<std::pair<std::string, std::string>>;

/// Metrics whose history the report shows.
constexpr const char* kTrendMetrics[] = {"success", "runtime", "flowtime", "expansions"};

// Times are compared where both runs come from one machine and compiler. Flips and their test are of
// instances: repetitions and equal files of one are one observation.
std::string cells_sql() {
  return R"sql(
WITH by_instance AS (
  SELECT head.case_id AS case_id, avg(base.status = 'solved') AS base_share, avg(head.status = 'solved') AS head_share
  FROM v_results AS head JOIN v_results AS base USING (case_id, instance_hash, position, repetition)
  WHERE head.run = :run AND base.run = :other GROUP BY head.case_id, instance_hash),
flips AS (
  SELECT case_id, count(*) AS instances, sum(head_share > base_share) AS gained, sum(head_share < base_share) AS lost,
         mcnemar(base_share > head_share, head_share > base_share) AS p_value
  FROM by_instance GROUP BY case_id)
SELECT head.environment AS environment, head.robots AS robots, head.ssi_s AS ssi_s, head.reschedule AS reschedule,
       head.initial_order AS initial_order,
       (SELECT )sql" +
         std::string(db::kPlannerNameSql) +
         R"sql( FROM case_ WHERE case_.id = head.case_id) AS planner_name,
       flips.instances AS instances,
       sum(head.plan_hash IS NOT base.plan_hash OR head.status <> base.status OR head.expansions <> base.expansions)
         AS different,
       avg(base.status = 'solved') AS base_success, avg(head.status = 'solved') AS head_success,
       flips.gained AS gained, flips.lost AS lost, flips.p_value AS p_value,
       iif(here.machine = there.machine AND here.compiler = there.compiler,
           median(1.0 * head.planning_time_ns / base.planning_time_ns), NULL) AS time_ratio,
       sum(base.status = 'solved' AND head.status = 'solved') AS both_solved,
       median(iif(base.status = 'solved' AND head.status = 'solved', head.flowtime_s / base.flowtime_s, NULL))
         AS flowtime_ratio
FROM v_results AS head
JOIN v_results AS base USING (case_id, instance_hash, position, repetition)
JOIN flips ON flips.case_id = head.case_id
JOIN v_runs AS here ON here.run = head.run
JOIN v_runs AS there ON there.run = base.run
WHERE head.run = :run AND base.run = :other
GROUP BY head.case_id
ORDER BY head.environment, planner_name, head.initial_order, head.reschedule, head.ssi_s, head.robots)sql";
}

constexpr const char* kFlips =
    "SELECT direction, environment, robots, ssi_s, reschedule, instance, base_status, head_status, "
    "base_planning_time_s AS base_s, head_planning_time_s AS head_s FROM v_flips WHERE base_run = :other AND "
    "head_run = :run "
    "ORDER BY direction DESC, environment, robots, ssi_s, instance LIMIT 201";
constexpr const char* kProperties =
    "SELECT room, title, status, cases, started_utc, substr(commit_hash, 1, 10) AS commit_ FROM "
    "v_property_latest "
    "ORDER BY status = 'passed', room, title";
constexpr const char* kFuzzRuns =
    "SELECT target, status, max(started_utc) AS started_utc, executions, executions_per_s, edges, "
    "corpus_files "
    "FROM v_fuzz_runs GROUP BY target ORDER BY target";
constexpr const char* kFindings =
    "SELECT id, target, state, kind, claim, message, first_utc, last_utc, times_found FROM v_findings "
    "ORDER BY state = 'fixed', last_utc DESC LIMIT 101";

db::Result<db::Done> read_tables(const std::filesystem::path& path, ReportData& data) {
  struct Question {
    std::string sql;
    db::Table* answer;
    bool of_pair;
  };
  for (const Question& question :
       {Question{cells_sql(), &data.cells, true}, Question{kFlips, &data.flips, true},
        Question{kProperties, &data.properties, false}, Question{kFuzzRuns, &data.fuzz_runs, false},
        Question{kFindings, &data.findings, false}}) {
    if (question.of_pair && !data.base) continue;
    const Parameters parameters = question.of_pair
                                      ? Parameters{{"run", data.run.run.uuid}, {"other", data.base->run.uuid}}
                                      : Parameters{};
    auto table = db::run_sql(path, question.sql, parameters);
    if (!table) return Unexpected{table.error()};
    *question.answer = std::move(*table);
  }
  return db::Done{};
}

db::Result<std::set<std::int64_t>> cases_of(const std::filesystem::path& path, const std::string& run) {
  const auto table = db::run_sql(path, "SELECT case_id FROM v_run_cells WHERE run = :run", {{"run", run}});
  if (!table) return Unexpected{table.error()};
  std::set<std::int64_t> cases;
  for (const auto& row : table->rows) cases.insert(NamedRow(*table, row).integer("case_id"));
  return cases;
}

db::Result<db::Done> read_trends(db::Database& database, const std::set<std::int64_t>& cases,
                                 ReportData& data) {
  for (const char* name : kTrendMetrics) {
    ReportTrend trend;
    trend.metric = db::find_trend_metric(name);
    for (const std::int64_t id : cases) {
      db::TrendQuery query;
      query.metric = trend.metric;
      query.cases.id = id;
      auto series = db::read_trend(database, query);
      if (!series) return Unexpected{series.error()};
      for (db::TrendSeries& one : *series) trend.series.push_back(std::move(one));
    }
    db::mark_changes(trend.series, *trend.metric);
    data.trends.push_back(std::move(trend));
  }
  return db::Done{};
}

}  // namespace

db::Result<ReportData> read_report(const std::filesystem::path& path, const std::string& run,
                                   const std::optional<std::string>& base) {
  auto database = db::Database::open_read_only(path);
  if (!database) return Unexpected{database.error()};
  ReportData data;
  auto shown = db::show_run(*database, run);
  if (!shown) return Unexpected{shown.error()};
  data.run = std::move(*shown);
  std::optional<std::string> base_run = base;
  if (!base_run) {
    auto before = db::run_before(*database, data.run.run.uuid);
    if (!before) return Unexpected{before.error()};
    base_run = *before;
  }
  if (base_run) {
    auto other = db::show_run(*database, *base_run);
    if (!other) return Unexpected{other.error()};
    data.base = std::move(*other);
  }
  if (auto done = read_tables(path, data); !done) return Unexpected{done.error()};
  const auto cases = cases_of(path, data.run.run.uuid);
  if (!cases) return Unexpected{cases.error()};
  if (auto done = read_trends(*database, *cases, data); !done) return Unexpected{done.error()};
  return data;
}

}  // namespace sipplab::bench
