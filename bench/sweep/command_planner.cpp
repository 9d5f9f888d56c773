#include "bench/sweep/command_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/interrupt.hpp"
#include "bench/program.hpp"
#include "bench/sweep/known_planners.hpp"
#include "bench/sweep/run_instance.hpp"
#include "bench/sweep/shell_command.hpp"
#include "planner/core/try.hpp"
#include "planner/io/foreign_instance.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "cmd:";
constexpr std::string_view kShell = "/bin/sh";
/// Seconds beyond the limit, in which a planner that keeps it starts, reads and writes.
constexpr double kGraceS = 1;
/// MiB that the planner may write into one file, its log included.
constexpr std::uint64_t kFileLimitMib = 256;
/// Of a program's last words.
constexpr std::size_t kMostWords = 200;
/// The last signal of Linux; greater exit codes are a program's own.
constexpr int kLastSignal = 64;

/// The files of one instance, and what stands for them in the command.
struct Placeholder {
  std::string_view name;
  std::string_view file;
};
constexpr Placeholder kFiles[] = {{"task", "task.xml"},
                                  {"map", "map.xml"},
                                  {"config", "config.xml"},
                                  {"obstacles", "obstacles.xml"},
                                  {"instance", "instance.xml"},
                                  {"movingai_map", "instance.map"},
                                  {"scen", "instance.scen"},
                                  {"yaml", "instance.yaml"},
                                  {"ccbs_map", "ccbs_map.xml"},
                                  {"ccbs_task", "ccbs_task.xml"},
                                  {"ccbs_config", "ccbs_config.xml"},
                                  {"out", "solution"},
                                  {"stats", "stats"},
                                  {"robots", ""},
                                  {"seed", ""},
                                  {"small_seed", ""},
                                  {"time_limit", ""},
                                  {"whole_time_limit", ""}};
/// Programs that take a C int as seed.
constexpr std::uint64_t kSmallSeeds = std::uint64_t{1} << 31;
constexpr std::string_view kLog = "log";
/// Files whose names begin so hold what the program says of its run, as CSV: names, and a line of values.
constexpr std::string_view kStats = "stats";

std::string placeholder_words() {
  std::string words;
  for (const Placeholder& placeholder : kFiles)
    words += fmt::format("{}{{{}}}", words.empty() ? "" : ", ", placeholder.name);
  return words;
}

/// Calls `replace` with the name of each {placeholder} and puts in what it returns; where
/// that is nothing, the text stays: shells have braces of their own.
template <class Replace>
std::string with_placeholders(std::string_view text, const Replace& replace) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = text.find('{');
    const std::size_t close = open == std::string_view::npos ? open : text.find('}', open);
    if (close == std::string_view::npos) break;
    out += text.substr(0, open);
    const std::optional<std::string> value = replace(text.substr(open + 1, close - open - 1));
    if (value) {
      out += *value;
      text.remove_prefix(close + 1);
    } else {
      out += '{';
      text.remove_prefix(open + 1);
    }
  }
  return out + std::string(text);
}

double limit_of(const PlannerOptions& options) {
  return std::isinf(options.time_limit_s) ? kDefaultCommandLimitS : options.time_limit_s;
}

/// The command for /bin/sh, limits on its files before it.
std::string shell_line(const CommandPlannerSpec& spec, const fs::path& folder, const Instance& instance,
                       const PlannerOptions& options) {
  constexpr std::uint64_t kBlocksPerMib = 2048;  // of 512 bytes
  const std::string command =
      with_placeholders(spec.command, [&](std::string_view name) -> std::optional<std::string> {
        if (name == "robots") return std::to_string(instance.agents.size());
        if (name == "seed") return std::to_string(options.seed);
        if (name == "small_seed") return std::to_string(options.seed % kSmallSeeds);
        if (name == "time_limit") return format_real(limit_of(options));
        if (name == "whole_time_limit") return format_real(std::max(1.0, std::floor(limit_of(options))));
        for (const Placeholder& placeholder : kFiles) {
          if (placeholder.name == name) return shell_quoted((folder / placeholder.file).string());
        }
        return std::nullopt;
      });
  return fmt::format("ulimit -c 0 && ulimit -f {} || exit 126\n{}", kFileLimitMib * kBlocksPerMib, command);
}

