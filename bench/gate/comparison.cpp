#include "bench/gate/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "bench/judge/case_words.hpp"
#include "bench/judge/evidence.hpp"
#include "db/identity.hpp"

namespace sipplab::bench {
namespace {

class Comparison {
 public:
  Comparison(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
             const GateProgress& progress)
      : request_(request), cases_(cases), noise_(noise), progress_(progress), random_(request.seed) {}

  Expected<GateResult, std::string> run() {
    const auto begin = std::chrono::steady_clock::now();
    result_.started_utc = db::utc_now();
    for (const auto step : {&Comparison::exact_tier, &Comparison::first_look, &Comparison::second_look}) {
      const std::string error = (this->*step)();
      if (!error.empty()) return Unexpected{error};
    }
    give_verdict();
    result_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(result_);
  }

 private:
  std::string exact_tier() {
    progress_("planning everything once");
    auto workers = start_pair(request_.builds, cases_, true, random_);
    if (!workers) return workers.error();
    result_.base = workers->base.greeting();
    result_.head = workers->head.greeting();
    auto answers = plan_all(*workers, cases_);
    if (!answers) return answers.error();
    answers_ = std::move(*answers);
    std::vector<std::string> names;
    for (const GateCell& cell : cases_.cells()) names.push_back(cell.name);
    std::vector<db::PairedCell> cells = paired_cells();
    std::vector<db::CaseInfo> swept;
    for (const db::PairedCell& cell : request_.sweeps) {
      cells.push_back(cell);
      swept.push_back(cell.parameters);
    }
    for (std::string& name : case_words(swept)) names.push_back(std::move(name));
    result_.judgement = measured(std::move(cells), std::move(names));
    add_row(kProcessTime, std::nullopt);
    for (std::size_t cell = 0; cell < cases_.cells().size(); ++cell) {
      if (cases_.cells()[cell].timed) add_row(kProcessTime, cell);
    }
    add_row(kProcessMemory, std::nullopt);
    return "";
  }

  std::vector<db::PairedCell> paired_cells() const {
    std::vector<db::PairedCell> cells;
    for (const GateCell& cell : cases_.cells()) {
      db::PairedCell paired;
      paired.parameters = cell.row;
      paired.is_planning = cell.task == GateTask::kPlan;
      paired.same_machine = true;
      for (const std::size_t job : cell.jobs) {
        const db::InstanceInfo& instance = cases_.jobs()[job].row;
        paired.results.push_back(
            {instance.name, instance.content_hash, answers_.base[job], answers_.head[job]});
        paired.results.back().base.position = static_cast<std::int64_t>(paired.results.size()) - 1;
      }
      cells.push_back(std::move(paired));
    }
    return cells;
  }

  void add_row(const Metric& metric, std::optional<std::size_t> cell) {
    Difference row;
    row.metric = &metric;
    row.cell = cell;
    result_.judgement.differences.push_back(std::move(row));
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
      for (std::size_t cell = 0; cell < times->log_ratios.size(); ++cell) {
        if (cases_.cells()[cell].task != GateTask::kPlan) continue;
        all.insert(all.end(), times->log_ratios[cell].begin(), times->log_ratios[cell].end());
      }
      for (Difference* row : paired_rows(result_.judgement)) {
        const std::vector<double>& ratios = row->metric == &kProcessMemory ? times->memory_log_ratios
                                            : row->cell                    ? times->log_ratios[*row->cell]
                                                                           : all;
        if (!ratios.empty()) store(*row, interquartile_mean(ratios));
      }
    }
    return "";
  }

  void note_repetition(const PairTimes& times) {
    if (!times.unrepeatable_job || repetition_noted_) return;
    repetition_noted_ = true;
    const char* again = "planned again: another result";
    const char* once = "repeatable so far";
    const std::size_t cell = cases_.jobs()[*times.unrepeatable_job].cell;
    const std::vector<std::size_t>& jobs = cases_.cells()[cell].jobs;
    const auto place = std::find(jobs.begin(), jobs.end(), *times.unrepeatable_job) - jobs.begin();
    add_repetition(result_.judgement, {cell,
                                       static_cast<std::size_t>(place),
                                       {ChangeKind::kRepetition, times.unrepeatable_head ? once : again,
                                        times.unrepeatable_head ? again : once}});
  }

  std::string first_look() {
    std::vector<bool> wanted;
    for (const GateCell& cell : cases_.cells()) wanted.push_back(cell.timed);
    const std::string error =
        time_pairs(request_.pairs, wanted, "pair",
                   [](Difference& row, double log_ratio) { row.pairs.push_back(log_ratio); });
    if (!error.empty()) return error;
    update_noise(request_, cases_, noise_, result_);
    const std::vector<Difference*> rows = paired_rows(result_.judgement);
    std::map<const Metric*, std::vector<Difference*>> families;
    for (Difference* row : rows) {
      evaluate(*row);
      families[row->metric].push_back(row);
    }
    for (const auto& [metric, family] : families) judge_times(family);
    return "";
  }

