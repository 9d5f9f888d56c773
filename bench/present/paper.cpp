#include "bench/present/paper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "bench/present/named_row.hpp"
#include "bench/present/numbers.hpp"
#include "db/queries.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {
namespace {

/// The paper's maps in one run.
constexpr const char* kPaperMaps = "run = :run AND map_spec IN ('files', 'empty:32x32', 'warehouse')";

/// Sums over instances, each with its number of runs, of solved runs, and their costs added up: seeds of
/// random re-scheduling that never had to re-schedule are one observation, not ten.
std::string paper_cells_sql() {
  return fmt::format(
      "WITH instance AS ("
      "  SELECT CASE WHEN instr(environment, '/') > 0 THEN substr(environment, instr(environment, '/') + 1)"
      "    ELSE environment END AS environment, robots, ssi_s, reschedule, initial_order, position,"
      "    count(*) AS runs, sum(status = 'solved') AS solved, sum(planning_time_s) AS seconds,"
      "    sum(CASE status WHEN 'solved' THEN makespan_s END) AS makespan_s,"
      "    sum(CASE status WHEN 'solved' THEN flowtime_s END) AS flowtime_s "
      "  FROM v_all_results WHERE {} AND planner = :method GROUP BY 1, 2, 3, 4, 5, 6) "
      "SELECT environment, robots, ssi_s, reschedule, initial_order, sum(runs) AS runs, sum(solved) AS "
      "solved,"
      "  sum(seconds) / sum(runs) AS mean_seconds, count(*) AS instances, sum(solved > 0) AS with_plan,"
      "  sum(runs * runs) AS runs_squares, sum(runs * solved) AS runs_solved,"
      "  sum(solved * solved) AS solved_squares, sum(makespan_s) AS makespan,"
      "  sum(makespan_s * solved) AS makespan_solved, sum(makespan_s * makespan_s) AS makespan_squares,"
      "  sum(flowtime_s) AS flowtime, sum(flowtime_s * solved) AS flowtime_solved,"
      "  sum(flowtime_s * flowtime_s) AS flowtime_squares "
      "FROM instance GROUP BY 1, 2, 3, 4, 5 ORDER BY 1, 4, 5, 3, 2",
      kPaperMaps);
}

/// A share of two sums over instances, such as cost over solved runs: sums of both, of their squares and of
/// their product.
struct RatioOfSums {
  std::int64_t instances = 0;
  double part = 0;
  double whole = 0;
  double part_squares = 0;
  double products = 0;
  double whole_squares = 0;

  double value() const { return part / whole; }
  /// Of the value, by the scatter of part - value * whole over instances (Cochran 1977, section 2.11).
  double variance() const {
    const auto n = static_cast<double>(instances);
    const double scatter =
        std::max(0.0, part_squares - 2 * value() * products + value() * value() * whole_squares);
    return scatter * n / (n - 1) / (whole * whole);
  }
};

/// Half the width of a 95 % interval.
double error_of(const RatioOfSums& ratio) {
  if (ratio.instances < kFewestInstances) return std::numeric_limits<double>::infinity();
  return db::statistics::t_quantile(static_cast<double>(ratio.instances - 1)) * std::sqrt(ratio.variance());
}

/// Between the number of instances and that of runs.
double independent_runs(const RatioOfSums& success) {
  const auto fewest = static_cast<double>(success.instances);
  const double rate = success.value();
  if (success.instances < 2 || rate <= 0 || rate >= 1) return fewest;
  const double variance = success.variance();
  return variance > 0 ? std::clamp(rate * (1 - rate) / variance, fewest, success.whole) : success.whole;
}

/// The cells of one method, found by robots and start-safe interval.
class Cells {
 public:
  explicit Cells(const std::vector<MeasuredCell>& cells) : cells_(cells) {}

  const MeasuredCell* find(std::string_view environment, std::string_view reschedule, std::string_view order,
                           std::int64_t robots, double ssi_s) const {
    const auto found = std::find_if(cells_.begin(), cells_.end(), [&](const MeasuredCell& cell) {
      return cell.environment == environment && cell.reschedule == reschedule && cell.order == order &&
             cell.robots == robots && cell.ssi_s == ssi_s;
    });
    return found == cells_.end() ? nullptr : &*found;
  }
  /// Figure 1.
  const MeasuredCell* figure(std::int64_t robots, double ssi_s) const {
    return find("empty", "none", "shortest", robots, ssi_s);
  }
  /// Table 1.
  const MeasuredCell* table(std::string_view reschedule, std::int64_t robots,
                            std::string_view order = "shortest") const {
    constexpr double kTableSsiS = 5;
    return find("warehouse", reschedule, order, robots, kTableSsiS);
  }