/// Empties the folder and writes the instance into it. An error, or nothing.
std::string write_files(const fs::path& folder, const Instance& instance, const PlannerOptions& options) {
  std::error_code ignored;
  for (const fs::directory_entry& old : fs::directory_iterator(folder, ignored))
    fs::remove_all(old.path(), ignored);
  PlannerOptions told = options;
  told.time_limit_s = limit_of(options);
  const std::pair<std::string_view, std::string> files[] = {
      {"task.xml", write_task_xml(instance)},
      {"map.xml", write_map_xml(instance.map)},
      {"config.xml", write_config_xml(told, folder.string() + "/", "solution")},
      {"obstacles.xml", write_obstacles_xml(instance)},
      {"instance.xml", write_instance_xml(instance)},
      {"instance.map", write_movingai_map(instance.map)},
      {"instance.scen", write_movingai_scen(instance, "instance.map")},
      {"instance.yaml", write_lmrp_yaml(instance)},
      {"ccbs_map.xml", write_ccbs_map(instance.map)},
      {"ccbs_task.xml", write_ccbs_task(instance)},
      {"ccbs_config.xml", write_ccbs_config(instance, told)},
  };
  for (const auto& [name, text] : files) {
    if (const auto error = write_file((folder / name).string(), text)) return error->message();
  }
  return "";
}

/// {out}, or the new files where the planner has its own idea of a name.
std::vector<fs::path> solution_files(const fs::path& folder) {
  std::error_code ignored;
  const fs::path asked = folder / "solution";
  if (fs::is_regular_file(asked, ignored)) return {asked};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name == kLog || name.substr(0, kStats.size()) == kStats ||
                      std::any_of(std::begin(kFiles), std::end(kFiles),
                                  [&](const Placeholder& file) { return file.file == name; });
    if (ours || !entry.is_regular_file(ignored)) continue;
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// What the shell or a sanitizer's runtime adds below a program's own words: "Aborted",
/// "/bin/sh: line 2: 71 Aborted ./planner", "==71==ABORTING".
bool is_epitaph(std::string_view line, int signal) {
  if (line.substr(0, 2) == "==" && line.find("==ABORTING") != std::string_view::npos) return true;
  const std::string_view name = signal > 0 ? strsignal(signal) : "";
  if (name.empty()) return false;
  const bool is_of_shell = line.substr(0, kShell.size()) == kShell || line.substr(0, name.size()) == name;
  return is_of_shell && line.find(name) != std::string_view::npos;
}

/// The last line that the program wrote, for people.
std::string last_words(const fs::path& log, int signal) {
  const auto text = read_file(log.string());
  std::string_view rest = text ? trimmed(*text) : std::string_view();
  while (!rest.empty()) {
    const std::size_t line = rest.rfind('\n') == std::string_view::npos ? 0 : rest.rfind('\n') + 1;
    const std::string_view words = trimmed(rest.substr(line));
    if (!is_epitaph(words, signal)) return ": " + in_quotes(words.substr(0, kMostWords));
    rest = trimmed(rest.substr(0, line));
  }
  return "";
}

/// Whether it wrote these words.
bool prints(const fs::path& log, std::string_view words) {
  if (words.empty()) return false;
  const auto text = read_file(log.string());
  return text && text->find(words) != std::string::npos;
}

/// That ended the program, as far as the shell tells; 0 for none.
int signal_of(const ProgramRun& run) {
  if (run.signal != 0) return run.signal;
  const int signal = run.exit_code - kSignalExitBase;
  return signal > 0 && signal <= kLastSignal ? signal : 0;
}

std::string ending(const ProgramRun& run) {
  if (const int signal = signal_of(run); signal > 0)
    return fmt::format("ended by signal {} ({})", signal, strsignal(signal));
  return fmt::format("ended with exit code {}", run.exit_code);
}

/// Nothing, or LaCAM's words for nothing: a program that found no plan says no untruth.
bool gives_up(std::string_view text) {
  LineScanner lines(text);
  std::optional<std::string_view> line;
  while ((line = lines.next()) && *line != "solved=0") {
  }
  return line || trimmed(text).empty();
}

/// Adds the numbers of files with names and, in their last line, values.
void add_stats(const fs::path& folder, SolutionDocument& document) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.substr(0, kStats.size()) != kStats || !entry.is_regular_file(ignored)) continue;
    const Input<std::string> text = read_file(entry.path().string());
    if (text) add_report_table(document, *text);
  }
}

