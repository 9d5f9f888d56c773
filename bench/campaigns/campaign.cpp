#include "bench/campaigns/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "bench/campaigns/counts.hpp"
#include "bench/campaigns/engine_log.hpp"
#include "bench/campaigns/target_program.hpp"
#include "bench/interrupt.hpp"
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
/// Part of a budget of time that is left for making findings smaller.
constexpr double kReduceShare = 0.1;
/// Seconds that one reduction gets at most: thousands of judgements at a few milliseconds, or some that hang;
/// and what it needs to come to anything.
constexpr double kReduceLimitS = 120;
constexpr double kLeastReduceS = 1;
/// Characters of an input that a log shows.
constexpr std::size_t kMostShown = 2000;

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

/// A finding that is stored, and what is needed to work on.
struct OpenFinding {
  db::StoredFinding stored;
  std::string report;
  const TargetProgram* program = nullptr;
};

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

  /// Runs the engine for its share of the budget, and judges what it found.
  void run(std::optional<double> seconds) {
    run_.budget_executions = options_.executions;
    run_.budget_s = seconds;
    prepare();
    run_engine();
    if (run_.mode == "nightly") minimise_corpus();
    read_log();
    const auto inputs = take_artifacts();
    const bool was_stopped = run_.timeouts > 0;  // by an input that is not slow: the engine ends there
    if (inputs.empty() && !ended_well_ && !was_stopped) run_.status = "broken";
    judge(inputs);
  }

  /// Writes what run() did, and what it found as it was found. A run that the user ended without findings is
  /// none.
  db::Result<std::vector<OpenFinding>> record() {
    if (interrupted_by() != 0 && found_.empty()) return std::vector<OpenFinding>();
    const auto id = SIPPLAB_TRY(db::record_fuzz_run(database_, origin_, run_));
    std::vector<OpenFinding> open;
    for (const auto& [signature, found] : found_) {
      const db::Finding finding = finding_of(run_.target, found.first, found.second);
      const auto stored = SIPPLAB_TRY(db::record_finding(database_, origin_, finding, id, db::utc_now()));
      open.push_back({stored, found.first.report, &program_});
    }
    return open;
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
                                .limit_s = run_.budget_s ? *run_.budget_s + kGraceS : kLongestS,
                                .own_group = true,
                                .give_up = [] { return interrupted_by() != 0; }});
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

  void judge(const std::vector<std::pair<std::string, std::string>>& inputs) {
    for (const auto& [kind, input] : inputs) {
      InputVerdict verdict = program_.judge(input);
      if (verdict.verdict != TargetVerdict::kBreaks) {
        verdict = {TargetVerdict::kBreaks, "flaky", kind, "",
                   "the engine reports a " + kind + ", and alone the input holds"};
      }
      const auto known = found_.find(verdict.signature());
      if (known != found_.end() && known->second.second.size() <= input.size()) continue;
      found_[verdict.signature()] = {verdict, input};
    }
  }

  db::Database& database_;
  const db::RunOrigin& origin_;
  const CampaignOptions& options_;
  fs::path folder_;
  TargetProgram program_;
  db::FuzzRun run_;
  /// The shortest input of each signature.
  std::map<std::string, std::pair<InputVerdict, std::string>> found_;
  bool ended_well_ = false;
};

/// What a log has to hold when the machine is gone: what broke, and where.
void tell_sighting(const OpenFinding& open, const Teller& tell) {
  const db::StoredFinding& stored = open.stored;
  tell(fmt::format("finding {} ({}), {}: {}", stored.id, stored.state, stored.finding.target,
                   stored.finding.message));
  std::istringstream report(open.report);
  for (std::string line; std::getline(report, line);) tell("  | " + line);
}

/// The input as the format of printf(1), in one line.
std::string printf_words(std::string_view input) {
  std::string words;
  for (const char c : input) {
    if (c == '\n') {
      words += "\\n";
    } else if (c == '\\' || c == '%') {
      words += std::string(2, c);
    } else if (c < ' ' || c > '~' || c == '\'') {
      words += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    } else {
      words += c;
    }
  }
  return words;
}

