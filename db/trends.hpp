// The history of a metric: one series per case and set of instances, one point per commit, and
// where the level changed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"
#include "db/statistics/change_points.hpp"

namespace sipplab::db {

struct TrendMetric {
  std::string_view name;
  std::string_view meaning;
  std::string_view unit;  ///< "s"; empty for counts and rates
  bool higher_is_better = false;
  /// Depends on the clock: compared on one machine and kind of build only.
  bool timed = false;
  /// Of a case of the planner; else of the property runs, fuzz targets or imported benchmarks of
  /// a commit, and cases, suite, branch and machine of a query do not apply.
  bool of_case = true;
  /// Smallest change worth a mark: a share of the level, or a difference for rates.
  double min_effect = 0;
  bool rate = false;  ///< 0..1: effects are differences
  /// Of a case: an expression over the columns of cell_summary. Else a SELECT with the columns context,
  /// commit_hash, commit_subject, committed_utc, ancestor_count, started_utc, dirty, binary_hash, value.
  std::string sql = {};
  /// Of a case, and of solved plannings alone: an expression over the columns of result. The trend is then a
  /// mean over the plannings that all runs of a series solved; `sql` is over those that each solved.
  std::string_view of_solved = {};
};

const std::vector<TrendMetric>& trend_metrics();
const TrendMetric* find_trend_metric(std::string_view name);

/// Which cases: empty fields admit all.
struct CaseFilter {
  std::optional<std::int64_t> id;
  std::optional<std::string> environment;
  std::optional<std::int64_t> robots;
  std::optional<std::string> map;
  std::optional<std::string> planner;  ///< as the table has it: "sipplab weight:1.05", "cmd:mine"
  /// Of the planner, as CaseInfo has them; NULL: a case without it.
  std::map<std::string, Value> options;
};

struct TrendQuery {
  const TrendMetric* metric = nullptr;
  CaseFilter cases;
  std::optional<std::string> suite;
  std::optional<std::string> branch;   ///< runs of a checkout of this branch
  std::optional<std::string> machine;  ///< beginning of a fingerprint, or a host
};

/// What was measured of one version of the program: median of the runs at a commit. A build
/// with uncommitted changes, or without a commit, is a version of its own.
struct TrendPoint {
  std::string commit;  ///< full hash; empty if there is none
  bool dirty = false;
  std::string subject;
  std::string committed_utc;  ///< or the start of the run if there is no commit
  std::string started_utc;    ///< of its first run
  std::int64_t ancestor_count =
      0;  ///< of the commit, by which points are in order; or that of those before it
  std::int64_t runs = 0;
  double value = 0;
  std::optional<double> solved_share = {};  ///< of all its plannings, for metrics of solved ones
};

struct TrendChange {
  std::size_t position = 0;  ///< of the first point of the new level
  double before = 0;         ///< median of the level before, and after
  double after = 0;
  double p_value = 1;
};

struct TrendSeries {
  std::int64_t case_id = 0;  ///< 0: not of a case
  std::string label;         ///< the case in words
  /// "10 instances": of a case that was planned on several sets of them, which are not compared
  /// with each other; else empty.
  std::string instances;
  std::string context;             ///< machine and build, of timed metrics
  std::vector<TrendPoint> points;  ///< in order of history
  std::vector<TrendChange> changes;
  /// Of metrics of solved plannings: how many all runs made, and how many of them all solved.
  std::int64_t plannings = 0;
  std::int64_t solved_by_all = 0;

  /// Else each value is over other plannings, and no change is one of the planner.
  bool is_comparable() const { return plannings == 0 || solved_by_all > 0; }
};

/// Of the share that the best run of a series solved: runs that solved less are no part of trends of solved
/// plannings.
constexpr double kLeastSolvedShare = 0.5;

/// Series with at least one point, by case, context and set of instances. Excluded runs are left out, and of
/// metrics of solved plannings those that solved less than kLeastSolvedShare, or none.
Result<std::vector<TrendSeries>> read_trend(Database& database, const TrendQuery& query);

struct ChangeRules {
  statistics::ChangePointOptions search;
  double false_discovery_rate = 0.05;
  std::optional<double> min_effect;  ///< instead of the metric's
};

/// Fills in the changes of all series that are comparable, judged together.
void mark_changes(std::vector<TrendSeries>& series, const TrendMetric& metric, const ChangeRules& rules = {});

/// after / before - 1, or after - before for rates. Infinite if the level before is 0.
double effect_of(const TrendChange& change, const TrendMetric& metric);

}  // namespace sipplab::db
