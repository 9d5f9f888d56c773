// sipplab findings: what fuzzing found, and whether it still breaks.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaigns/campaign.hpp"
#include "bench/campaigns/target_program.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/present/picture_format.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/temporary_folder.hpp"
#include "db/findings.hpp"
#include "db/identity.hpp"
#include "db/json_text.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct FindingsArguments {
  HistoryFlags history;
  std::string program;  ///< how sipplab was called: replay programs lie below its folder

  bool open = false;
  bool all = false;
  std::optional<std::int64_t> id;
  std::optional<std::string> programs;
  std::optional<std::string> output;
  std::optional<std::string> svg;
};

db::Table table_of(const std::vector<db::StoredFinding>& findings) {
  db::Table table{{"id", "state", "target", "kind", "claim", "where", "same_place", "robots", "cells",
                   "bytes", "times_found", "last_utc"},
                  {}};
  // One cause breaks several targets, and one target by several ways: where it broke is the same.
  std::map<std::string, std::int64_t> first_at;
  const auto optional = [](std::optional<std::int64_t> number) {
    return number ? db::Value{*number} : db::Value{db::Null{}};
  };
  for (const db::StoredFinding& stored : findings) {
    const db::Finding& finding = stored.finding;
    const std::string where = finding.frames.substr(0, finding.frames.find(" < "));
    const auto same = where.empty() ? first_at.end() : first_at.emplace(where, stored.id).first;
    table.rows.push_back({stored.id, stored.state, finding.target, finding.kind, finding.claim, where,
                          optional(where.empty() ? std::nullopt : std::optional(same->second)),
                          optional(finding.robots), optional(finding.cells),
                          static_cast<std::int64_t>(finding.minimal.size()), stored.times_found,
                          stored.last_utc});
  }
  return table;
}

int run_list(const FindingsArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  const auto findings = SIPPLAB_TRY_OR(fail, db::list_findings(database, arguments.open));
  arguments.history.show(table_of(findings));
  return kSuccess;
}

Json json_of(const db::StoredFinding& stored, const db::Table& events) {
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  Json json;
  json["id"] = stored.id;
  json["state"] = stored.state;
  json["target"] = stored.finding.target;
  json["kind"] = stored.finding.kind;
  json["claim"] = stored.finding.claim;
  json["frames"] = stored.finding.frames;
  json["message"] = stored.finding.message;
  json["first_utc"] = stored.first_utc;
  json["last_utc"] = stored.last_utc;
  json["first_commit"] = or_null(stored.first_commit);
  json["last_commit"] = or_null(stored.last_commit);
  json["fixed_commit"] = or_null(stored.fixed_commit);
  json["times_found"] = stored.times_found;
  json["minimal"] = stored.finding.minimal;
  json["events"] = Json::parse(db::format_json(events));
  return json;
}

std::string text_of(const db::StoredFinding& stored, const db::Table& events) {
  const db::Finding& finding = stored.finding;
  std::string text = fmt::format("finding   {}, {}, found {} times\ntarget    {}\nwhat      {}\n", stored.id,
                                 stored.state, stored.times_found, finding.target, finding.message);
  if (!finding.frames.empty()) text += fmt::format("where     {}\n", finding.frames);
  if (stored.fixed_commit) text += fmt::format("not reproduced at {}\n", *stored.fixed_commit);
  text += "\n" + db::format_aligned(events) + "\n";
  text += fmt::format("{} bytes, of {} as it was found:\n\n{}", finding.minimal.size(), finding.input.size(),
                      finding.minimal);
  return text.back() == '\n' ? text : text + '\n';
}

/// An error is one line.
std::optional<std::string> write_files(const FindingsArguments& arguments, const db::Finding& finding) {
  if (arguments.output) {
    if (const auto error = write_file(*arguments.output, finding.minimal)) return error->message();
  }
  if (!arguments.svg) return std::nullopt;
  const auto picture = bench::draw_finding(finding);
  if (!picture) return std::string("this finding is no planning case, expected one to draw");
  if (const auto error = write_file(*arguments.svg, *picture)) return error->message();
  return std::nullopt;
}

int run_show(const FindingsArguments& arguments) {
  if (arguments.svg) {
    if (const auto error = bench::find_plan_picture_error(*arguments.svg)) return bad_usage(*error);
  }
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  const auto stored = SIPPLAB_TRY_OR(fail, db::find_finding(database, *arguments.id));
  const auto events = SIPPLAB_TRY_OR(fail, db::finding_events(database, *arguments.id));
  if (const auto problem = write_files(arguments, stored.finding)) return fail(*problem);
  print(arguments.history.output_format() == db::OutputFormat::kJson ? db::json_text(json_of(stored, events))
                                                                     : text_of(stored, events));
  return kSuccess;
}

