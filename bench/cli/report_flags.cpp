#include "bench/cli/report_flags.hpp"

#include <fmt/format.h>

#include "bench/cli/console.hpp"
#include "planner/core/number.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

/// Unexpected other plans fail, even if it is unclear whether they are worse.
int exit_code(const bench::Judged& all, bool expects_changes) {
  if (all.verdict == bench::Verdict::kRegressed) return kNegativeVerdict;
  if (all.other_plans + all.other_tasks > 0 && !expects_changes) return kChangedPlans;
  return all.verdict == bench::Verdict::kInconclusive ? kInconclusive : kSuccess;
}

/// "counts=0.5": a kind and per cent.
struct StatedFloor {
  const db::Threshold* threshold = nullptr;
  double share = 0;
};

std::optional<StatedFloor> parse_floor(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return std::nullopt;
  const auto per_cent = parse_number<double>(text.substr(equals + 1));
  if (!per_cent || !(*per_cent >= 0 && *per_cent <= 100)) return std::nullopt;
  for (const db::Threshold& threshold : db::kThresholds) {
    if (threshold.name == text.substr(0, equals)) return StatedFloor{&threshold, *per_cent / 100};
  }
  return std::nullopt;
}

/// "success=0,quality=0.2,...": what holds without the flag.
std::string usual_floors() {
  std::string text;
  for (const db::Threshold& threshold : db::kThresholds) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", threshold.name, 100 * threshold.floor);
  }
  return text;
}

}  // namespace

void add_report_flags(CLI::App& command, ReportFlags& flags) {
  command.add_option("--format", flags.format, "text, markdown (for a pull request) or json")
      ->check(CLI::IsMember({"text", "markdown", "json"}))
      ->capture_default_str();
  command.add_flag("--json", flags.json, "the same as --format json");
  command.add_option("--floor", flags.floors, "changes up to this many per cent are equivalent")
      ->type_name("KIND=PERCENT")
      ->delimiter(',')
      ->default_str(usual_floors())
      ->check([](const std::string& text) {
        return parse_floor(text) ? std::string() : in_quotes(text) + ", expected one like " + usual_floors();
      });
  command.add_option("--junit", flags.junit, "write JUnit's XML as well")->type_name("FILE");
}

bench::Floors floors_of(const ReportFlags& flags) {
  bench::Floors floors;
  for (const std::string& text : flags.floors) {
    if (const auto stated = parse_floor(text)) floors[stated->threshold->kind] = stated->share;
  }
  return floors;
}

int print_report(bench::Report report, const ReportFlags& flags) {
  report.changes_fail = !flags.expects_changes;
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
  return exit_code(report.judgement.all, flags.expects_changes);
}

}  // namespace sipplab::cli
