// Series of metrics, read from the views and put in the order of history.
#include "db/trends.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr std::string_view kReadingTrend = "reading a trend";

struct Sample {
  std::string commit;
  std::string binary;  ///< of a build with uncommitted changes; else empty
  bool dirty = false;
  std::string subject;
  std::string committed_utc;
  std::int64_t ancestor_count = 0;
  std::string started_utc;
  double value = 0;
  std::int64_t cell = 0;  ///< its plannings, of a case
  std::int64_t solved = 0;
  std::int64_t results = 0;
};

/// Columns that every source of samples gives after the context, in this order.
constexpr const char* kSampleColumns =
    "ifnull(commit_hash, ''), ifnull(commit_subject, ''), ifnull(committed_utc, started_utc), "
    "ifnull(ancestor_count, 0), started_utc, dirty, binary_hash, value";
/// And these behind them.
constexpr const char* kPlanningColumns = "cell, solved, results";
constexpr const char* kNoPlannings = "0, 0, 0";

Sample read_sample(const Statement& row, int column) {
  Sample sample;
  sample.commit = row.text(column++);
  sample.subject = row.text(column++);
  sample.committed_utc = row.text(column++);
  sample.ancestor_count = row.integer(column++);
  sample.started_utc = row.text(column++);
  sample.dirty = row.integer(column++) != 0;
  const std::string binary = row.text(column++);
  if (sample.dirty || sample.commit.empty()) sample.binary = binary;
  sample.value = row.real(column++);
  sample.cell = row.integer(column++);
  sample.solved = row.integer(column++);
  sample.results = row.integer(column);
  return sample;
}

/// Where a count of ancestors is not known, the commits of earlier date tell the place.
void place_unknown(std::vector<Sample>& samples) {
  std::map<std::string, std::int64_t> greatest_until;
  for (const Sample& sample : samples) {
    if (sample.ancestor_count > 0) {
      std::int64_t& count = greatest_until[sample.committed_utc];
      count = std::max(count, sample.ancestor_count);
    }
  }
  std::int64_t greatest = 0;
  for (auto& [date, count] : greatest_until) count = greatest = std::max(greatest, count);
  for (Sample& sample : samples) {
    if (sample.ancestor_count > 0) continue;
    const auto later = greatest_until.upper_bound(sample.committed_utc);
    if (later != greatest_until.begin()) sample.ancestor_count = std::prev(later)->second;
  }
}

std::vector<TrendPoint> points_of(std::vector<Sample> samples, bool of_solved) {
  place_unknown(samples);
  const auto place = [](const Sample& sample) {
    return std::tie(sample.ancestor_count, sample.committed_utc, sample.commit, sample.dirty,
                    sample.started_utc);
  };
  std::stable_sort(samples.begin(), samples.end(),
                   [&place](const Sample& a, const Sample& b) { return place(a) < place(b); });
  const auto version = [](const Sample& sample) {
    return std::tie(sample.commit, sample.dirty, sample.binary);
  };
  // A build may have run again after another one: its runs are one version, where it came first.
  std::vector<std::vector<const Sample*>> versions;
  std::map<decltype(version(samples[0])), std::size_t> place_of;
  for (const Sample& sample : samples) {
    const auto [known, is_new] = place_of.emplace(version(sample), versions.size());
    if (is_new) versions.emplace_back();
    versions[known->second].push_back(&sample);
  }
  std::vector<TrendPoint> points;
  for (const std::vector<const Sample*>& runs : versions) {
    std::vector<double> values;
    double solved = 0;
    double results = 0;
    for (const Sample* sample : runs) {
      values.push_back(sample->value);
      solved += static_cast<double>(sample->solved);
      results += static_cast<double>(sample->results);
    }
    const Sample& first = *runs.front();
    points.push_back({first.commit, first.dirty, first.subject, first.committed_utc, first.started_utc,
                      first.ancestor_count, static_cast<std::int64_t>(values.size()),
                      statistics::median(values).value_or(0)});
    if (of_solved) points.back().solved_share = solved / results;
  }
  return points;
}

struct CaseName {
  std::int64_t id = 0;
  std::string label;
  /// The other parameters, each as a few words: they go into the label if it would not be unique otherwise.
  std::array<std::string, 7> details;
};