/// Where replay programs may be: of the same build, and of the others beside it, those with sanitizers first.
std::vector<fs::path> places_of(const FindingsArguments& arguments) {
  if (arguments.programs) return {*arguments.programs};
  std::error_code ignored;
  const fs::path build = fs::absolute(fs::path(arguments.program), ignored).lexically_normal().parent_path();
  std::vector<fs::path> places{build / "fuzz"};
  for (const char* preset : {"fuzz", "asan-ubsan", "debug", "release"}) {
    places.push_back(build.parent_path() / preset / "fuzz");
  }
  return places;
}

std::vector<std::string> names_of(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const fs::path& path : paths) names.push_back(path.string());
  return names;
}

struct Replayed {
  db::StoredFinding stored;
  std::string verdict;
  std::string report = {};
};

db::Result<Replayed> replay_one(db::Database& database, const db::StoredFinding& stored,
                                const std::vector<fs::path>& places, const fs::path& scratch) {
  const auto programs = std::find_if(places.begin(), places.end(), [&](const fs::path& place) {
    return fs::exists(bench::TargetProgram(place, stored.finding.target, scratch).replayer());
  });
  if (programs == places.end()) {
    return Replayed{stored, fmt::format("not run: no replay_{} in {}", stored.finding.target,
                                        fmt::join(names_of(places), ", "))};
  }
  const bench::TargetProgram program(*programs, stored.finding.target, scratch);
  const bench::InputVerdict verdict = program.judge(stored.finding.minimal);
  if (verdict.verdict == bench::TargetVerdict::kNotJudged) {
    return Replayed{stored, fmt::format("not run: {} did not answer", program.replayer().string())};
  }
  const bool breaks = verdict.verdict == bench::TargetVerdict::kBreaks;
  const auto recorded =
      SIPPLAB_TRY(db::record_replay(database, bench::run_origin(), stored.id, breaks, db::utc_now()));
  if (!breaks) return Replayed{recorded, "holds now"};
  const bool is_same = verdict.signature() == stored.finding.signature();
  return Replayed{recorded, is_same ? "still breaks" : "breaks otherwise: " + verdict.message,
                  verdict.report};
}

int run_replay(const FindingsArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.history.database));
  std::vector<db::StoredFinding> findings;
  if (arguments.id) {
    findings.push_back(SIPPLAB_TRY_OR(fail, db::find_finding(database, *arguments.id)));
  } else {
    findings = SIPPLAB_TRY_OR(fail, db::list_findings(database, false));
  }
  const auto scratch = SIPPLAB_TRY_OR(fail, bench::TemporaryFolder::make());
  db::Table table{{"id", "state", "target", "replay"}, {}};
  int code = kSuccess;
  for (const db::StoredFinding& stored : findings) {
    const auto replayed =
        SIPPLAB_TRY_OR(fail, replay_one(database, stored, places_of(arguments), scratch.path()));
    // What a developer needs for one; of all it would be a flood.
    if (arguments.id && !replayed.report.empty()) diagnose(std::string(trimmed(replayed.report)));
    table.rows.push_back({stored.id, replayed.stored.state, stored.finding.target, replayed.verdict});
    if (replayed.verdict.rfind("not run", 0) == 0) {
      if (code == kSuccess) code = kInconclusive;
    } else if (replayed.stored.state != "fixed") {
      code = kNegativeVerdict;
    }
  }
  arguments.history.show(table);
  return code;
}

}  // namespace

Command add_findings_command(CLI::App& program, const Invocation& invocation) {
  auto arguments = std::make_shared<FindingsArguments>();
  arguments->program = invocation.program;
  CLI::App* findings = program.add_subcommand("findings", "what fuzzing found, and whether it still breaks");
  findings->require_subcommand(1);
  CLI::App* list = arguments->history.add_command(*findings, "list", "all findings");
  list->add_flag("--open", arguments->open, "only those that are not fixed");
  CLI::App* show = arguments->history.add_command(*findings, "show", "one finding, with its smallest input");
  show->add_option("id", arguments->id, "as `sipplab findings list` shows it")->required();
  show->add_option("-o,--output", arguments->output, "write the smallest input there")->type_name("FILE");
  show->add_option("--svg", arguments->svg, "draw the planning case and its plan there, as .svg")
      ->type_name("FILE");
  CLI::App* replay =
      arguments->history.add_command(*findings, "replay",
                                     "run the smallest inputs again; exit code 1 if one still breaks, 0 if "
                                     "all hold, 3 if one was not run");
  CLI::Option* id = replay->add_option("id", arguments->id, "as `sipplab findings list` shows it");
  CLI::Option* all = replay->add_flag("--all", arguments->all, "all findings instead of one")->excludes(id);
  replay
      ->add_option("--programs", arguments->programs,
                   "folder of the replay programs; default: those of this build and of those beside it")
      ->type_name("DIR");

  return {findings, [=] {
            if (list->parsed()) return run_list(*arguments);
            if (show->parsed()) return run_show(*arguments);
            if (id->empty() && all->empty()) return fail("sipplab findings replay: expected an id or --all");
            return run_replay(*arguments);
          }};
}

}  // namespace sipplab::cli
