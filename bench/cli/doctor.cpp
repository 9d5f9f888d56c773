// sipplab doctor: whether the history is sound, and what to do if it is not.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "db/database.hpp"
#include "db/doctor.hpp"
#include "db/json_text.hpp"

namespace sipplab::cli {
namespace {

struct DoctorArguments {
  db::DoctorOptions options;
  std::optional<std::string> database;
  bool json = false;
};

std::string json_text(const db::DoctorReport& report, const std::string& file) {
  nlohmann::ordered_json document;
  document["database"] = file;
  document["sound"] = report.sound();
  document["checks"] = report.checks;
  document["findings"] = nlohmann::ordered_json::array();
  for (const db::DoctorFinding& finding : report.findings) {
    document["findings"].push_back({{"check", finding.check},
                                    {"what", finding.what},
                                    {"advice", finding.advice},
                                    {"fixable", finding.fixable},
                                    {"fixed", finding.fixed}});
  }
  return db::json_text(document);
}

std::string plain_text(const db::DoctorReport& report, const std::string& file) {
  std::string text;
  for (const std::string& check : report.checks) {
    std::string lines;
    for (const db::DoctorFinding& finding : report.findings) {
      if (finding.check != check) continue;
      lines += fmt::format("  {}\n    {}\n", finding.what, finding.fixed ? "fixed" : "-> " + finding.advice);
    }
    text += fmt::format("{:<16} {}\n{}", check, lines.empty() ? "ok" : "", lines);
  }
  return text + fmt::format("{}: {}\n", file, report.sound() ? "sound" : "not sound");
}

int run_doctor(const DoctorArguments& arguments) {
  const std::filesystem::path path = db::database_path(arguments.database);
  auto database = db::Database::open_read_only(path);
  if (database && arguments.options.fix) database = db::Database::open(path);
  if (!database) return fail(database.error());
  const db::DoctorReport report = db::examine(*database, arguments.options);
  print(arguments.json ? json_text(report, path.string()) : plain_text(report, path.string()));
  return report.sound() ? kSuccess : kNegativeVerdict;
}

}  // namespace

Command add_doctor_command(CLI::App& program) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* command = program.add_subcommand("doctor", "check the history and advise what to do");
  command->add_flag("--quick", arguments->options.quick, "skip checks that read every result");
  command->add_flag("--fix", arguments->options.fix, "fix what can be fixed without losing anything");
  add_database_flag(*command, arguments->database);
  command->add_flag("--json", arguments->json, "print one JSON document");
  command->footer("Exit codes: 0 sound, 1 findings.");
  return {command, [arguments] { return run_doctor(*arguments); }};
}

}  // namespace sipplab::cli
