// The history of a metric: which runs are one version, and where it stands among the others. Histories of
// commits are drawn with merges, equal dates and clocks that go wrong.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "db/measurements.hpp"
#include "db/run_names.hpp"
#include "db/trends.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_trends_laws {
namespace {

constexpr int kManyRuns = (kCasesOfHistories + 7) / 8;

constexpr std::int64_t kMillisecond = 1'000'000;

/// A commit for each number; parents have smaller numbers.
struct Graph {
  std::vector<std::vector<int>> parents;
  std::vector<int> dates;  ///< seconds, which may be equal or wrong

  /// Itself and all that it descends from.
  std::set<int> ancestors(int commit) const {
    std::set<int> found = {commit};
    std::vector<int> ahead = {commit};
    while (!ahead.empty()) {
      const int next = ahead.back();
      ahead.pop_back();
      for (const int parent : parents[static_cast<std::size_t>(next)]) {
        if (found.insert(parent).second) ahead.push_back(parent);
      }
    }
    return found;
  }
  std::int64_t on_first_parents(int commit) const {
    std::int64_t count = 1;
    while (!parents[static_cast<std::size_t>(commit)].empty()) {
      commit = parents[static_cast<std::size_t>(commit)].front();
      ++count;
    }
    return count;
  }
};

Graph any_graph(bool linear) {
  Graph graph;
  const auto commits = static_cast<int>(any_whole(1, 8));
  for (int commit = 0; commit < commits; ++commit) {
    std::vector<int> parents;
    if (commit > 0) parents.push_back(linear ? commit - 1 : static_cast<int>(any_whole(0, commit - 1)));
    if (commit > 1 && !linear && any_whole(0, 2) == 0) {
      const auto other = static_cast<int>(any_whole(0, commit - 1));
      if (other != parents[0]) parents.push_back(other);
    }
    graph.parents.push_back(parents);
    // In a line the clock goes right, though commits may share a second.
    const int before = linear && commit > 0 ? graph.dates.back() : 0;
    graph.dates.push_back(linear ? before + static_cast<int>(any_whole(0, 1))
                                 : static_cast<int>(any_whole(0, 3)));
  }
  return graph;
}

/// Hashes sort by another order than numbers.
std::string hash_of(int commit) {
  return std::string(39, 'b') + static_cast<char>('0' + (commit * 5 + 3) % 8);
}

CommitInfo info_of(const Graph& graph, int commit) {
  CommitInfo info;
  info.hash = hash_of(commit);
  info.committed_utc = second_number(graph.dates[static_cast<std::size_t>(commit)]);
  info.subject = "commit " + std::to_string(commit);
  const std::vector<int>& parents = graph.parents[static_cast<std::size_t>(commit)];
  if (!parents.empty()) info.first_parent = hash_of(parents[0]);
  for (std::size_t i = 1; i < parents.size(); ++i) info.later_parents.push_back(hash_of(parents[i]));
  info.ancestor_count = static_cast<std::int64_t>(graph.ancestors(commit).size());
  info.first_parent_count = graph.on_first_parents(commit);
  return info;
}

Sweep run_of(const std::optional<CommitInfo>& commit, std::int64_t milliseconds) {
  Sweep sweep;
  sweep.info.uuid = new_uuid();
  sweep.info.suite = "smoke";
  sweep.info.branch = "main";
  sweep.info.commit = commit;
  sweep.info.machine = machine_number(1);
  sweep.info.build = build_number(1);
  Planned planned{case_number(0), instance_number(0), {}};
  planned.row.status = ResultStatus::kSolved;
  planned.row.valid = true;
  planned.row.makespan_s = 1;
  planned.row.flowtime_s = 1;
  planned.row.planning_time_ns = milliseconds * kMillisecond;
  sweep.plannings.push_back(planned);
  return sweep;
}

std::vector<TrendSeries> trend(Database& database, const char* metric = "max-runtime") {
  TrendQuery query;
  query.metric = find_trend_metric(metric);
  return must(read_trend(database, query));
}

/// Recorded in any order, no commit stands before one that it descends from.
void versions_are_in_topological_order() {
  const Graph graph = any_graph(false);
  const NewHistory history;
  std::set<int> measured;
  for (const std::size_t commit : any_order(graph.parents.size())) {
    if (any_whole(0, 4) == 0) continue;
    const auto number = static_cast<int>(commit);
    record(history.path(), run_of(info_of(graph, number), 1 + number));
    measured.insert(number);
  }
  Database database = history.open();
  const auto series = trend(database);
  RC_ASSERT(series.size() == (measured.empty() ? 0U : 1U));
  if (measured.empty()) return;
  std::vector<int> order;
  for (const TrendPoint& point : series[0].points) {
    const int commit = std::stoi(point.subject.substr(7));
    RC_ASSERT(point.commit == hash_of(commit));
    RC_ASSERT(point.committed_utc == info_of(graph, commit).committed_utc);
    RC_ASSERT(point.ancestor_count == info_of(graph, commit).ancestor_count);
    RC_ASSERT(std::abs(point.value - (1 + commit) / 1000.0) < 1e-9);
    RC_ASSERT(point.runs == 1);
    RC_ASSERT(!point.dirty);
    order.push_back(commit);
  }
  RC_ASSERT(std::set<int>(order.begin(), order.end()) == measured);
  RC_ASSERT(order.size() == measured.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j)
      RC_ASSERT(graph.ancestors(order[i]).count(order[j]) == 0U);
  }
  // Of two with as many ancestors the earlier one, then the one whose hash is less.
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const CommitInfo a = info_of(graph, order[i]);
    const CommitInfo b = info_of(graph, order[i + 1]);
    RC_ASSERT(std::tie(a.ancestor_count, a.committed_utc, a.hash) <
              std::tie(b.ancestor_count, b.committed_utc, b.hash));
  }
  // The commands that list commits go by the same.
  const Table listed = rows_of(
      database,
      "SELECT commit_hash, parents FROM v_commits ORDER BY ancestor_count, committed_utc, commit_hash");
  RC_ASSERT(listed.rows.size() == order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    RC_ASSERT(std::get<std::string>(listed.rows[i][0]) == hash_of(order[i]));
    std::string parents;
    for (const int parent : graph.parents[static_cast<std::size_t>(order[i])])
      parents += (parents.empty() ? "" : " ") + hash_of(parent);
    RC_ASSERT(listed.rows[i][1] == (parents.empty() ? Value{Null{}} : Value{parents}));
  }
  RC_CLASSIFY(std::any_of(graph.parents.begin(), graph.parents.end(),
                          [](const auto& parents) { return parents.size() > 1; }),
              "with a merge");
}

