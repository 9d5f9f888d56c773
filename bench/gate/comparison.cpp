#include "bench/gate/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "db/identity.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::bench {
namespace {

/// McNemar's test, where changes are allowed: fewer instances solved than by chance.
constexpr double kSuccessLevel = 0.05;

/// What the calibrations say about one row, as log ratios.
struct RowNoise {
  std::size_t comparisons = 0;
  std::vector<double> pairs;
};

RowNoise calibrated(const GateRow& row, const GateCases& cases, const std::vector<db::GateNoise>& noise) {
  RowNoise found;
  std::optional<db::CaseInfo> parameters;
  if (row.cell) parameters = cases.cells()[*row.cell].row;
  for (const db::GateNoise& of_row : noise) {
    if (of_row.parameters != parameters) continue;
    for (const std::vector<double>& comparison : of_row.comparisons) {
      ++found.comparisons;
      for (const double slowdown : comparison) found.pairs.push_back(std::log1p(slowdown));
    }
  }
  return found;
}

class Comparison {
 public:
  Comparison(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
             const GateProgress& progress)
      : request_(request), cases_(cases), noise_(noise), progress_(progress), random_(request.seed) {
    for (std::size_t cell = 0; cell < cases.cells().size(); ++cell) {
      if (cases.cells()[cell].timed) add_row(cases.cells()[cell].name, cell);
    }
    add_row("all cells", std::nullopt);
  }

  Expected<GateResult, std::string> run() {
    const auto begin = std::chrono::steady_clock::now();
    result_.started_utc = db::utc_now();
    for (const auto step : {&Comparison::exact_tier, &Comparison::first_look, &Comparison::second_look}) {
      const std::string error = (this->*step)();
      if (!error.empty()) return Unexpected{error};
    }
    judge();
    result_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(result_);
  }

 private:
  void add_row(const std::string& name, std::optional<std::size_t> cell) {
    GateRow row;
    row.name = name;
    row.cell = cell;
    result_.rows.push_back(std::move(row));
  }

  std::string exact_tier() {
    progress_("planning everything once");
    auto workers = start_pair(request_.builds, cases_, true, random_);
    if (!workers) return workers.error();
    result_.base = workers->base.greeting();
    result_.head = workers->head.greeting();
    result_.same_program = !result_.base.build.binary_hash.empty() &&
                           result_.base.build.binary_hash == result_.head.build.binary_hash;
    auto answers = plan_all(*workers, cases_);
    if (!answers) return answers.error();
    answers_ = std::move(*answers);
    result_.compared = cases_.jobs().size();
    for (std::size_t job = 0; job < result_.compared; ++job) {
      const db::ResultRow& base = answers_.base[job];
      const db::ResultRow& head = answers_.head[job];
      if (const auto what = difference(base, head)) result_.differences.push_back({job, *what});
      const bool base_solved = base.status == db::ResultStatus::kSolved;
      const bool head_solved = head.status == db::ResultStatus::kSolved;
      result_.lost += base_solved && !head_solved ? 1U : 0U;
      result_.gained += head_solved && !base_solved ? 1U : 0U;
    }
    result_.differing = differing_jobs(result_.differences);
    return "";
  }

  /// Times `count` pairs and hands the numbers of each to `store(row, log ratio)`.
  template <class Store>
  std::string time_pairs(std::size_t count, const std::vector<bool>& wanted, const char* what, Store store) {
    for (std::size_t number = 0; number < count; ++number) {
      progress_(fmt::format("{} {} of {}", what, number + 1, count));
      auto workers = start_pair(request_.builds, cases_, false, random_);
      if (!workers) return workers.error();
      const auto times = time_pair(*workers, cases_, wanted, answers_, request_.budget, random_);
      if (!times) return times.error();
      note_repetition(*times);
      std::vector<double> all;
      for (const std::vector<double>& ratios : times->log_ratios) {
        all.insert(all.end(), ratios.begin(), ratios.end());
      }
      for (GateRow& row : result_.rows) {
        const std::vector<double>& ratios = row.cell ? times->log_ratios[*row.cell] : all;
        if (!ratios.empty()) store(row, interquartile_mean(ratios));
      }
    }
    return "";
  }

  void note_repetition(const PairTimes& times) {
    if (!times.unrepeatable_job || repetition_noted_) return;
    repetition_noted_ = true;
    const char* again = "planned again: another result";
    const char* once = "repeatable so far";
    result_.differences.push_back({*times.unrepeatable_job,
                                   {DifferenceKind::kRepetition, times.unrepeatable_head ? once : again,
                                    times.unrepeatable_head ? again : once}});
    result_.differing = differing_jobs(result_.differences);
  }