/// A detail each; infinity and the largest count are no limits.
constexpr std::string_view kDetailsSql =
    "'instances ' || instance_set, 'seed ' || seed, printf('radius %g', radius_cells), "
    "printf('speed %g', speed_cells_per_s), "
    "iif(time_limit_s = 9e999, 'no time limit', printf('at most %g s', time_limit_s)), "
    "iif(max_expansions = 9223372036854775807, 'any expansions', 'at most ' || max_expansions || ' "
    "expansions'), "
    "iif(max_restarts = 9223372036854775807, 'any restarts', 'at most ' || max_restarts || ' restarts')";

/// Adds to labels that several cases share the details in which those cases differ.
void tell_apart(std::vector<CaseName>& cases) {
  std::map<std::string, std::vector<CaseName*>> by_label;
  for (CaseName& named : cases) by_label[named.label].push_back(&named);
  for (const auto& [label, alike] : by_label) {
    for (std::size_t i = 0; i < alike.front()->details.size(); ++i) {
      const std::string& first = alike.front()->details[i];
      const bool differs = std::any_of(alike.begin(), alike.end(),
                                       [&](const CaseName* named) { return named->details[i] != first; });
      if (!differs) continue;
      for (CaseName* named : alike) named->label += ", " + named->details[i];
    }
  }
}

Result<std::vector<CaseName>> find_cases(Database& database, const CaseFilter& filter) {
  std::string sql =
      "SELECT id, printf('%s, %d robots, ssi %s, %s, %s, %s%s', iif(map_spec = 'files', environment, "
      "map_spec), "
      "robots, iif(ssi_s = 9e999, 'inf', printf('%g', ssi_s)), reschedule, initial_order, planner, "
      "iif(reschedule = 'random' OR initial_order = 'random', printf(', seed %d', seed), '')), " +
      std::string(kDetailsSql) +
      " FROM case_ WHERE (?1 IS NULL OR id = ?1) AND (?2 IS NULL OR environment = ?2) "
      "AND (?3 IS NULL OR robots = ?3) AND (?4 IS NULL OR map_spec = ?4) AND (?5 IS NULL OR planner = ?5)";
  constexpr int kPlainParameters = 5;
  int parameter = kPlainParameters;
  const auto columns = SIPPLAB_TRY(case_columns(database.connection()));
  for (const auto& [name, value] : filter.options) {
    const std::string kept =
        columns.contains(name) ? name : fmt::format("json_extract(options, '$.{}')", name);
    sql += fmt::format(" AND {} IS ?{}", kept, ++parameter);
  }
  sql += " ORDER BY environment, planner, initial_order, reschedule, ssi_s, robots, id";
  auto select =
      SIPPLAB_TRY(Statement::prepare(database.connection(), sql, kReadingTrend, filter.id, filter.environment,
                                     filter.robots, filter.map, filter.planner));
  parameter = kPlainParameters;
  for (const auto& [name, value] : filter.options) detail::bind(select, ++parameter, value);
  std::vector<CaseName> cases;
  for (;;) {
    const auto row = SIPPLAB_TRY(select.step());
    if (!row) break;
    CaseName named{select.integer(0), select.text(1), {}};
    for (std::size_t i = 0; i < named.details.size(); ++i) {
      named.details[i] = select.text(static_cast<int>(i) + 2);
    }
    cases.push_back(std::move(named));
  }
  tell_apart(cases);
  return cases;
}

/// What samples of one series have in common.
struct SeriesKey {
  std::string context;
  std::string instances;  ///< their keys; empty if there are none

  friend bool operator<(const SeriesKey& a, const SeriesKey& b) {
    return std::tie(a.context, a.instances) < std::tie(b.context, b.instances);
  }
};
using SamplesByKey = std::map<SeriesKey, std::vector<Sample>>;

/// Rows of `select`: the context, the keys of the instances, then a sample.
Result<SamplesByKey> read_samples(Statement& select) {
  SamplesByKey samples;
  SIPPLAB_TRY(select.for_each([&] {
    samples[{select.text(0), select.text(1)}].push_back(read_sample(select, 2));
  }));
  return samples;
}

/// Names for the sets of instances on which a case was planned: none if there is only one, else
/// "10 instances", and "10 instances, set 2" if several have as many.
std::map<std::string, std::string> set_names(const SamplesByKey& samples) {
  std::map<std::string, std::string> names;
  for (const auto& [key, values] : samples) names[key.instances];
  if (names.size() < 2) return names;
  std::map<std::string, int> sets_of_size;
  for (auto& [keys, name] : names) {
    const auto count = std::count(keys.begin(), keys.end(), ',') + 1;
    name = fmt::format("{} instance{}", count, count == 1 ? "" : "s");
    if (const int number = ++sets_of_size[name]; number > 1) name += fmt::format(", set {}", number);
  }
  return names;
}