/// Of a line of commits some were recorded in a shallow clone: dates tell their place.
void shallow_clones_go_by_dates() {
  const Graph graph = any_graph(true);
  const NewHistory history;
  bool shallow = false;
  for (const std::size_t commit : any_order(graph.parents.size())) {
    CommitInfo info = info_of(graph, static_cast<int>(commit));
    if (any_flag()) {
      info.ancestor_count = info.first_parent_count = 0;
      shallow = true;
    }
    record(history.path(), run_of(info, 1));
  }
  Database database = history.open();
  const auto series = trend(database);
  RC_ASSERT(series[0].points.size() == graph.parents.size());
  for (std::size_t i = 0; i + 1 < series[0].points.size(); ++i) {
    RC_ASSERT(series[0].points[i].committed_utc <= series[0].points[i + 1].committed_utc);
    RC_ASSERT(series[0].points[i].ancestor_count <= series[0].points[i + 1].ancestor_count);
  }
  RC_CLASSIFY(shallow, "some shallow");
}

/// Runs of one commit are one point, of uncommitted changes one for each program, and so without a commit.
void a_version_is_the_median_of_its_runs() {
  const Graph graph = any_graph(true);
  const NewHistory history;
  std::map<std::tuple<std::string, bool, std::string>, std::vector<double>> versions;
  for (auto left = any_whole(1, 7); left > 0; --left) {
    const auto number = static_cast<int>(any_whole(0, static_cast<std::int64_t>(graph.parents.size()) - 1));
    const bool has_commit = any_whole(0, 4) > 0;
    const auto milliseconds = any_whole(1, 20);
    Sweep sweep = run_of(has_commit ? std::optional(info_of(graph, number)) : std::nullopt, milliseconds);
    sweep.info.build.dirty = any_whole(0, 2) == 0;
    sweep.info.build.binary_hash = any_flag() ? "one" : "other";
    const BuildInfo& build = sweep.info.build;
    versions[{has_commit ? hash_of(number) : "", build.dirty,
              build.dirty || !has_commit ? build.binary_hash : ""}]
        .push_back(static_cast<double>(milliseconds) / 1000);
    record(history.path(), sweep);
  }
  Database database = history.open();
  const auto series = trend(database);
  RC_ASSERT(series.size() == 1U);
  RC_ASSERT(series[0].points.size() == versions.size());
  std::multiset<std::tuple<std::string, bool, std::int64_t, std::int64_t>> expected;
  std::multiset<std::tuple<std::string, bool, std::int64_t, std::int64_t>> found;
  for (auto& [version, values] : versions) {
    std::sort(values.begin(), values.end());
    const double median = (values[values.size() / 2] + values[(values.size() - 1) / 2]) / 2;
    expected.emplace(std::get<0>(version), std::get<1>(version), static_cast<std::int64_t>(values.size()),
                     std::llround(median * 1e6));
  }
  for (const TrendPoint& point : series[0].points)
    found.emplace(point.commit, point.dirty, point.runs, std::llround(point.value * 1e6));
  RC_ASSERT(found == expected);
}

