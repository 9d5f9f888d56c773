// The questions behind the report.
#include "bench/present/report_data.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "bench/present/named_row.hpp"
#include "db/comparisons.hpp"
#include "db/database.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {
namespace {

/// Metrics whose history the report shows.
constexpr const char* kTrendMetrics[] = {"success", "runtime", "flowtime", "expansions"};

constexpr const char* kProperties =
    "SELECT room, title, status, cases, started_utc, substr(commit_hash, 1, 10) AS commit_ FROM "
    "v_property_latest "
    "ORDER BY status = 'passed', room, title";
constexpr const char* kFuzzRuns =
    "SELECT target, status, max(started_utc) AS started_utc, executions, executions_per_s, edges, "
    "corpus_files "
    "FROM v_fuzz_runs WHERE excluded_reason IS NULL GROUP BY target ORDER BY target";
constexpr const char* kFindings =
    "SELECT id, target, state, kind, claim, message, first_utc, last_utc, times_found FROM v_findings "
    "ORDER BY state = 'fixed', last_utc DESC LIMIT 101";

db::Result<db::Done> read_tables(const std::filesystem::path& path, ReportData& data) {
  const std::pair<const char*, db::Table*> questions[] = {
      {kProperties, &data.properties}, {kFuzzRuns, &data.fuzz_runs}, {kFindings, &data.findings}};
  for (const auto& [sql, answer] : questions) {
    *answer = SIPPLAB_TRY(db::run_sql(path, sql));
  }
  return db::Done{};
}

/// A run as a side of a comparison, be it excluded or not.
db::Result<db::ComparisonSide> side_of(const std::filesystem::path& path, const db::RunSummary& run) {
  const auto table =
      SIPPLAB_TRY(db::run_sql(path, "SELECT id FROM run WHERE uuid = :run", {{"run", run.uuid}}));
  db::ComparisonSide side{run.uuid, run.commit_hash, {}};
  for (const auto& row : table.rows) side.run_ids.push_back(NamedRow(table, row).integer("id"));
  return side;
}

db::Result<Judgement> judged_against_base(const std::filesystem::path& path, db::Database& database,
                                          const ReportData& data) {
  const auto base = SIPPLAB_TRY(side_of(path, data.base->run));
  const auto head = SIPPLAB_TRY(side_of(path, data.run.run));
  auto cells = SIPPLAB_TRY(db::paired_cells(database, base, head));
  Judgement judgement = measured(std::move(cells));
  judge(judgement, {});
  return judgement;
}

db::Result<std::set<std::int64_t>> cases_of(const std::filesystem::path& path, const std::string& run) {
  const auto table =
      SIPPLAB_TRY(db::run_sql(path, "SELECT case_id FROM v_all_run_cells WHERE run = :run", {{"run", run}}));
  std::set<std::int64_t> cases;
  for (const auto& row : table.rows) cases.insert(NamedRow(table, row).integer("case_id"));
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
      auto series = SIPPLAB_TRY(db::read_trend(database, query));
      for (db::TrendSeries& one : series) trend.series.push_back(std::move(one));
    }
    db::mark_changes(trend.series, *trend.metric);
    data.trends.push_back(std::move(trend));
  }
  return db::Done{};
}

}  // namespace

db::Result<ReportData> read_report(const std::filesystem::path& path, const std::string& run,
                                   const std::optional<std::string>& base) {
  auto database = SIPPLAB_TRY(db::Database::open_read_only(path));
  ReportData data;
  data.run = SIPPLAB_TRY(db::show_run(database, run));
  std::optional<std::string> base_run = base;
  if (!base_run) {
    base_run = SIPPLAB_TRY(db::run_before(database, data.run.run.uuid));
  }
  if (base_run) {
    data.base = SIPPLAB_TRY(db::show_run(database, *base_run));
    data.against_base = SIPPLAB_TRY(judged_against_base(path, database, data));
  }
  SIPPLAB_TRY(read_tables(path, data));
  const auto cases = SIPPLAB_TRY(cases_of(path, data.run.run.uuid));
  SIPPLAB_TRY(read_trends(database, cases, data));
  return data;
}

}  // namespace sipplab::bench