  std::string second_look() {
    const double tolerance = std::log1p(request_.tolerance);
    std::vector<bool> wanted(cases_.cells().size(), false);
    std::vector<const Difference*> doubtful;
    for (const Difference* row : paired_rows(result_.judgement)) {
      if (row->pairs.empty() || !needs_second_look(*row, tolerance)) continue;
      doubtful.push_back(row);
      for (std::size_t cell = 0; cell < wanted.size(); ++cell) {
        if (cases_.cells()[cell].timed && row->cell.value_or(cell) == cell) wanted[cell] = true;
      }
    }
    if (!doubtful.empty()) {
      const std::string error = time_pairs(
          request_.fresh_pairs, wanted, "fresh pair", [&doubtful](Difference& row, double log_ratio) {
            if (std::find(doubtful.begin(), doubtful.end(), &row) != doubtful.end()) {
              row.fresh_pairs.push_back(log_ratio);
            }
          });
      if (!error.empty()) return error;
    }
    for (Difference* row : paired_rows(result_.judgement)) {
      if (!row->pairs.empty()) bench::second_look(*row, tolerance);
    }
    return "";
  }

  void give_verdict() {
    JudgeOptions options;
    options.floors = request_.floors;
    options.expects_changes = request_.expects_changes;
    const std::string& program = result_.base.build.binary_hash;
    if (!program.empty() && program == result_.head.build.binary_hash && !request_.treat_as_different) {
      options.times_excuse = "both are the same program: what the clock says is noise";
    }
    judge(result_.judgement, options);
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

/// The history has one word for all verdicts that are not bad. What is faster has a slowdown below zero, and
/// what differs is counted.
std::string_view recorded_name(Verdict verdict) {
  return name(verdict < Verdict::kInconclusive ? Verdict::kEquivalent : verdict);
}

std::vector<double> slowdowns(const std::vector<double>& log_ratios) {
  std::vector<double> values;
  for (const double log_ratio : log_ratios) values.push_back(std::expm1(log_ratio));
  return values;
}

}  // namespace

std::vector<Difference*> paired_rows(Judgement& judgement) {
  std::vector<Difference*> rows;
  for (Difference& row : judgement.differences) {
    if (row.metric->test == Test::kFreshPairs) rows.push_back(&row);
  }
  return rows;
}

Expected<GateResult, std::string> compare_builds(const GateRequest& request, const GateCases& cases,
                                                 const std::vector<db::GateNoise>& noise,
                                                 const GateProgress& progress) {
  return Comparison(request, cases, noise, progress).run();
}

RowNoise calibrated(const Difference& row, const GateCases& cases, const std::vector<db::GateNoise>& noise) {
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

db::GateKind gate_kind(const GateRequest& request) {
  return {machine_info(), request.suite, kGateMethod, request.budget.seconds};
}

void update_noise(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
                  GateResult& result) {
  const std::vector<Difference*> rows = paired_rows(result.judgement);
  for (Difference* row : rows) {
    const bool is_time = row->metric == &kProcessTime;
    const GatePlan plan{request.pairs, request.fresh_pairs, is_time ? rows.size() - 1 : 1};
    const RowNoise before = is_time ? calibrated(*row, cases, noise) : RowNoise();
    if (is_time) result.calibrations = before.comparisons;
    row->noise = standard_error(before.pairs.empty() ? row->pairs : before.pairs, request.pairs);
    row->floor = floor_from(row->noise, request.floors.of(*row->metric));
    // What can be seen is the worse of then and now: the machine may be busier.
    row->detectable = detectable(row->pairs, plan, row->floor);
    if (before.pairs.empty()) continue;
    row->detectable = std::max(row->detectable, detectable(before.pairs, plan, row->floor));
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
  run.build = result.head.build;
  run.base_commit = source_info(result.base.program).commit;
  run.commit = source_info(result.head.program).commit;
  run.seed = request.seed;
  run.pair_seconds = request.budget.seconds;
  run.tolerance = request.tolerance;
  run.injected_slowdown = result.head.injected_slowdown;
  run.wall_time_ns = std::llround(result.wall_s * kNanosecondsPerSecond);
  run.started_utc = result.started_utc;
  const Judgement& judgement = result.judgement;
  run.compared = static_cast<std::int64_t>(judgement.all.compared + judgement.all.tasks);
  run.differing = static_cast<std::int64_t>(judgement.all.differing + judgement.all.other_tasks);
  run.verdict = recorded_name(judgement.all.verdict);
  run.reason = judgement.all.reason;
  for (const Difference& row : judgement.differences) {
    if (row.metric != &kProcessTime) continue;
    db::GateCellRow cell;
    if (row.cell) cell.parameters = cases.cells()[*row.cell].row;
    cell.slowdown = std::expm1(row.effect);
    cell.p_value = row.adjusted_p;
    if (row.confirmation) {
      cell.confirm_slowdown = std::expm1(row.confirmation->effect);
      cell.confirm_p_value = row.confirmation->p_value;
    }
    cell.at_most = finite(row.at_most);
    cell.noise = row.noise;
    cell.effect_floor = row.floor;
    cell.detectable = finite(row.detectable);
    cell.verdict = recorded_name(*row.verdict);
    cell.pairs = slowdowns(row.pairs);
    cell.fresh_pairs = slowdowns(row.fresh_pairs);
    run.cells.push_back(std::move(cell));
  }
  for (const Finding& finding : judgement.findings) {
    if (finding.cell >= cases.cells().size()) continue;  // of a sweep, whose results are in the history
    const GateCell& cell = cases.cells()[finding.cell];
    run.differences.push_back({cell.row, cases.jobs()[cell.jobs[finding.result]].row,
                               std::string(name(finding.what.kind)), finding.what.base, finding.what.head});
  }
  return run;
}

}  // namespace sipplab::bench