/// What is asked for by suite, branch and machine.
void questions_are_narrowed() {
  const NewHistory history;
  struct Run {
    std::string suite, branch;
    int machine;
    std::int64_t number;
  };
  std::vector<Run> runs;
  const auto count = any_whole(1, 6);
  for (std::int64_t i = 0; i < count; ++i) {
    Run run{any_flag() ? "smoke" : "density", any_flag() ? "main" : "topic",
            static_cast<int>(any_whole(1, 2)), i + 1};
    Sweep sweep = run_of(commit_number(static_cast<int>(i) % 3 + 1), run.number);
    sweep.info.suite = run.suite;
    sweep.info.branch = run.branch;
    sweep.info.machine = machine_number(run.machine);
    record(history.path(), sweep);
    runs.push_back(std::move(run));
  }
  Database database = history.open();
  TrendQuery query;
  query.metric = find_trend_metric("tries");
  if (any_flag()) query.suite = any_flag() ? "smoke" : "density";
  if (any_flag()) query.branch = any_flag() ? "main" : "topic";
  const auto machine = static_cast<int>(any_whole(0, 2));
  const std::string print = machine > 0 ? fingerprint(machine_number(machine)) : "";
  if (machine > 0)
    query.machine = any_flag() ? machine_number(machine).host
                               : print.substr(0, static_cast<std::size_t>(any_whole(8, 16)));
  std::int64_t expected = 0;
  for (const Run& run : runs) {
    expected += run.suite == query.suite.value_or(run.suite) &&
                        run.branch == query.branch.value_or(run.branch) &&
                        (machine == 0 || run.machine == machine)
                    ? 1
                    : 0;
  }
  std::int64_t found = 0;
  for (const TrendSeries& one : must(read_trend(database, query))) {
    for (const TrendPoint& point : one.points) found += point.runs;
  }
  RC_ASSERT(found == expected);
}