  std::string first_look() {
    std::vector<bool> wanted;
    for (const GateCell& cell : cases_.cells()) wanted.push_back(cell.timed);
    const std::string error = time_pairs(request_.pairs, wanted, "pair", [](GateRow& row, double log_ratio) {
      row.pairs.push_back(log_ratio);
    });
    if (!error.empty()) return error;
    std::vector<std::vector<double>> rows;
    std::vector<double> floors;
    update_noise(request_, cases_, noise_, result_);
    for (const GateRow& row : result_.rows) {
      rows.push_back(row.pairs);
      floors.push_back(row.floor);
    }
    const std::vector<Suspicion> suspicions = suspect(rows, floors, std::log1p(request_.tolerance));
    for (std::size_t i = 0; i < suspicions.size(); ++i) result_.rows[i].suspicion = suspicions[i];
    return "";
  }

  std::string second_look() {
    std::vector<bool> wanted(cases_.cells().size(), false);
    bool any = false;
    for (const GateRow& row : result_.rows) {
      if (!needs_second_look(row)) continue;
      any = true;
      for (std::size_t cell = 0; cell < wanted.size(); ++cell) {
        if (cases_.cells()[cell].timed && row.cell.value_or(cell) == cell) wanted[cell] = true;
      }
    }
    if (!any) return "";
    const std::string error =
        time_pairs(request_.fresh_pairs, wanted, "fresh pair", [](GateRow& row, double log_ratio) {
          if (needs_second_look(row)) row.fresh_pairs.push_back(log_ratio);
        });
    if (!error.empty()) return error;
    for (GateRow& row : result_.rows) {
      if (row.fresh_pairs.empty()) continue;
      row.confirmation =
          confirm(row.suspicion, row.pairs, row.fresh_pairs, row.floor, std::log1p(request_.tolerance));
    }
    return "";
  }

  static bool needs_second_look(const GateRow& row) {
    return row.suspicion.flagged || !row.suspicion.bounded;
  }

  void judge() {
    for (GateRow& row : result_.rows) {
      std::vector<double> all = row.pairs;
      all.insert(all.end(), row.fresh_pairs.begin(), row.fresh_pairs.end());
      row.at_most = upper_bound(all);
      row.verdict = row.confirmation ? row.confirmation->verdict : RowVerdict::kEquivalent;
    }
    result_.verdict = RowVerdict::kEquivalent;
    result_.reason = "no change of behaviour, no slowdown";
    judge_times();
    judge_behaviour();
  }

  void judge_times() {
    const auto worst =
        std::max_element(result_.rows.begin(), result_.rows.end(),
                         [](const GateRow& a, const GateRow& b) { return a.verdict < b.verdict; });
    if (worst->verdict == RowVerdict::kEquivalent) return;
    if (result_.same_program && !request_.treat_as_different && result_.differences.empty()) {
      result_.times_excused = true;
      result_.reason = "both are the same program: what the clock says is noise";
      return;
    }
    result_.verdict = worst->verdict;
    result_.reason = worst->verdict == RowVerdict::kRegressed
                         ? fmt::format("slower by {:.1f} % in {}",
                                       100 * std::expm1(worst->confirmation->effect), worst->name)
                         : fmt::format("too noisy now to rule out a slowdown of {:.1f} % in {}",
                                       100 * request_.tolerance, worst->name);
  }

  void judge_behaviour() {
    const auto grave = std::find_if(result_.differences.begin(), result_.differences.end(),
                                    [](const GateDifference& difference) {
                                      return difference.what.kind == DifferenceKind::kRepetition ||
                                             difference.what.kind == DifferenceKind::kValidity;
                                    });
    if (grave != result_.differences.end()) {
      behaviour_regressed(
          fmt::format("{} differs in {}", cases_.jobs()[grave->job].row.name, name(grave->what.kind)));
      return;
    }
    if (result_.differences.empty()) return;
    if (!request_.allow_changes) {
      behaviour_regressed(fmt::format("{} of {} plannings gave another result, first {}", result_.differing,
                                      result_.compared,
                                      cases_.jobs()[result_.differences.front().job].row.name));
    } else if (result_.lost > result_.gained &&
               db::statistics::mcnemar(result_.lost, result_.gained) <= kSuccessLevel) {
      behaviour_regressed(fmt::format("{} instances lost, {} gained", result_.lost, result_.gained));
    } else if (result_.verdict == RowVerdict::kEquivalent) {
      result_.reason =
          fmt::format("{} plannings gave another result, as allowed; no slowdown", result_.differing);
    }
  }

