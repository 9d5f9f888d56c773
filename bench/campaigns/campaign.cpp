#include "bench/campaigns/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <system_error>
#include <utility>

#include "bench/campaigns/counts.hpp"
#include "bench/campaigns/engine_log.hpp"
#include "bench/campaigns/target_program.hpp"
#include "bench/program.hpp"
#include "bench/sweep/run_info.hpp"
#include "db/identity.hpp"
#include "planner/core/try.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// What an input may cost, as the engine is told; fuzz/replay/ judges by the same.
constexpr int kMaxInputBytes = 4096;
constexpr int kInputTimeoutS = 10;
/// An input that alone takes less than this part of that, in processor time, is not slow.
constexpr int kQuickShare = 5;
constexpr int kMemoryLimitMb = 1024;
/// Seconds that an engine gets to come to its end beyond its budget, the merge of a corpus
/// included; after that it is killed.
constexpr double kGraceS = 120;
/// Without a budget of time a target is given a day.
constexpr double kLongestS = 86'400;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class TargetRun {
 public:
  TargetRun(db::Database& database, const db::RunOrigin& origin, const CampaignOptions& options,
            const std::string& campaign, std::string target)
      : database_(database),
        origin_(origin),
        options_(options),
        folder_(options.work / target),
        program_(options.programs, target, folder_ / "scratch") {
    run_.uuid = db::new_uuid();
    run_.campaign = campaign;
    run_.target = std::move(target);
    run_.mode = options.mode;
    run_.seed = options.seed;
    run_.workers = options.mode == "nightly" ? options.workers : 1;
    run_.target_hash = text_digest(bytes_or_none(program_.fuzzer()));
  }

  db::Result<bool> is_known() { return db::is_fuzzed_clean(database_, run_.target, run_.target_hash); }

  /// Runs the engine for its share of the budget and writes what it did; gives what it found.
  db::Result<std::vector<db::StoredFinding>> run(std::optional<double> seconds) {
    run_.budget_executions = options_.executions;
    run_.budget_s = seconds;
    prepare();
    run_engine();
    if (run_.mode == "nightly") minimise_corpus();
    read_log();
    const auto inputs = take_artifacts();
    const bool was_stopped = run_.timeouts > 0;  // by an input that is not slow: the engine ends there
    if (inputs.empty() && !ended_well_ && !was_stopped) run_.status = "broken";
    const auto id = SIPPLAB_TRY(db::record_fuzz_run(database_, origin_, run_));
    return record_findings(inputs, id);
  }

  const db::FuzzRun& row() const { return run_; }
  fs::path log() const { return folder_ / "log"; }

 private:
  fs::path corpus() const { return folder_ / (run_.mode == "smoke" ? "smoke" : "corpus"); }
  fs::path artifacts() const { return folder_ / "artifacts"; }
  fs::path counts() const { return folder_ / "counts"; }

  void prepare() {
    std::error_code ignored;
    for (const fs::path& old : {artifacts(), folder_ / "scratch", folder_ / "smoke", log(), counts()}) {
      fs::remove_all(old, ignored);
    }
    for (const fs::path& made : {artifacts(), folder_ / "scratch", corpus()})
      fs::create_directories(made, ignored);
  }

  std::vector<std::string> command() const {
    std::vector<std::string> command{
        program_.fuzzer().string(), fmt::format("-max_len={}", kMaxInputBytes),
        fmt::format("-timeout={}", kInputTimeoutS), fmt::format("-rss_limit_mb={}", kMemoryLimitMb),
        fmt::format("-seed={}", run_.seed),
        // The entropic schedule keeps books of each feature of each input: three
        // fifths of the time where an input has hundreds of them.
        "-entropic=0", "-print_final_stats=1", fmt::format("-artifact_prefix={}/", artifacts().string())};
    if (run_.budget_executions) command.push_back(fmt::format("-runs={}", *run_.budget_executions));
    if (run_.budget_s)
      command.push_back(fmt::format("-max_total_time={}", std::max(1, static_cast<int>(*run_.budget_s))));
    if (run_.mode == "nightly") {
      command.push_back(fmt::format("-fork={}", run_.workers));
      for (const char* ignored : {"-ignore_crashes=1", "-ignore_timeouts=1", "-ignore_ooms=1"})
        command.emplace_back(ignored);
    }
    const fs::path dictionary = options_.sources / "dictionaries" / (run_.target + ".dict");
    if (fs::exists(dictionary)) command.push_back("-dict=" + dictionary.string());
    command.push_back(corpus().string());
    for (const char* seeds : {"corpus", "regressions"}) {
      const fs::path folder = options_.sources / seeds / run_.target;
      if (fs::exists(folder)) command.push_back(folder.string());
    }
    return command;
  }

  void run_engine() {
    run_.started_utc = db::utc_now();
    const Clock::time_point begin = Clock::now();
    const ProgramRun engine =
        run_program(command(), {.environment = {std::string(fuzz::kCountsVariable) + "=" + counts().string()},
                                .log = log(),
                                .limit_s = run_.budget_s ? *run_.budget_s + kGraceS : kLongestS});
    run_.wall_time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
    run_.cpu_time_ns = static_cast<std::int64_t>(engine.cpu_time_s * 1e9);
    // In fork mode the engine's log does not tell of its processes.
    run_.peak_memory_bytes = engine.peak_memory_bytes;
    ended_well_ = engine.started && !engine.timed_out && engine.exit_code == 0;
  }

  /// The fewest inputs that reach the same, by the engine's own set cover.
  void minimise_corpus() {
    const fs::path minimal = folder_ / "minimal";
    std::error_code error;
    fs::remove_all(minimal, error);
    fs::create_directories(minimal, error);
    const ProgramRun merge = run_program(
        {program_.fuzzer().string(), "-set_cover_merge=1", fmt::format("-max_len={}", kMaxInputBytes),
         fmt::format("-timeout={}", kInputTimeoutS), minimal.string(), corpus().string(),
         (options_.sources / "corpus" / run_.target).string()},
        {.log = folder_ / "merge.log", .limit_s = kGraceS});
    if (!merge.started || merge.exit_code != 0 || files_in(minimal).empty()) return;
    fs::remove_all(corpus(), error);
    fs::rename(minimal, corpus(), error);
  }

  void read_log() {
    EngineLog log_read = parse_engine_log(bytes_or_none(log()));
    for (const fuzz::Count& count : fuzz::read_counts(counts().string())) {
      run_.counts.push_back({count.kind, count.name, static_cast<std::int64_t>(count.count)});
      // Counted by the target itself: right in fork mode and after a crash as well.
      if (count.name == "inputs") run_.executions = static_cast<std::int64_t>(count.count);
    }
    run_.edges = log_read.last.edges;
    run_.features = log_read.last.features;
    run_.peak_memory_bytes = std::max(run_.peak_memory_bytes, log_read.peak_memory_bytes);
    run_.slowest_input_s = log_read.slowest_input_s;
    run_.snapshots = std::move(log_read.snapshots);
    for (const fs::path& file : files_in(corpus())) {
      std::error_code ignored;
      ++run_.corpus_files;
      run_.corpus_bytes += static_cast<std::int64_t>(fs::file_size(file, ignored));
    }
  }

  /// Whether it was the machine that took the time, busy or asleep, and not the input.
  bool is_quick_alone(const std::string& input) {
    const InputVerdict judged = program_.judge(input);
    return judged.verdict == TargetVerdict::kHolds && judged.cpu_time_s * kQuickShare < kInputTimeoutS;
  }

  /// Inputs by the kind that the engine named them after. Exit codes say nothing: in fork
  /// mode an engine ends with 0 although inputs lie there.
  std::vector<std::pair<std::string, std::string>> take_artifacts() {
    std::vector<std::pair<std::string, std::string>> inputs;
    for (const fs::path& file : files_in(artifacts())) {
      const std::string name = file.filename().string();
      const std::string kind = name.substr(0, name.find('-'));
      std::int64_t* counter = kind == "crash"     ? &run_.crashes
                              : kind == "timeout" ? &run_.timeouts
                              : kind == "oom"     ? &run_.ooms
                              : kind == "leak"    ? &run_.leaks
                                                  : nullptr;
      if (counter == nullptr) continue;  // slow units are in the statistics
      ++*counter;
      std::string input = bytes_or_none(file);
      if (kind == "timeout" && is_quick_alone(input)) continue;
      inputs.emplace_back(kind, std::move(input));
    }
    run_.status = inputs.empty() ? "clean" : "findings";
    return inputs;
  }

  db::Result<std::vector<db::StoredFinding>> record_findings(
      const std::vector<std::pair<std::string, std::string>>& inputs, std::int64_t run_id) {
    // The shortest input of each signature.
    std::map<std::string, std::pair<InputVerdict, std::string>> distinct;
    for (const auto& [kind, input] : inputs) {
      InputVerdict verdict = program_.judge(input);
      if (verdict.verdict != TargetVerdict::kBreaks) {
        verdict = {TargetVerdict::kBreaks, "flaky", kind, "",
                   "the engine reports a " + kind + ", and alone the input holds"};
      }
      const auto known = distinct.find(verdict.signature());
      if (known != distinct.end() && known->second.second.size() <= input.size()) continue;
      distinct[verdict.signature()] = {verdict, input};
    }
    std::vector<db::StoredFinding> findings;
    for (const auto& [signature, found] : distinct) {
      const db::Finding finding = finding_of(program_, run_.target, found.first, found.second);
      findings.push_back(SIPPLAB_TRY(db::record_finding(database_, origin_, finding, run_id, db::utc_now())));
    }
    return findings;
  }

  db::Database& database_;
  const db::RunOrigin& origin_;
  const CampaignOptions& options_;
  fs::path folder_;
  TargetProgram program_;
  db::FuzzRun run_;
  bool ended_well_ = false;
};