/// Where a case was planned on several sets of instances, each set has its own series.
void sets_of_instances_stay_apart() {
  const NewHistory history;
  std::map<std::set<int>, std::int64_t> sets;
  for (auto left = any_whole(1, 5); left > 0; --left) {
    std::set<int> instances;
    for (int instance = 0; instance < 3; ++instance) {
      if (any_flag()) instances.insert(instance);
    }
    if (instances.empty()) continue;
    Sweep sweep = run_of(commit_number(static_cast<int>(any_whole(1, 3))), 1);
    const Planned planned = sweep.plannings.front();
    sweep.plannings.clear();
    for (const int instance : instances) {
      for (std::int64_t repetition = 0; repetition < 2; ++repetition) {
        sweep.plannings.push_back(planned);
        sweep.plannings.back().instance = instance_number(instance);
        sweep.plannings.back().row.position = instance;
        sweep.plannings.back().row.repetition = repetition;
      }
    }
    record(history.path(), sweep);
    ++sets[instances];
  }
  Database database = history.open();
  const auto series = trend(database, "tries");
  RC_ASSERT(series.size() == sets.size());
  std::set<std::string> names;
  std::multiset<std::pair<std::size_t, std::int64_t>> expected;
  std::multiset<std::pair<std::size_t, std::int64_t>> found;
  for (const auto& [instances, runs] : sets) expected.emplace(instances.size(), runs);
  for (const TrendSeries& one : series) {
    RC_ASSERT(one.instances.empty() == (sets.size() == 1));
    RC_ASSERT(names.insert(one.instances).second);
    std::int64_t runs = 0;
    for (const TrendPoint& point : one.points) runs += point.runs;
    const std::size_t size = sets.size() == 1 ? sets.begin()->first.size() : std::stoul(one.instances);
    found.emplace(size, runs);
    if (sets.size() > 1) RC_ASSERT((one.instances.find(" instances") == std::string::npos) == (size == 1));
  }
  RC_ASSERT(found == expected);
}

// --- metrics ------------------------------------------------------------------------

/// What a metric is of the rows of one run.
std::map<std::string, std::optional<double>> values_of(const std::vector<ResultRow>& rows, double limit_s) {
  std::map<std::string, std::optional<double>> values;
  const auto mean = [&rows](const auto& value, bool solved_only) -> std::optional<double> {
    double sum = 0;
    double count = 0;
    for (const ResultRow& row : rows) {
      if (solved_only && row.status != ResultStatus::kSolved) continue;
      sum += value(row);
      ++count;
    }
    return count == 0 ? std::nullopt : std::optional(sum / count);
  };
  const auto seconds = [](const ResultRow& row) { return static_cast<double>(row.planning_time_ns) / 1e9; };
  const auto solves = [](const ResultRow& row) { return row.status == ResultStatus::kSolved; };
  std::vector<double> times;
  double longest = 0;
  for (const ResultRow& row : rows) {
    times.push_back(solves(row) ? seconds(row) : std::numeric_limits<double>::infinity());
    longest = std::max(longest, seconds(row));
  }
  std::sort(times.begin(), times.end());
  const double middle = (times[times.size() / 2] + times[(times.size() - 1) / 2]) / 2;
  values["success"] = mean([&](const ResultRow& row) { return solves(row) ? 1.0 : 0.0; }, false);
  if (std::isfinite(middle)) values["runtime"] = middle;
  values["mean-runtime"] = mean(seconds, true);
  values["max-runtime"] = longest;
  const auto par2 =
      mean([&](const ResultRow& row) { return solves(row) ? seconds(row) : 2 * limit_s; }, false);
  if (std::isfinite(*par2)) values["par2"] = par2;
  values["makespan"] = mean([](const ResultRow& row) { return *row.makespan_s; }, true);
  values["flowtime"] = mean([](const ResultRow& row) { return *row.flowtime_s; }, true);
  values["tries"] = mean([](const ResultRow& row) { return static_cast<double>(row.tries); }, false);
  values["expansions"] =
      mean([](const ResultRow& row) { return static_cast<double>(row.expansions); }, false);
  values["generations"] =
      mean([](const ResultRow& row) { return static_cast<double>(row.generations); }, false);
  return values;
}

