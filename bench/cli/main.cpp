// sipplab with everything: planner, benchmarks and history.
#include <filesystem>
#include <vector>

#include "bench/cli/program.hpp"
#include "db/database.hpp"

namespace sipplab::cli {
namespace {

std::vector<Command> add_laboratory_commands(CLI::App& program, const Invocation& invocation) {
  return {
      add_bench_command(program, invocation),
      add_planners_command(program),
      add_runs_command(program),
      add_show_command(program),
      add_sql_command(program),
      add_property_command(program, invocation),
      add_fuzz_command(program),
      add_findings_command(program, invocation),
      add_compare_command(program),
      add_gate_command(program),
      add_trend_command(program),
      add_merge_command(program),
      add_task_command(program),
      add_doctor_command(program),
      add_import_command(program),
      add_report_command(program),
      add_plot_command(program),
      add_reproduce_command(program, invocation),
  };
}

std::filesystem::path history() { return db::database_path({}); }

}  // namespace
}  // namespace sipplab::cli

int main(int argc, char** argv) {
  return sipplab::cli::run_program(argc, argv,
                                   {sipplab::cli::add_laboratory_commands, sipplab::cli::history});
}