Result<Statement> prepare_case_trend(Database& database, const TrendMetric& metric) {
  const std::string context =
      metric.timed
          ? "host || ' ' || substr(machine, 1, 8) || ', ' || compiler || ' ' || compiler_version || ' ' || "
            "build_type || iif(assertions, ' assertions', '') || iif(sanitizers <> '', ' ' || "
            "sanitizers, '')"
          : "''";
  // v_trends has a row for each cell and metric; those of one metric say where and when.
  return Statement::prepare(
      database.connection(),
      fmt::format(
          "SELECT {}, (SELECT group_concat(instance_id) FROM "
          "  (SELECT DISTINCT instance_id FROM result WHERE cell_id = place.cell ORDER BY instance_id)), {}, "
          "{} "
          "FROM (SELECT commit_hash, commit_subject, committed_utc, started_utc, ancestor_count, dirty, "
          "  binary_hash, case_id, run, suite, branch, host, machine, compiler, compiler_version, "
          "  build_type, assertions, sanitizers, excluded_reason, solved, results, "
          "  (SELECT cell.id FROM cell JOIN run ON run.id = cell.run_id "
          "    WHERE run.uuid = v_trends.run AND cell.case_id = v_trends.case_id) AS cell, "
          "  (SELECT {} FROM cell_summary AS summary WHERE summary.case_id = v_trends.case_id "
          "    AND run_id = (SELECT id FROM run WHERE uuid = v_trends.run)) AS value "
          "  FROM v_trends WHERE metric = 'success') AS place WHERE case_id = ?1 "
          "AND value IS NOT NULL AND excluded_reason IS NULL AND (?2 IS NULL OR suite = ?2) "
          "AND (?3 IS NULL OR branch = ?3) "
          "AND (?4 IS NULL OR host = ?4 OR substr(machine, 1, length(?4)) = ?4)",
          context, kSampleColumns, kPlanningColumns, metric.sql),
      kReadingTrend);
}

/// Values of the plannings of a cell, none where one is not solved, by what tells them apart in every run of
/// the case: instance, repetition, and which of equal files it is.
using PlanningValues = std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::optional<double>>;

Result<PlanningValues> planning_values(Statement& select, std::int64_t cell) {
  PlanningValues values;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> occurrences;
  select.reset();
  SIPPLAB_TRY(select.bind(cell).for_each([&] {
    const std::pair planning(select.integer(0), select.integer(1));
    const std::int64_t occurrence = occurrences[planning]++;
    std::optional<double>& value = values[{planning.first, planning.second, occurrence}];
    if (select.integer(2) == static_cast<int>(ResultStatus::kSolved)) value = select.real(3);
  }));
  return values;
}

double solved_share(const Sample& sample) {
  return static_cast<double>(sample.solved) / static_cast<double>(sample.results);
}

/// Leaves runs out that solved far less than the best one: little would be left to compare the others by.
void leave_out_failures(std::vector<Sample>& samples) {
  double best = 0;
  for (const Sample& sample : samples) best = std::max(best, solved_share(sample));
  std::erase_if(samples,
                [best](const Sample& sample) { return solved_share(sample) < kLeastSolvedShare * best; });
}

/// Makes the values of runs of a series means over the plannings that all of them solved, as `sipplab
/// compare` pairs those of two: a version that fails on the hardest instance has no better plans.
Result<Done> compare_solved(Database& database, std::string_view value, std::vector<Sample>& samples,
                            TrendSeries& series) {
  bool all_solved = true;
  for (const Sample& sample : samples) {
    all_solved = all_solved && sample.solved == samples.front().results && sample.solved == sample.results;
    series.plannings = std::max(series.plannings, sample.results);
  }
  series.solved_by_all = series.plannings;
  if (all_solved) return Done{};
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      fmt::format("SELECT instance_id, repetition, status, {} FROM result WHERE cell_id = ? "
                  "ORDER BY instance_id, position, repetition",
                  value),
      kReadingTrend));
  std::vector<PlanningValues> runs;
  for (const Sample& sample : samples) {
    runs.push_back(SIPPLAB_TRY(planning_values(select, sample.cell)));
    std::erase_if(runs.front(), [&](const auto& planning) { return !runs.back().contains(planning.first); });
  }
  // A run may have repeated what others planned once.
  PlanningValues common = runs.front();
  if (!common.empty()) series.plannings = static_cast<std::int64_t>(common.size());
  std::erase_if(common, [&runs](const auto& planning) {
    return !std::all_of(runs.begin(), runs.end(),
                        [&](const PlanningValues& run) { return run.at(planning.first).has_value(); });
  });
  series.solved_by_all = static_cast<std::int64_t>(common.size());
  if (common.empty()) return Done{};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    double sum = 0;
    for (const auto& [planning, ignored] : common) sum += *runs[i].at(planning);
    samples[i].value = sum / static_cast<double>(common.size());
  }
  return Done{};
}