/// The row for a solution that was found; `path` as its messages name it.
void judge(const Instance& instance, const MotionRules& rules, const fs::path& path,
           const CommandPlannerSpec& spec, db::ResultRow& row) {
  constexpr auto kReject = [](db::ResultRow& rejected, std::string why) {
    rejected.status = db::ResultStatus::kInvalid;
    rejected.valid = false;
    rejected.message = std::move(why);
  };
  const Input<std::string> text = read_file(path.string());
  if (!text) return kReject(row, text.error().message());
  if (gives_up(*text)) {
    row.message = path.filename().string() + (trimmed(*text).empty() ? " is empty" : " says solved=0");
    return;
  }
  Input<SolutionDocument> document = parse_solution(*text, path.filename().string(), instance, spec.format);
  if (!document) return kReject(row, document.error().message());
  row.tries = document->tries;
  row.expansions = document->expansions;
  row.generations = document->generations;
  add_stats(path.parent_path(), *document);
  row.reported = document->reported;
  if (document->status != "solved") {
    row.status = document->status == "limit" ? db::ResultStatus::kLimit : db::ResultStatus::kFailed;
    if (document->status == "limit") row.limit = "time";
    return;
  }
  row.status = db::ResultStatus::kSolved;
  if (spec.retime) return judge_retimed(instance, document->solution, rules, row, spec.rounding);
  add_solution(document->solution, row);
  add_verdict(instance, document->solution, {0, {}, rules}, row, spec.rounding);
}

/// The command of a planner of the table; the program is sought along PATH if it has no folder.
Expected<CommandPlannerSpec, std::string> known_command(const KnownPlanner& known, const std::string& program,
                                                        const std::string& name) {
  std::error_code ignored;
  const bool is_path = program.find('/') != std::string::npos || fs::is_regular_file(program, ignored);
  if (program.empty() || (is_path && !fs::is_regular_file(program, ignored))) {
    return Unexpected{program.empty() ? fmt::format("{}:, expected {}:PATH, the path of the program",
                                                    known.name, known.name)
                                      : program + ": no such file, expected a program"};
  }
  const std::string path = is_path ? fs::absolute(program, ignored).lexically_normal().string() : program;
  CommandPlannerSpec spec;
  spec.name = name.empty() ? std::string(known.name) : name;
  spec.format = std::string(known.format);
  spec.no_plan = std::string(known.no_plan);
  spec.command = with_placeholders(known.command, [&](std::string_view placeholder) {
    return placeholder == "program" ? std::optional(shell_quoted(path)) : std::nullopt;
  });
  return spec;
}

}  // namespace

Expected<CommandPlannerSpec, std::string> parse_command_planner(const std::string& text,
                                                                const std::string& name) {
  CommandPlannerSpec spec;
  const std::size_t colon = std::min(text.find(':'), text.size());
  if (const KnownPlanner* const known = find_known_planner(text.substr(0, colon))) {
    return known_command(*known, std::string(trimmed(text.substr(std::min(colon + 1, text.size())))), name);
  }
  if (text.substr(0, kPrefix.size()) == kPrefix)
    spec.command = std::string(trimmed(text.substr(kPrefix.size())));
  if (spec.command.empty()) {
    return Unexpected{in_quotes(text) +
                      ", expected cmd:COMMAND, such as 'cmd:planner {task} {map} {config} {out}', or "
                      "NAME:PATH of a planner "
                      "that `sipplab planners` lists"};
  }
  bool reads = false;
  with_placeholders(spec.command, [&](std::string_view placeholder) -> std::optional<std::string> {
    reads = reads || placeholder == "task" || placeholder == "instance" || placeholder == "scen" ||
            placeholder == "yaml" || placeholder == "ccbs_task";
    return std::nullopt;
  });
  if (!reads) {
    return Unexpected{in_quotes(text) +
                      " is given no robots, expected {task}, {instance} or {scen} in it; there are " +
                      placeholder_words()};
  }
  const std::vector<std::string> words = from_program(spec.command);
  const std::string program = words.empty() ? "" : words[0];
  std::error_code ignored;
  const bool is_from_here = spec.command.find("cd ") == std::string::npos;
  if (is_from_here && program.find('/') != std::string::npos && is_plain_path(program) &&
      !fs::exists(program, ignored)) {
    return Unexpected{program + ": no such file, expected a program"};
  }
  spec.name = name.empty() ? program_name_of(spec.command) : name;
  spec.command = with_absolute_paths(spec.command);
  return spec;
}