  void behaviour_regressed(std::string reason) {
    if (result_.verdict == RowVerdict::kRegressed) reason += "; " + result_.reason;
    result_.behaviour_failed = true;
    result_.verdict = RowVerdict::kRegressed;
    result_.reason = std::move(reason);
  }

  const GateRequest& request_;
  const GateCases& cases_;
  const std::vector<db::GateNoise>& noise_;
  const GateProgress& progress_;
  Random random_;
  FirstAnswers answers_;
  bool repetition_noted_ = false;
  GateResult result_;
};

std::optional<double> finite(double log_ratio) {
  if (!std::isfinite(log_ratio)) return std::nullopt;
  return std::expm1(log_ratio);
}

std::vector<double> slowdowns(const std::vector<double>& log_ratios) {
  std::vector<double> values;
  for (const double log_ratio : log_ratios) values.push_back(std::expm1(log_ratio));
  return values;
}

}  // namespace

std::size_t differing_jobs(const std::vector<GateDifference>& differences) {
  std::set<std::size_t> jobs;
  for (const GateDifference& difference : differences) jobs.insert(difference.job);
  return jobs.size();
}

Expected<GateResult, std::string> compare_builds(const GateRequest& request, const GateCases& cases,
                                                 const std::vector<db::GateNoise>& noise,
                                                 const GateProgress& progress) {
  return Comparison(request, cases, noise, progress).run();
}

db::GateKind gate_kind(const GateRequest& request) {
  return {machine_info(), request.suite, kGateMethod, request.budget.seconds};
}

void update_noise(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
                  GateResult& result) {
  const GatePlan plan{request.pairs, request.fresh_pairs, result.rows.size()};
  for (GateRow& row : result.rows) {
    const RowNoise before = calibrated(row, cases, noise);
    result.calibrations = before.comparisons;
    row.noise = standard_error(before.pairs.empty() ? row.pairs : before.pairs, request.pairs);
    row.floor = floor_from(row.noise);
    // What can be seen is the worse of then and now: the machine may be busier.
    row.detectable = detectable(row.pairs, plan, row.floor);
    if (before.pairs.empty()) continue;
    row.detectable = std::max(row.detectable, detectable(before.pairs, plan, row.floor));
  }
}

db::GateRun gate_record(const GateRequest& request, const GateCases& cases, const GateResult& result,
                        bool calibration) {
  constexpr double kNanosecondsPerSecond = 1e9;
  db::GateRun run;
  run.calibration = calibration;
  run.suite = request.suite;
  run.method = kGateMethod;
  run.machine = machine_info();
  run.base_build = result.base.build;
  run.head_build = result.head.build;
  run.base_commit = source_info(result.base.program).commit;
  run.head_commit = source_info(result.head.program).commit;
  run.seed = request.seed;
  run.pair_seconds = request.budget.seconds;
  run.tolerance = request.tolerance;
  run.injected_slowdown = result.head.injected_slowdown;
  run.wall_time_ns = std::llround(result.wall_s * kNanosecondsPerSecond);
  run.started_utc = result.started_utc;
  run.compared = static_cast<std::int64_t>(result.compared);
  run.differing = static_cast<std::int64_t>(result.differing);
  run.verdict = name(result.verdict);
  run.reason = result.reason;
  for (const GateRow& row : result.rows) {
    db::GateCellRow cell;
    if (row.cell) cell.parameters = cases.cells()[*row.cell].row;
    cell.slowdown = std::expm1(row.suspicion.effect);
    cell.p_value = row.suspicion.p_value;
    if (row.confirmation) {
      cell.confirm_slowdown = std::expm1(row.confirmation->effect);
      cell.confirm_p_value = row.confirmation->p_value;
    }
    cell.at_most = finite(row.at_most);
    cell.noise = row.noise;
    cell.effect_floor = row.floor;
    cell.detectable = finite(row.detectable);
    cell.verdict = name(row.verdict);
    cell.pairs = slowdowns(row.pairs);
    cell.fresh_pairs = slowdowns(row.fresh_pairs);
    run.cells.push_back(std::move(cell));
  }
  for (const GateDifference& difference : result.differences) {
    const GateJob& job = cases.jobs()[difference.job];
    run.differences.push_back({cases.cells()[job.cell].row, job.row, std::string(name(difference.what.kind)),
                               difference.what.base, difference.what.head});
  }
  return run;
}

}  // namespace sipplab::bench
