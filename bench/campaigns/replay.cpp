// Counterexamples again; see replay.hpp.
#include "bench/campaigns/replay.hpp"

#include <fmt/format.h>

#include <system_error>

#include "bench/program.hpp"

namespace sipplab::bench {
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

std::string replay_command(const std::filesystem::path& program, const std::string& room,
                           const std::string& reproduce) {
  return fmt::format("RC_PARAMS=\"{}\" {} {}", reproduce, program.string(), room);
}

ProgramVerdict replay_program(const std::filesystem::path& program, const std::string& room,
                              const std::string& reproduce) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(program, ignored)) return ProgramVerdict::kNotRun;
  const ProgramRun run =
      run_program({program.string(), room},
                  {.environment = {"RC_PARAMS=" + reproduce, "SIPPLAB_PROPERTY_LOG="}, .all_to_log = true});
  constexpr int kCannotExecute = 127;  // as shells have it
  if (!run.started || run.exit_code == kCannotExecute || run.exit_code == kNoSuchProperty) {
    return ProgramVerdict::kNotRun;
  }
  return run.exit_code == 0 ? ProgramVerdict::kHolds : ProgramVerdict::kFails;
}

}  // namespace sipplab::bench