Expected<CommandPlanner, std::string> CommandPlanner::make(CommandPlannerSpec spec) {
  auto folder = SIPPLAB_TRY(TemporaryFolder::make());
  return CommandPlanner(std::move(spec), std::move(folder));
}

Expected<db::ResultRow, std::string> CommandPlanner::run(const Instance& instance,
                                                         const PlannerOptions& options) const {
  constexpr double kNanosecondsPerSecond = 1e9;
  constexpr std::uint64_t kBytesPerMib = std::uint64_t{1} << 20;
  const fs::path& folder = folder_.path();
  const fs::path log = folder / kLog;
  db::ResultRow row;
  if (std::string error = write_files(folder, instance, options); !error.empty()) {
    return Unexpected{std::move(error)};
  }
  const ProgramRun run =
      run_program({std::string(kShell), "-c", shell_line(spec_, folder, instance, options)},
                  {.log = log,
                   .limit_s = limit_of(options) + kGraceS,
                   .folder = folder,
                   .all_to_log = true,
                   .own_group = true,
                   .give_up = [] { return interrupted_by() != 0; },
                   .memory_limit_bytes = spec_.memory_limit_mib * kBytesPerMib});
  row.planning_time_ns = std::llround(run.wall_time_s * kNanosecondsPerSecond);
  row.cpu_time_ns = std::llround(run.cpu_time_s * kNanosecondsPerSecond);
  if (run.peak_memory_bytes > 0) row.peak_memory_bytes = run.peak_memory_bytes;
  if (!run.started) return Unexpected{std::string(kShell) + " cannot be started"};
  if (run.timed_out) {
    row.status = db::ResultStatus::kLimit;
    row.limit = "time";
    row.message = fmt::format("killed after {} s", format_real(limit_of(options) + kGraceS));
    return row;
  }
  if (run.memory_seen_bytes > 0) {
    row.status = db::ResultStatus::kLimit;
    row.limit = "memory";
    row.message = fmt::format("killed with {} MiB in memory", run.memory_seen_bytes / kBytesPerMib);
    row.peak_memory_bytes =
        std::max(row.peak_memory_bytes.value_or(0), static_cast<std::int64_t>(run.memory_seen_bytes));
    return row;
  }
  const std::string words = last_words(log, signal_of(run));
  const std::vector<fs::path> files = solution_files(folder);
  if (signal_of(run) != 0) {
    row.message = ending(run) + words;
  } else if (files.empty()) {
    row.message = "left no solution, " + ending(run) + words;
  } else if (prints(log, spec_.no_plan)) {
    const bool used_all = run.wall_time_s >= limit_of(options);
    row.status = used_all ? db::ResultStatus::kLimit : db::ResultStatus::kFailed;
    if (used_all) row.limit = "time";
    row.message = "prints '" + spec_.no_plan + "', " + ending(run);
  } else if (files.size() > 1) {
    row.message = fmt::format("left {} new files, {} and {}{}, expected one, or {{out}}", files.size(),
                              files[0].filename().string(), files[1].filename().string(),
                              files.size() > 2 ? ", ..." : "");
  } else {
    judge(instance, options.rules, files.front(), spec_, row);
    if (row.status == db::ResultStatus::kFailed && !row.message.empty())
      row.message.append(", ").append(ending(run)).append(words);
  }
  return row;
}

}  // namespace sipplab::bench
