#include "bench/cli/report_flags.hpp"

#include "bench/cli/console.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

int exit_code(bench::Verdict verdict) {
  if (verdict == bench::Verdict::kRegressed) return kNegativeVerdict;
  return verdict == bench::Verdict::kInconclusive ? kInconclusive : kSuccess;
}

}  // namespace

void add_report_flags(CLI::App& command, ReportFlags& flags) {
  command.add_option("--format", flags.format, "text, markdown (for a pull request) or json")
      ->check(CLI::IsMember({"text", "markdown", "json"}))
      ->capture_default_str();
  command.add_flag("--json", flags.json, "the same as --format json");
  command.add_option("--junit", flags.junit, "write JUnit's XML as well")->type_name("FILE");
}

int print_report(const bench::Report& report, const ReportFlags& flags) {
  if (flags.wants_json()) {
    print(bench::report_json(report));
  } else {
    print(flags.format == "markdown" ? bench::report_markdown(report) : bench::report_text(report));
  }
  if (flags.junit) {
    if (const auto error = write_file(*flags.junit, bench::report_junit(report))) {
      return fail(error->message());
    }
  }
  return exit_code(report.judgement.all.verdict);
}

}  // namespace sipplab::cli