 private:
  const std::vector<MeasuredCell>& cells_;
};

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::int64_t kFigureRobots[] = {8, 16, 32, 48, 64, 96, 128, 160, 192, 256, 320};
constexpr double kFigureSsiS[] = {1, 3, 5, 7, 9};
constexpr std::int64_t kTableRobots[] = {16, 32, 64, 96, 128, 160, 192};
/// From this number of robots on, most instances of the warehouse need another order.
constexpr std::int64_t kDense = 96;

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

Claim over_80_percent(const Cells& cells) {
  Claim claim{
      "fig1-a", "empty, 192 robots: over 80 % solved with a start-safe interval of 3 or more", {}, ""};
  for (const double ssi_s : kFigureSsiS) {
    const MeasuredCell* cell = ssi_s >= 3 ? cells.figure(192, ssi_s) : nullptr;
    if (cell == nullptr) continue;
    claim.holds = claim.holds.value_or(true) && cell->success() > 0.8;
    claim.figures += fmt::format("{}ssi {}: {}", claim.figures.empty() ? "" : ", ", ssi_text(ssi_s),
                                 percent(cell->success()));
  }
  return claim;
}

Claim none_without(const Cells& cells) {
  Claim claim{"fig1-b", "empty, 192 robots: none solved without start-safe intervals", {}, ""};
  if (const MeasuredCell* cell = cells.figure(192, 0)) {
    claim.holds = cell->solved == 0;
    claim.figures = percent(cell->success());
  }
  return claim;
}

Claim rises_with_interval(const Cells& cells) {
  Claim claim{"fig1-c", "a start-safe interval lifts success, and more so with more than 64 robots", {}, ""};
  double few = 0, many = 0;
  int few_count = 0, many_count = 0;
  for (const std::int64_t robots : kFigureRobots) {
    const MeasuredCell* without = cells.figure(robots, 0);
    const MeasuredCell* with = cells.figure(robots, 5);
    if (without == nullptr || with == nullptr || (without->solved == 0 && with->solved == 0)) {
      continue;  // hopeless with both
    }
    (robots > 64 ? many : few) += with->success() - without->success();
    ++(robots > 64 ? many_count : few_count);
  }
  if (few_count == 0 || many_count == 0) return claim;
  few /= few_count;
  many /= many_count;
  claim.holds = many > 0 && many > few;
  claim.figures =
      fmt::format("ssi 5 over 0: {:+.0f} points up to 64 robots, {:+.0f} beyond", 100 * few, 100 * many);
  return claim;
}

Claim infinity_is_worst(const Cells& cells) {
  Claim claim{"fig1-d", "an infinite start-safe interval is the worst choice", {}, ""};
  double infinite = 0, least = 0;
  double least_ssi_s = 0;
  int counted = 0;
  std::vector<std::pair<double, double>> sums;  // ssi, success over the same densities
  for (const double ssi_s : kFigureSsiS) {
    double sum = 0, sum_infinite = 0;
    int count = 0;
    for (const std::int64_t robots : kFigureRobots) {
      const MeasuredCell* cell = cells.figure(robots, ssi_s);
      const MeasuredCell* endless = cells.figure(robots, kInfinite);
      if (cell == nullptr || endless == nullptr) continue;
      sum += cell->success();
      sum_infinite += endless->success();
      ++count;
    }
    if (count == 0) continue;
    if (counted++ == 0 || sum / count < least) {
      least = sum / count;
      least_ssi_s = ssi_s;
      infinite = sum_infinite / count;
    }
  }
  if (counted == 0) return claim;
  if (least == 1 && infinite == 1) return claim;  // nothing is hard enough to tell
  claim.holds = infinite < least;
  claim.figures = fmt::format("{} over all densities, next worst {} with ssi {}", percent(infinite),
                              percent(least), ssi_text(least_ssi_s));
  return claim;
}

Claim falls_at_once(const Cells& cells) {
  Claim claim{"tab1-a", "warehouse: success falls at once, 160 robots solved, 192 not", {}, ""};
  const MeasuredCell* before = cells.table("deterministic", 160);
  const MeasuredCell* after = cells.table("deterministic", 192);
  if (before == nullptr || after == nullptr) return claim;
  claim.holds = before->success() > 0.9 && after->success() < 0.1;
  claim.figures =
      fmt::format("160 robots {}, 192 robots {}", percent(before->success()), percent(after->success()));
  return claim;
}

Claim solves_where_random_fails(const Cells& cells) {
  Claim claim{
      "tab1-b", "160 robots: deterministic re-scheduling solves almost all, random under half", {}, ""};
  const MeasuredCell* ours = cells.table("deterministic", 160);
  const MeasuredCell* random = cells.table("random", 160);
  if (ours == nullptr || random == nullptr) return claim;
  claim.holds = ours->success() > 0.95 && random->success() < 0.5;
  claim.figures =
      fmt::format("deterministic {}, random {}", percent(ours->success()), percent(random->success()));
  return claim;
}

/// A claim on deterministic against random re-scheduling at every measured density from
/// kDense on at which both solve at least `least_success`; `ratio` gives deterministic over random.
template <class Ratio, class Judge>
Claim at_dense_cells(Claim claim, const Cells& cells, double least_success, const Ratio& ratio,
                     const Judge& judge) {
  for (const std::int64_t robots : kTableRobots) {
    const MeasuredCell* ours = cells.table("deterministic", robots);
    const MeasuredCell* random = cells.table("random", robots);
    if (robots < kDense || ours == nullptr || random == nullptr) continue;
    if (std::min(ours->success(), random->success()) < least_success) continue;
    const double value = ratio(*ours, *random);
    claim.holds = claim.holds.value_or(true) && judge(value);
    claim.figures +=
        fmt::format("{}{} robots: {:.3f} of random's", claim.figures.empty() ? "" : ", ", robots, value);
  }
  return claim;
}

/// Where one solves fewer, it solves the easier ones, and means say nothing of the two.
constexpr double kBothSolve = 0.9;

Claim is_faster(const Cells& cells) {
  return at_dense_cells(
      {"tab1-c", "deterministic re-scheduling is faster where orders have to be changed", {}, ""}, cells,
      0.01, [](const auto& ours, const auto& random) { return ours.mean_seconds / random.mean_seconds; },
      [](double ratio) { return ratio < 1; });
}

Claim flowtime_is_better(const Cells& cells) {
  return at_dense_cells(
      {"tab1-d", "its flowtime is the same or slightly less", {}, ""}, cells, kBothSolve,
      [](const auto& ours, const auto& random) { return *ours.mean_flowtime_s / *random.mean_flowtime_s; },
      [](double ratio) { return ratio < 1 + kFlowtimeShare; });
}

Claim makespan_is_worse(const Cells& cells) {
  return at_dense_cells(
      {"tab1-e", "its makespan goes up", {}, ""}, cells, kBothSolve,
      [](const auto& ours, const auto& random) { return *ours.mean_makespan_s / *random.mean_makespan_s; },
      [](double ratio) { return ratio > 1; });
}

Claim longest_first_for_makespan(const Cells& cells) {
  Claim claim{
      "tab1-f", "longest first with random re-scheduling is the alternative where makespan matters", {}, ""};
  for (const std::int64_t robots : kTableRobots) {
    const MeasuredCell* shortest = cells.table("deterministic", robots);
    const MeasuredCell* longest = cells.table("random", robots, "longest");
    if (shortest == nullptr || longest == nullptr) continue;
    if (shortest->success() < kBothSolve || longest->success() < kBothSolve) continue;
    claim.holds = claim.holds.value_or(true) && *longest->mean_makespan_s < *shortest->mean_makespan_s;
    claim.figures += fmt::format("{}{} robots: {:.1f} s against {:.1f} s", claim.figures.empty() ? "" : ", ",
                                 robots, *longest->mean_makespan_s, *shortest->mean_makespan_s);
  }
  return claim;
}

Standing cost_standing(const std::optional<double>& measured, double error,
                       const std::optional<double>& paper, double share) {
  if (!measured || !paper || !std::isfinite(error)) return Standing::kNotMeasured;
  if (std::abs(*measured - *paper) <= std::max(share * *paper, error)) return Standing::kReproduced;
  return *measured < *paper ? Standing::kBetter : Standing::kDiffers;
}

Standing success_standing(const MeasuredCell& cell, double paper) {
  const db::statistics::ConfidenceInterval interval = cell.success_interval();
  if (interval.low <= paper && paper <= interval.high) return Standing::kReproduced;
  return cell.success() > paper ? Standing::kBetter : Standing::kDiffers;
}

/// How the planner of the run is called; of several, the paper's.
db::Result<std::string> method_of(const std::filesystem::path& database, const std::string& run) {
  const auto table = SIPPLAB_TRY(db::run_sql(
      database,
      fmt::format("SELECT DISTINCT planner AS method FROM v_all_results WHERE {} ORDER BY 1", kPaperMaps),
      {{"run", run}}));
  std::string names;
  for (const auto& row : table.rows) {
    const std::string name = NamedRow(table, row).text("method");
    if (table.rows.size() == 1 || name == kPaperMethod) return name;
    names += (names.empty() ? "" : ", ") + name;
  }
  if (names.empty()) return std::string(kPaperMethod);  // nothing was measured
  return Unexpected{db::Error{db::ErrorKind::kBadInput,
                              fmt::format("{}: run {} has {}, expected one planner, or {} among them",
                                          database.string(), run, names, kPaperMethod)}};
}

}  // namespace

