// Counterexamples again; see replay.hpp.
#include "bench/campaigns/replay.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string_view>
#include <system_error>
#include <vector>

namespace sipplab::bench {
namespace {

/// The environment of this process with RC_PARAMS set and without a property log.
std::vector<std::string> replay_environment(const std::string& reproduce) {
  std::vector<std::string> environment{"RC_PARAMS=" + reproduce};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (text.rfind("RC_PARAMS=", 0) == 0 || text.rfind("SIPPLAB_PROPERTY_LOG=", 0) == 0) continue;
    environment.emplace_back(text);
  }
  return environment;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

CaseVerdict replay_case(const PlanCase& plan_case, const Planner& planner) {
  CaseVerdict verdict;
  if (const auto error = find_error(plan_case.instance)) {
    verdict.text = "the case breaks a rule: " + error->what + ", expected " + error->expected;
    return verdict;
  }
  verdict.result = planner(plan_case.instance, plan_case.options);
  if (verdict.result.status != PlanStatus::kSolved) {
    verdict.holds = true;
    verdict.text = fmt::format("no plan ({}), so there is none to be wrong", name(verdict.result.status));
    return verdict;
  }
  ValidationOptions options;
  options.ssi_s = plan_case.options.ssi_s;
  options.rules = plan_case.options.rules;
  options.order = verdict.result.order();
  verdict.report = validate(plan_case.instance, verdict.result.solution, options);
  verdict.holds = verdict.report.valid();
  verdict.text =
      verdict.holds ? "the plan is valid" : "invalid: " + verdict.report.violations.front().message;
  return verdict;
}

std::string replay_command(const std::filesystem::path& program, const std::string& reproduce) {
  return fmt::format("RC_PARAMS=\"{}\" {}", reproduce, program.string());
}

ProgramVerdict replay_program(const std::filesystem::path& program, const std::string& reproduce) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(program, ignored)) return ProgramVerdict::kNotRun;
  std::vector<std::string> arguments{program.string()};
  std::vector<std::string> environment = replay_environment(reproduce);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0].c_str(), &actions, nullptr,
                                 pointers_to(arguments).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failed != 0 || waitpid(child, &status, 0) != child) return ProgramVerdict::kNotRun;
  constexpr int kCannotExecute = 127;  // as shells have it
  if (WIFEXITED(status) &&
      (WEXITSTATUS(status) == kCannotExecute || WEXITSTATUS(status) == kNoSuchProperty)) {
    return ProgramVerdict::kNotRun;
  }
  const bool holds = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return holds ? ProgramVerdict::kHolds : ProgramVerdict::kFails;
}

}  // namespace sipplab::bench
