#include "bench/campaigns/target_program.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <sstream>
#include <utility>
#include <vector>

#include "bench/campaigns/replay.hpp"
#include "bench/interrupt.hpp"
#include "bench/program.hpp"
#include "planner/io/case_codec.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/svg.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

/// Seconds. Judging waits ten seconds for an input that hangs; names of functions take some.
constexpr double kJudgeLimitS = 60;
/// Between lines on how far a reduction has come.
constexpr std::chrono::seconds kTellInterval{10};
constexpr unsigned kDrawLimitS = 10;

void set_minimal(db::Finding& finding, const std::string& minimal) {
  finding.minimal = minimal;
  const auto plan_case = decode_case(minimal);
  if (!plan_case) return;
  finding.robots = static_cast<std::int64_t>(plan_case->instance.agents.size());
  finding.cells = static_cast<std::int64_t>(plan_case->instance.map.cell_count());
}

/// Runs `draw` in a child; what it returns comes back through a file.
template <class Draw>
std::optional<std::string> drawn_in_child(const Draw& draw) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return std::nullopt;
  }
  if (child == 0) try {
      alarm(kDrawLimitS);
      const std::string picture = draw();
      for (std::string_view rest = picture; !rest.empty();) {
        const ssize_t written = write(ends[1], rest.data(), rest.size());
        if (written <= 0) _exit(1);
        rest.remove_prefix(static_cast<std::size_t>(written));
      }
      _exit(0);
    } catch (...) {
      _exit(1);  // what follows is the parent's
    }
  close(ends[1]);
  std::string picture;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    picture.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return picture;
}

}  // namespace

std::string bytes_or_none(const fs::path& path) {
  const auto text = read_file(path.string());
  return text ? *text : std::string();
}

TargetProgram::TargetProgram(fs::path programs, std::string target, fs::path scratch)
    : programs_(std::move(programs)), target_(std::move(target)), scratch_(std::move(scratch)) {}

InputVerdict TargetProgram::judge(const std::string& input) const {
  const fs::path file = scratch_ / "judged";
  if (write_file(file.string(), input)) return {};
  const ProgramRun run = run_program({replayer().string(), "--judge", file.string()},
                                     {.log = scratch_ / "judge.log", .limit_s = kJudgeLimitS});
  InputVerdict verdict;
  verdict.cpu_time_s = run.cpu_time_s;
  if (!run.started || run.timed_out) return verdict;
  if (run.exit_code == 0) verdict.verdict = TargetVerdict::kHolds;
  if (run.exit_code != 1) return verdict;
  verdict.verdict = TargetVerdict::kBreaks;
  std::istringstream lines(run.output);
  for (std::string* value : {&verdict.kind, &verdict.claim, &verdict.frames, &verdict.message}) {
    std::getline(lines, *value);
  }
  for (std::string line; std::getline(lines, line);) verdict.report += line + '\n';
  return verdict;
}

std::string TargetProgram::reduce(const std::string& input, double limit_s, const Teller& tell) const {
  const fs::path file = scratch_ / "input";
  const fs::path smaller = scratch_ / "smaller";
  std::error_code ignored;
  fs::remove(smaller, ignored);
  if (write_file(file.string(), input)) return input;
  auto told = std::chrono::steady_clock::now();
  const auto give_up = [&] {
    if (std::chrono::steady_clock::now() - told >= kTellInterval) {
      told = std::chrono::steady_clock::now();
      tell(fmt::format("  {}: {} bytes, of {}", target_, bytes_or_none(smaller).size(), input.size()));
    }
    return interrupted_by() != 0;
  };
  run_program({replayer().string(), "--reduce", file.string(), smaller.string()},
              {.log = scratch_ / "reduce.log", .limit_s = limit_s, .own_group = true, .give_up = give_up});
  return fs::is_regular_file(smaller, ignored) ? bytes_or_none(smaller) : input;
}

db::Finding finding_of(const std::string& target, const InputVerdict& verdict, const std::string& input) {
  db::Finding finding;
  finding.target = target;
  finding.kind = verdict.kind;
  finding.claim = verdict.claim;
  finding.frames = verdict.frames;
  finding.message = verdict.message;
  finding.input = input;
  set_minimal(finding, input);
  return finding;
}

db::Finding reduced(const TargetProgram& program, const db::Finding& finding, double limit_s,
                    const Teller& tell) {
  const std::string minimal = program.reduce(finding.minimal, limit_s, tell);
  db::Finding smaller = finding;
  // Reducing goes by addresses; what counts is what the smallest one is judged to be.
  if (program.judge(minimal).signature() == finding.signature()) set_minimal(smaller, minimal);
  return smaller;
}

std::optional<std::string> draw_finding(const db::Finding& finding) {
  const auto plan_case = decode_case(finding.minimal);
  if (!plan_case || find_error(plan_case->instance)) return std::nullopt;
  SvgOptions options;
  options.title = finding.target;
  options.subtitle = finding.message;
  auto picture = drawn_in_child([&] {
    const CaseVerdict verdict = replay_case(
        *plan_case, [](const Instance& instance, const PlannerOptions& how) { return plan(instance, how); });
    return draw_svg(plan_case->instance, verdict.result.solution, verdict.report, options);
  });
  if (picture) return picture;
  return drawn_in_child([&] { return draw_svg(plan_case->instance, {}, {}, options); });
}

}  // namespace sipplab::bench