/// The minimal input and its picture, for whoever comes to look.
void write_finding(const CampaignOptions& options, const db::StoredFinding& stored,
                   const std::function<void(const std::string&)>& tell) {
  const fs::path folder = options.work / "findings";
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path file = folder / fmt::format("{}.{}", stored.id, stored.finding.robots ? "case" : "input");
  tell(fmt::format("finding {} ({}), {}: {}", stored.id, stored.state, stored.finding.target,
                   stored.finding.message));
  if (!write_file(file.string(), stored.finding.minimal)) tell(fmt::format("  {}", file.string()));
  const auto picture = draw_finding(stored.finding);
  const fs::path drawn = folder / fmt::format("{}.svg", stored.id);
  if (picture && !write_file(drawn.string(), *picture)) tell(fmt::format("  {}", drawn.string()));
}

}  // namespace

std::vector<std::string> targets_of(const CampaignOptions& options) {
  std::vector<std::string> targets;
  std::error_code error;
  for (fs::directory_iterator entry(options.sources / "corpus", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (fs::exists(options.programs / name) && fs::exists(options.programs / ("replay_" + name))) {
      targets.push_back(name);
    }
  }
  std::sort(targets.begin(), targets.end());
  return targets;
}

db::Result<CampaignResult> run_campaign(db::Database& database, const db::RunOrigin& origin,
                                        const CampaignOptions& options,
                                        const std::function<void(const std::string&)>& tell) {
  CampaignResult result;
  result.campaign = db::new_uuid();
  std::vector<TargetRun> runs;
  for (const std::string& target : options.targets.empty() ? targets_of(options) : options.targets) {
    TargetRun run(database, origin, options, result.campaign, target);
    if (options.skip_known) {
      const auto known = SIPPLAB_TRY(run.is_known());
      if (known) {
        result.skipped.push_back(target);
        continue;
      }
    }
    runs.push_back(std::move(run));
  }
  for (TargetRun& run : runs) {
    std::optional<double> share;
    if (options.seconds) share = *options.seconds / static_cast<double>(runs.size());
    const auto findings = SIPPLAB_TRY(run.run(share));
    const db::FuzzRun& row = run.row();
    const double wall_time_s = static_cast<double>(row.wall_time_ns) / 1e9;
    tell(fmt::format("{}: {}, {} executions in {:.1f} s, {:.0f} a second, {} edges, {} inputs kept",
                     row.target, row.status, row.executions, wall_time_s,
                     wall_time_s > 0 ? static_cast<double>(row.executions) / wall_time_s : 0, row.edges,
                     row.corpus_files));
    if (row.status == "broken") {
      result.broken = true;
      tell(fmt::format("  it did not run as it should; what it said: {}", run.log().string()));
    }
    for (const db::StoredFinding& stored : findings) write_finding(options, stored, tell);
    result.findings.insert(result.findings.end(), findings.begin(), findings.end());
  }
  return result;
}

}  // namespace sipplab::bench