void metrics_are_what_they_are_called() {
  const NewHistory history;
  Sweep sweep = run_of(commit_number(1), 1);
  sweep.plannings.clear();
  std::vector<ResultRow> rows;
  const CaseInfo parameters = case_number(any_flag() ? 2 : 0);
  for (auto left = any_whole(1, 5); left > 0; --left) {
    Planned planned{parameters, instance_number(0), any_result()};
    planned.row.position = left;
    rows.push_back(planned.row);
    sweep.plannings.push_back(planned);
  }
  record(history.path(), sweep);
  Database database = history.open();
  auto expected = values_of(rows, parameters.real("time_limit_s"));
  for (const TrendMetric& metric : trend_metrics()) {
    if (!metric.of_case) continue;
    RC_LOG() << metric.name << '\n';
    const auto series = trend(database, std::string(metric.name).c_str());
    const auto& value = expected[std::string(metric.name)];
    RC_ASSERT(series.size() == (value ? 1U : 0U));
    if (value) RC_ASSERT(std::abs(series[0].points.at(0).value - *value) < 1e-9);
  }
}

/// What is of solved plannings is, for every version, of those that all versions solved.
void solved_plannings_are_paired() {
  using Planning = std::pair<int, std::int64_t>;
  const NewHistory history;
  const auto instances = static_cast<int>(any_whole(1, 3));
  std::map<std::string, std::map<Planning, double>> solved;  // flowtimes of each commit
  for (auto number = static_cast<int>(any_whole(1, 4)); number > 0; --number) {
    Sweep sweep = run_of(commit_number(number), 1);
    const Planned planned = sweep.plannings.front();
    sweep.plannings.clear();
    std::map<Planning, double> flowtimes;
    for (int instance = 0; instance < instances; ++instance) {
      for (std::int64_t repetition = 0; repetition < 2; ++repetition) {
        Planned one = planned;
        one.instance = instance_number(instance);
        if (any_whole(0, 4) == 0) {
          one.row = ResultRow{};
        } else {
          one.row.flowtime_s = static_cast<double>(any_whole(1, 8));
          flowtimes[{instance, repetition}] = *one.row.flowtime_s;
        }
        one.row.position = instance;
        one.row.repetition = repetition;
        sweep.plannings.push_back(one);
      }
    }
    record(history.path(), sweep);
    if (!flowtimes.empty()) solved[sweep.info.commit->hash] = flowtimes;
  }
  std::size_t most = 0;
  for (const auto& [commit, flowtimes] : solved) most = std::max(most, flowtimes.size());
  std::erase_if(solved, [most](const auto& version) { return 2 * version.second.size() < most; });
  std::set<Planning> common;
  for (int instance = 0; instance < instances; ++instance) {
    for (std::int64_t repetition = 0; repetition < 2; ++repetition) {
      const Planning planning(instance, repetition);
      const bool by_all = std::all_of(solved.begin(), solved.end(), [&planning](const auto& version) {
        return version.second.count(planning) > 0;
      });
      if (by_all) common.insert(planning);
    }
  }
  Database database = history.open();
  const auto series = trend(database, "flowtime");
  RC_ASSERT(series.size() == (solved.empty() ? 0U : 1U));
  if (solved.empty()) return;
  RC_ASSERT(series[0].plannings == 2 * instances);
  RC_ASSERT(series[0].solved_by_all == static_cast<std::int64_t>(common.size()));
  RC_ASSERT(series[0].is_comparable() == !common.empty());
  RC_ASSERT(series[0].points.size() == solved.size());
  for (const TrendPoint& point : series[0].points) {
    const std::map<Planning, double>& flowtimes = solved.at(point.commit);
    double sum = 0;
    double count = 0;
    for (const auto& [planning, flowtime] : flowtimes) {
      if (!common.empty() && common.count(planning) == 0) continue;
      sum += flowtime;
      ++count;
    }
    RC_ASSERT(std::abs(point.value - sum / count) < 1e-9);
    const double share = static_cast<double>(flowtimes.size()) / (2.0 * instances);
    RC_ASSERT(std::abs(point.solved_share.value_or(-1) - share) < 1e-9);
  }
  RC_CLASSIFY(common.empty(), "nothing in common");
}