db::statistics::ConfidenceInterval MeasuredCell::success_interval() const {
  const double of = independent_runs.value_or(static_cast<double>(runs));
  return db::statistics::wilson_interval(success() * of, of);
}

db::Result<std::vector<MeasuredCell>> measured_cells(const std::filesystem::path& database,
                                                     const std::string& run) {
  const auto method = SIPPLAB_TRY(method_of(database, run));
  const auto table =
      SIPPLAB_TRY(db::run_sql(database, paper_cells_sql(), {{"run", run}, {"method", method}}));
  std::vector<MeasuredCell> cells;
  for (const auto& values : table.rows) {
    const NamedRow row(table, values);
    MeasuredCell cell;
    cell.environment = row.text("environment");
    if (cell.environment != "empty" && cell.environment != "warehouse") continue;
    cell.method = method;
    cell.robots = row.integer("robots");
    cell.ssi_s = row.real("ssi_s");
    cell.reschedule = row.text("reschedule");
    cell.order = row.text("initial_order");
    cell.runs = row.integer("runs");
    cell.solved = row.integer("solved");
    cell.mean_seconds = row.real("mean_seconds");
    cell.instances = row.integer("instances");
    cell.independent_runs =
        independent_runs({row.integer("instances"), row.real("solved"), row.real("runs"),
                          row.real("solved_squares"), row.real("runs_solved"), row.real("runs_squares")});
    if (cell.solved > 0) {
      const auto per_solved = [&row](const std::string& cost) {
        return RatioOfSums{row.integer("with_plan"),   row.real(cost),
                           row.real("solved"),         row.real(cost + "_squares"),
                           row.real(cost + "_solved"), row.real("solved_squares")};
      };
      const RatioOfSums makespan = per_solved("makespan");
      const RatioOfSums flowtime = per_solved("flowtime");
      cell.mean_makespan_s = makespan.value();
      cell.mean_flowtime_s = flowtime.value();
      cell.makespan_error_s = error_of(makespan);
      cell.flowtime_error_s = error_of(flowtime);
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

const std::vector<PaperRow>& paper_table() {
  static const std::vector<PaperRow> rows = {{16, "random", 1.00, 0.01, 33.31, 285.15},
                                             {32, "random", 1.00, 0.04, 36.68, 591.30},
                                             {64, "random", 1.00, 0.22, 41.25, 1274.94},
                                             {96, "random", 1.00, 0.68, 50.05, 2212.14},
                                             {128, "random", 1.00, 5.73, 62.23, 3543.92},
                                             {160, "random", 0.42, 117.82, 79.73, 5220.90},
                                             {192, "random", 0.00},
                                             {16, "deterministic", 1.00, 0.01, 33.31, 285.15},
                                             {32, "deterministic", 1.00, 0.04, 36.68, 591.30},
                                             {64, "deterministic", 1.00, 0.17, 42.05, 1252.82},
                                             {96, "deterministic", 1.00, 0.49, 50.42, 2149.31},
                                             {128, "deterministic", 1.00, 1.40, 66.15, 3322.52},
                                             {160, "deterministic", 0.99, 28.28, 100.50, 5298.85},
                                             {192, "deterministic", 0.00}};
  return rows;
}

std::string_view name(Standing standing) {
  constexpr std::string_view kNames[] = {"reproduced", "better", "differs", ""};
  return kNames[static_cast<std::size_t>(standing)];
}

std::vector<TableLine> compare_with_table(const std::vector<MeasuredCell>& cells) {
  const Cells found(cells);
  std::vector<TableLine> lines;
  for (const PaperRow& paper : paper_table()) {
    TableLine line{paper, {}};
    if (const MeasuredCell* cell = found.table(paper.reschedule, paper.robots)) {
      line.measured = *cell;
      line.success = success_standing(*cell, paper.success);
      line.makespan =
          cost_standing(cell->mean_makespan_s, cell->makespan_error_s, paper.makespan_s, kMakespanShare);
      line.flowtime =
          cost_standing(cell->mean_flowtime_s, cell->flowtime_error_s, paper.flowtime_s, kFlowtimeShare);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Claim> check_claims(const std::vector<MeasuredCell>& measured) {
  std::vector<MeasuredCell> enough;
  std::copy_if(measured.begin(), measured.end(), std::back_inserter(enough), [](const MeasuredCell& cell) {
    return cell.instances.value_or(cell.runs) >= kFewestInstances;
  });
  const Cells cells(enough);
  return {over_80_percent(cells),     none_without(cells),
          rises_with_interval(cells), infinity_is_worst(cells),
          falls_at_once(cells),       solves_where_random_fails(cells),
          is_faster(cells),           flowtime_is_better(cells),
          makespan_is_worse(cells),   longest_first_for_makespan(cells)};
}

}  // namespace sipplab::bench
