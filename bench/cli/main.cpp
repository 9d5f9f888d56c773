// sipplab with everything: planner, benchmarks and history.
#include <filesystem>

#include "bench/cli/program.hpp"
#include "db/database.hpp"

namespace sipplab::cli {
namespace {

constexpr NamedCommand kLaboratoryCommands[] = {
    {"bench", add_bench_command},
    {"planners", add_plainly<add_planners_command>},
    {"runs", add_plainly<add_runs_command>},
    {"show", add_plainly<add_show_command>},
    {"sql", add_plainly<add_sql_command>},
    {"property", add_property_command},
    {"fuzz", add_plainly<add_fuzz_command>},
    {"findings", add_findings_command},
    {"compare", add_plainly<add_compare_command>},
    {"gate", add_plainly<add_gate_command>},
    {"trend", add_plainly<add_trend_command>},
    {"merge", add_plainly<add_merge_command>},
    {"task", add_plainly<add_task_command>},
    {"doctor", add_plainly<add_doctor_command>},
    {"import", add_plainly<add_import_command>},
    {"report", add_plainly<add_report_command>},
    {"plot", add_plainly<add_plot_command>},
    {"reproduce", add_reproduce_command},
};

std::filesystem::path history() { return db::database_path({}); }

}  // namespace
}  // namespace sipplab::cli

int main(int argc, char** argv) {
  return sipplab::cli::run_program(argc, argv, {sipplab::cli::kLaboratoryCommands, sipplab::cli::history});
}
