#include "bench/sweep/command_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/interrupt.hpp"
#include "bench/program.hpp"
#include "bench/sweep/run_instance.hpp"
#include "planner/core/try.hpp"
#include "planner/io/solution_io.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "planner/io/write_instance.hpp"
#include "planner/validator/validator.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "cmd:";
/// Seconds beyond the limit, in which a planner that keeps it starts, reads and writes.
constexpr double kGraceS = 1;
/// MiB that the planner may write into one file, its log included.
constexpr std::uint64_t kFileLimitMib = 256;
/// Of a program's last words.
constexpr std::size_t kMostWords = 200;
/// A shell adds this to the signal that ended its command.
constexpr int kShellSignalBase = 128;
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
                                  {"out", "solution"},
                                  {"robots", ""},
                                  {"seed", ""},
                                  {"time_limit", ""}};
constexpr std::string_view kLog = "log";

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

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

double limit_of(const PlannerOptions& options) {
  return std::isinf(options.time_limit_s) ? kDefaultCommandLimitS : options.time_limit_s;
}

/// The command for /bin/sh, limits before it.
std::string shell_line(const CommandPlannerSpec& spec, const fs::path& folder, const Instance& instance,
                       const PlannerOptions& options) {
  constexpr std::uint64_t kKibPerMib = 1024;
  constexpr std::uint64_t kBlocksPerMib = 2048;  // of 512 bytes
  const std::string command =
      with_placeholders(spec.command, [&](std::string_view name) -> std::optional<std::string> {
        if (name == "robots") return std::to_string(instance.agents.size());
        if (name == "seed") return std::to_string(options.seed);
        if (name == "time_limit") return format_real(limit_of(options));
        for (const Placeholder& placeholder : kFiles) {
          if (placeholder.name == name) return shell_quoted((folder / placeholder.file).string());
        }
        return std::nullopt;
      });
  return fmt::format("ulimit -c 0 && ulimit -f {} && ulimit -v {} || exit 126\n{}",
                     kFileLimitMib * kBlocksPerMib, spec.memory_limit_mib * kKibPerMib, command);
}

/// Whether a word means itself to the shell and may name a file by its path.
bool is_plain_path(std::string_view word) {
  return word.find_first_of("/.") != std::string_view::npos &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 ||
                  std::string_view("/._-+@%,:").find(static_cast<char>(c)) != std::string_view::npos;
         });
}

/// The program's file name; of a script that an interpreter is to run, the script's.
std::string name_of(const std::string& command) {
  std::istringstream words(command);
  std::string program;
  std::string script;
  words >> program >> script;
  std::error_code ignored;
  const bool is_script = is_plain_path(script) && fs::is_regular_file(script, ignored);
  return fs::path(is_script ? script : program).filename().string();
}

/// The command with absolute paths for words that name files from here, such as ./planner or script.py:
/// it runs in a folder of its own.
std::string with_absolute_paths(const std::string& command) {
  std::string absolute;
  std::string_view rest = command;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(" \t\n"), rest.size());
    const std::string_view word = rest.substr(0, end);
    std::error_code ignored;
    const fs::path path(word);
    const bool is_file = is_plain_path(word) && path.is_relative() && fs::is_regular_file(path, ignored);
    absolute +=
        is_file ? shell_quoted(fs::absolute(path, ignored).lexically_normal().string()) : std::string(word);
    if (end < rest.size()) absolute += rest[end];
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return absolute;
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
  };
  for (const auto& [name, text] : files) {
    if (const auto error = write_file((folder / name).string(), text)) return error->message();
  }
  return "";
}

/// {out}, or the one new file where the planner has its own idea of a name.
std::optional<fs::path> solution_file(const fs::path& folder) {
  std::error_code ignored;
  const fs::path asked = folder / "solution";
  if (fs::is_regular_file(asked, ignored)) return asked;
  std::optional<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name == kLog || std::any_of(std::begin(kFiles), std::end(kFiles),
                                                  [&](const Placeholder& file) { return file.file == name; });
    if (ours || !entry.is_regular_file(ignored)) continue;
    if (found) return std::nullopt;  // which of them?
    found = entry.path();
  }
  return found;
}

/// The last line that the program wrote, for people.
std::string last_words(const fs::path& log) {
  const auto text = read_file(log.string());
  if (!text) return "";
  const std::string_view rest = trimmed(*text);
  const std::size_t line = rest.rfind('\n') == std::string_view::npos ? 0 : rest.rfind('\n') + 1;
  const std::string_view words = rest.substr(line).substr(0, kMostWords);
  return words.empty() ? "" : ": " + in_quotes(words);
}

