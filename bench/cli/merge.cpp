// sipplab merge: many histories into one.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "db/database.hpp"
#include "db/merge.hpp"

namespace sipplab::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> files;
  std::optional<std::string> database;
  bool json = false;
};

std::string summary(std::size_t merged, const db::MergeReport& report) {
  const std::string files = merged == 1 ? "1 file" : fmt::format("{} files", merged);
  if (report.added.empty()) return files + ": nothing new\n";
  std::int64_t others = 0;
  for (const auto& [table, rows] : report.added) {
    if (table != "run" && table != "cell" && table != "result") others += rows;
  }
  return fmt::format("{}: {} runs, {} cells, {} results and {} other rows new\n", files,
                     report.rows_of("run"), report.rows_of("cell"), report.rows_of("result"), others);
}

int run_merge(const MergeArguments& arguments) {
  // Before the history is opened, which makes a missing one.
  std::error_code error;
  for (const std::string& file : arguments.files) {
    if (!std::filesystem::exists(file, error)) {
      return fail(file + ": no such file, expected a history; nothing is merged");
    }
  }
  if (!std::filesystem::exists(db::database_path(arguments.database), error)) {
    std::vector<db::Error> refused;
    for (const std::string& file : arguments.files) {
      const auto source = db::Database::open_read_only(file);
      if (source) {
        refused.clear();
        break;
      }
      refused.push_back(source.error());
    }
    int code = kSuccess;
    for (const db::Error& reason : refused) code = fail(reason);
    if (code != kSuccess) return code;
  }
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.database));
  const std::vector<std::filesystem::path> files(arguments.files.begin(), arguments.files.end());
  const auto report = SIPPLAB_TRY_OR(fail, db::merge_into(database, files));
  int code = kSuccess;
  for (const db::Error& reason : report.refused) code = fail(reason);
  const std::size_t merged = files.size() - report.refused.size();
  if (arguments.json) {
    nlohmann::ordered_json added = nlohmann::ordered_json::object();
    for (const auto& [table, rows] : report.added) added[table] = rows;
    print_json({{"database", database.path().string()}, {"files", merged}, {"added", added}});
  } else if (merged > 0) {
    print(summary(merged, report));
  }
  return code;
}

}  // namespace

Command add_merge_command(CLI::App& program) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command =
      program.add_subcommand("merge", "merge other histories into this one; repeating it changes nothing");
  command->add_option("files", arguments->files, "histories to read")->required()->type_name("FILE");
  add_database_flag(*command, arguments->database);
  command->add_flag("--json", arguments->json, "print one JSON document");
  command->footer(
      "A file is merged completely or not at all; one that cannot be read is named, and the others are "
      "merged. Runs are told apart by their UUID; each remembers the file it came from.");
  return {command, [arguments] { return run_merge(*arguments); }};
}

}  // namespace sipplab::cli