/// The minimal input and its picture, for whoever comes to look, and how it is tried again.
void write_finding(const CampaignOptions& options, const OpenFinding& open, const Teller& tell) {
  const db::StoredFinding& stored = open.stored;
  const fs::path folder = options.work / "findings";
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path file = folder / fmt::format("{}.{}", stored.id, stored.finding.robots ? "case" : "input");
  const bool is_written = !write_file(file.string(), stored.finding.minimal);
  tell(fmt::format("finding {}: {} bytes, of {}{}", stored.id, stored.finding.minimal.size(),
                   stored.finding.input.size(), is_written ? ", in " + file.string() : std::string()));
  const std::string words = printf_words(stored.finding.minimal);
  tell(words.size() > kMostShown ? fmt::format("  again: scripts/fuzz --reproduce {}", stored.id)
                                 : fmt::format("  again: printf '{}' >input && {} --judge input", words,
                                               open.program->replayer().string()));
  const auto picture = draw_finding(stored.finding);
  const fs::path drawn = folder / fmt::format("{}.svg", stored.id);
  if (picture && !write_file(drawn.string(), *picture)) tell(fmt::format("  {}", drawn.string()));
}

/// Says what a target did; whether it did not run as it should.
bool tell_run(const TargetRun& run, const Teller& tell) {
  const db::FuzzRun& row = run.row();
  const double wall_time_s = static_cast<double>(row.wall_time_ns) / 1e9;
  tell(fmt::format("{}: {}, {} executions in {:.1f} s, {:.0f} a second, {} edges, {} inputs kept", row.target,
                   row.status, row.executions, wall_time_s,
                   wall_time_s > 0 ? static_cast<double>(row.executions) / wall_time_s : 0, row.edges,
                   row.corpus_files));
  const bool is_broken = row.status == "broken" && interrupted_by() == 0;
  if (is_broken) tell(fmt::format("  it did not run as it should; what it said: {}", run.log().string()));
  return is_broken;
}

/// Makes findings smaller, each for its share of what is left of the time, and writes them.
db::Result<db::Done> finish(db::Database& database, const CampaignOptions& options,
                            std::vector<OpenFinding>& open, const Clock::time_point& deadline,
                            const Teller& tell) {
  for (std::size_t i = 0; i < open.size(); ++i) {
    db::StoredFinding& stored = open[i].stored;
    const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
    const double share_s = std::min(left_s / static_cast<double>(open.size() - i), kReduceLimitS);
    const bool is_reduced = stored.finding.minimal != stored.finding.input;  // when it was found before
    const bool is_worth_it = !is_reduced && stored.finding.kind != "flaky" && interrupted_by() == 0;
    if (is_worth_it && share_s >= kLeastReduceS) {
      const db::Finding smaller = reduced(*open[i].program, stored.finding, share_s, tell);
      auto kept = db::record_minimal(database, stored.id, smaller);
      if (!kept) return Unexpected{kept.error()};
      stored = std::move(*kept);
    } else if (is_worth_it) {
      tell(fmt::format("finding {}: no time is left to make it smaller", stored.id));
    }
    write_finding(options, open[i], tell);
  }
  return db::Done{};
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
                                        const CampaignOptions& options, const Teller& tell) {
  CampaignResult result;
  result.campaign = db::new_uuid();
  std::deque<TargetRun> runs;  // findings point to their programs
  for (const std::string& target : options.targets.empty() ? targets_of(options) : options.targets) {
    runs.emplace_back(database, origin, options, result.campaign, target);
    if (!options.skip_known || !SIPPLAB_TRY(runs.back().is_known())) continue;
    result.skipped.push_back(target);
    runs.pop_back();
  }
  // Processes of one target in turn, or one process of several targets at a time.
  const std::size_t most = options.mode == "nightly" ? 1 : static_cast<std::size_t>(options.workers);
  const std::size_t at_a_time = std::max<std::size_t>(1, std::min(most, runs.size()));
  const std::size_t turns = (runs.size() + at_a_time - 1) / at_a_time;
  std::optional<double> share;
  if (options.seconds)
    share = *options.seconds * (1 - kReduceShare) / static_cast<double>(std::max<std::size_t>(1, turns));
  const Clock::time_point deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(options.seconds.value_or(kLongestS)));

  std::vector<OpenFinding> open;
  std::optional<db::Error> error;
  std::mutex one_at_a_time;  // for the history, and lines for people
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = 0; interrupted_by() == 0 && (i = next++) < runs.size();) {
      runs[i].run(share);
      const std::lock_guard lock(one_at_a_time);
      if (error) return;
      const auto found = runs[i].record();
      if (!found) {
        error = found.error();
        return;
      }
      result.broken = tell_run(runs[i], tell) || result.broken;
      for (const OpenFinding& finding : *found) tell_sighting(finding, tell);
      open.insert(open.end(), found->begin(), found->end());
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < at_a_time; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (error) return Unexpected{*error};
  SIPPLAB_TRY(finish(database, options, open, deadline, tell));
  for (const OpenFinding& finding : open) result.findings.push_back(finding.stored);
  return result;
}

}  // namespace sipplab::bench