/// Of campaigns, properties and imported reports: each number from its own runs, in its unit.
void other_metrics_are_what_they_are_called() {
  const NewHistory history;
  Database database = history.open();
  std::map<std::string, std::multiset<double>> expected;
  std::map<std::string, std::pair<double, double>> properties;  // cases, and failures by runs, of each commit
  std::map<std::string, double> property_runs;
  for (auto left = any_whole(0, 4); left > 0; --left) {
    const PropertyRun run = any_property_run();
    const RunOrigin origin = any_origin();
    const bool planted = any_whole(0, 2) == 0;
    must(record_property_runs(database, origin, {run}, planted ? "a-mutant" : ""));
    if (planted || !origin.commit) continue;
    auto& [cases, failures] = properties[origin.commit->hash];
    cases += static_cast<double>(run.cases);
    failures += run.status == "passed" ? 0 : 1;
    ++property_runs[origin.commit->hash];
  }
  for (const auto& [hash, sums] : properties) {
    expected["property-cases"].insert(sums.first);
    expected["property-failures"].insert(sums.second / property_runs[hash]);
  }
  for (auto left = any_whole(0, 2); left > 0; --left) {
    FuzzRun run = any_fuzz_run();
    run.target = "target " + std::to_string(left);  // a series of its own
    must(record_fuzz_run(database, any_origin(), run));
    expected["fuzz-edges"].insert(static_cast<double>(run.edges));
    if (run.wall_time_ns > 0)
      expected["fuzz-speed"].insert(static_cast<double>(run.executions) /
                                    (static_cast<double>(run.wall_time_ns) / 1e9));
  }
  if (any_flag()) {
    MeasurementRun report = any_report();
    std::map<std::string, std::vector<double>> times;
    for (const Measurement& one : report.measurements) {
      if (one.real_time_ns) times[one.benchmark].push_back(*one.real_time_ns / 1e9);
    }
    for (const auto& [benchmark, seconds] : times) {
      expected["benchmark-time"].insert(seconds.size() == 1 ? seconds[0] : (seconds[0] + seconds[1]) / 2);
    }
    must(record_measurements(database, report));
  }
  for (const TrendMetric& metric : trend_metrics()) {
    if (metric.of_case || metric.name == "fuzz-coverage") continue;
    std::multiset<double> found;
    for (const TrendSeries& one : trend(database, std::string(metric.name).c_str())) {
      for (const TrendPoint& point : one.points) found.insert(point.value);
    }
    RC_LOG() << metric.name << '\n';
    const std::multiset<double>& wanted = expected[std::string(metric.name)];
    // Sums and quotients in another sequence differ in their last bits.
    constexpr double kRounding = 1e-12;
    RC_ASSERT(std::equal(found.begin(), found.end(), wanted.begin(), wanted.end(),
                         [](double a, double b) { return std::abs(a - b) <= kRounding * std::abs(b); }));
  }
}

const PropertyRoom room("history_trends", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("versions are in topological order, whatever merges and clocks say",
                     versions_are_in_topological_order, kManyRuns);
  passed &= property("where a shallow clone knows no counts, dates tell the place",
                     shallow_clones_go_by_dates, kManyRuns);
  passed &= property("a version is the median of its runs", a_version_is_the_median_of_its_runs, kManyRuns);
  passed &= property("a trend is of the suite, branch and machine that are asked for", questions_are_narrowed,
                     kManyRuns);
  passed &= property("sets of instances have series of their own", sets_of_instances_stay_apart, kManyRuns);
  passed &= property("a metric of a case is what it is called", metrics_are_what_they_are_called, kManyRuns);
  passed &= property("what is of solved plannings is of those that all versions solved",
                     solved_plannings_are_paired, kManyRuns);
  passed &= property("metrics of properties, fuzzing and reports are what they are called",
                     other_metrics_are_what_they_are_called, kManyRuns);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_trends_laws