/// That ended the program, as far as the shell tells; 0 for none.
int signal_of(const ProgramRun& run) {
  if (run.signal != 0) return run.signal;
  const int signal = run.exit_code - kShellSignalBase;
  return signal > 0 && signal <= kLastSignal ? signal : 0;
}

std::string ending(const ProgramRun& run) {
  if (const int signal = signal_of(run); signal > 0)
    return fmt::format("ended by signal {} ({})", signal, strsignal(signal));
  return fmt::format("ended with exit code {}", run.exit_code);
}

/// The row for a solution that was found; `path` as its messages name it.
void judge(const Instance& instance, const MotionRules& rules, const fs::path& path, double rounding,
           db::ResultRow& row) {
  constexpr auto kReject = [](db::ResultRow& rejected, std::string why) {
    rejected.status = db::ResultStatus::kInvalid;
    rejected.valid = false;
    rejected.message = std::move(why);
  };
  const Input<std::string> text = read_file(path.string());
  if (!text) return kReject(row, text.error().message());
  const Input<SolutionDocument> document = parse_solution(*text, path.filename().string(), instance);
  if (!document) return kReject(row, document.error().message());
  row.tries = document->tries;
  row.expansions = document->expansions;
  row.generations = document->generations;
  if (document->status != "solved") {
    row.status = document->status == "limit" ? db::ResultStatus::kLimit : db::ResultStatus::kFailed;
    if (document->status == "limit") row.limit = "time";
    return;
  }
  row.status = db::ResultStatus::kSolved;
  add_solution(document->solution, row);
  add_verdict(instance, document->solution, {0, {}, rules}, row, rounding);
}

}  // namespace

Expected<CommandPlannerSpec, std::string> parse_command_planner(const std::string& text,
                                                                const std::string& name) {
  CommandPlannerSpec spec;
  if (text.substr(0, kPrefix.size()) == kPrefix)
    spec.command = std::string(trimmed(text.substr(kPrefix.size())));
  if (spec.command.empty()) {
    return Unexpected{in_quotes(text) +
                      ", expected cmd:COMMAND, such as 'cmd:planner {task} {map} {config} {out}'"};
  }
  bool reads = false;
  with_placeholders(spec.command, [&](std::string_view placeholder) -> std::optional<std::string> {
    reads = reads || placeholder == "task" || placeholder == "instance" || placeholder == "scen";
    return std::nullopt;
  });
  if (!reads) {
    return Unexpected{in_quotes(text) +
                      " is given no robots, expected {task}, {instance} or {scen} in it; there are " +
                      placeholder_words()};
  }
  const std::string program = spec.command.substr(0, spec.command.find_first_of(" \t"));
  std::error_code ignored;
  if (program.find('/') != std::string::npos && is_plain_path(program) && !fs::exists(program, ignored)) {
    return Unexpected{program + ": no such file, expected a program"};
  }
  spec.name = name.empty() ? name_of(spec.command) : name;
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
  const fs::path& folder = folder_.path();
  const fs::path log = folder / kLog;
  db::ResultRow row;
  if (std::string error = write_files(folder, instance, options); !error.empty()) {
    return Unexpected{std::move(error)};
  }
  const ProgramRun run = run_program({"/bin/sh", "-c", shell_line(spec_, folder, instance, options)},
                                     {.log = log,
                                      .limit_s = limit_of(options) + kGraceS,
                                      .folder = folder,
                                      .all_to_log = true,
                                      .own_group = true,
                                      .give_up = [] { return interrupted_by() != 0; }});
  row.planning_time_ns = std::llround(run.wall_time_s * kNanosecondsPerSecond);
  if (run.peak_memory_bytes > 0) row.peak_memory_bytes = run.peak_memory_bytes;
  if (!run.started) return Unexpected{std::string("/bin/sh cannot be started")};
  if (run.timed_out) {
    row.status = db::ResultStatus::kLimit;
    row.limit = "time";
    row.message = fmt::format("killed after {} s", format_real(limit_of(options) + kGraceS));
  } else if (signal_of(run) != 0) {
    row.message = ending(run) + last_words(log);
  } else if (const auto solution = solution_file(folder)) {
    judge(instance, options.rules, *solution, spec_.rounding, row);
  } else {
    row.message = "left no solution, " + ending(run) + last_words(log);
  }
  return row;
}

}  // namespace sipplab::bench