Result<std::vector<TrendSeries>> read_case_trends(Database& database, const TrendQuery& query) {
  const auto cases = SIPPLAB_TRY(find_cases(database, query.cases));
  auto select = SIPPLAB_TRY(prepare_case_trend(database, *query.metric));
  std::vector<TrendSeries> series;
  for (const CaseName& named : cases) {
    select.bind(named.id, query.suite, query.branch, query.machine);
    auto samples = SIPPLAB_TRY(read_samples(select));
    select.reset();
    std::map<std::string, std::string> names = set_names(samples);
    const std::string_view of_solved = query.metric->of_solved;
    for (auto& [key, values] : samples) {
      TrendSeries one{named.id, named.label, names[key.instances], key.context, {}, {}};
      if (!of_solved.empty()) {
        leave_out_failures(values);
        SIPPLAB_TRY(compare_solved(database, of_solved, values, one));
      }
      one.points = points_of(std::move(values), !of_solved.empty());
      series.push_back(std::move(one));
    }
  }
  return series;
}

Result<std::vector<TrendSeries>> read_commit_trend(Database& database, const TrendQuery& query) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      fmt::format("SELECT context, '', {}, {} FROM ({})", kSampleColumns, kNoPlannings, query.metric->sql),
      kReadingTrend));
  auto samples = SIPPLAB_TRY(read_samples(select));
  std::vector<TrendSeries> series;
  for (auto& [key, values] : samples) {
    series.push_back({0, key.context, "", "", points_of(std::move(values), false), {}});
  }
  return series;
}

double median_between(const std::vector<TrendPoint>& points, std::size_t begin, std::size_t end) {
  std::vector<double> values;
  for (std::size_t i = begin; i < end; ++i) values.push_back(points[i].value);
  return statistics::median(std::move(values)).value_or(0);
}

/// Drops the changes that are too small to matter. A level reaches from one change to the next,
/// so the levels are computed again whenever one is dropped.
void drop_small_changes(TrendSeries& series, const TrendMetric& metric, double min_effect) {
  for (;;) {
    std::size_t smallest = series.changes.size();
    double smallest_effect = min_effect;
    for (std::size_t i = 0; i < series.changes.size(); ++i) {
      TrendChange& change = series.changes[i];
      const std::size_t begin = i == 0 ? 0 : series.changes[i - 1].position;
      const std::size_t end =
          i + 1 == series.changes.size() ? series.points.size() : series.changes[i + 1].position;
      change.before = median_between(series.points, begin, change.position);
      change.after = median_between(series.points, change.position, end);
      const double effect = std::abs(effect_of(change, metric));
      if (effect < smallest_effect) {
        smallest = i;
        smallest_effect = effect;
      }
    }
    if (smallest == series.changes.size()) return;
    series.changes.erase(series.changes.begin() + static_cast<std::ptrdiff_t>(smallest));
  }
}

}  // namespace

Result<std::vector<TrendSeries>> read_trend(Database& database, const TrendQuery& query) {
  return query.metric->of_case ? read_case_trends(database, query) : read_commit_trend(database, query);
}

void mark_changes(std::vector<TrendSeries>& series, const TrendMetric& metric, const ChangeRules& rules) {
  struct Test {
    std::size_t series;
    statistics::Division division;
  };
  std::vector<Test> tests;
  std::vector<double> p_values;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].is_comparable()) continue;
    std::vector<double> values;
    for (const TrendPoint& point : series[i].points) values.push_back(point.value);
    for (const statistics::Division& division : statistics::divide(values, rules.search)) {
      tests.push_back({i, division});
      p_values.push_back(division.p_value);
    }
  }
  const std::vector<bool> stands = statistics::benjamini_hochberg(p_values, rules.false_discovery_rate);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (!stands[i] || !tests[i].division.accepted) continue;
    TrendChange change;
    change.position = tests[i].division.position;
    change.p_value = tests[i].division.p_value;
    series[tests[i].series].changes.push_back(change);
  }
  for (TrendSeries& one : series) {
    drop_small_changes(one, metric, rules.min_effect.value_or(metric.min_effect));
  }
}

}  // namespace sipplab::db
