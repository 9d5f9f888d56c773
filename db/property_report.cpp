// One property run as text: for a person, or exact for programs.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "db/aligned.hpp"
#include "db/property_runs.hpp"

namespace sipplab::db {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const PropertyReport& report) {
  const PropertyRun& run = report.run;
  Json json;
  json["id"] = report.id;
  json["property_run"] = run.uuid;
  json["started_utc"] = run.started_utc;
  json["room"] = run.room;
  json["title"] = run.title;
  json["mutant"] = report.mutant;
  json["status"] = run.status;
  json["cases"] = run.cases;
  json["discards"] = run.discards;
  json["shrinks"] = run.shrinks;
  json["shrink_tries"] = run.shrink_tries;
  json["wall_time_ns"] = run.wall_time_ns;
  json["seed"] = run.seed;
  json["max_success"] = run.max_success;
  json["commit_hash"] = report.commit_hash ? Json(*report.commit_hash) : Json();
  json["branch"] = report.branch;
  json["dirty"] = report.dirty;
  json["host"] = report.host;
  json["compiler"] = report.compiler;
  json["build_type"] = report.build_type;
  json["sanitizers"] = report.sanitizers;
  json["classes"] = Json::object();
  for (const auto& [name, cases] : run.classes) json["classes"][name] = cases;
  const auto optional = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
  json["message"] = optional(run.message);
  json["reproduce"] = optional(run.reproduce);
  json["counterexample"] = optional(run.counterexample);
  json["plan_case"] = optional(run.plan_case);
  json["case_robots"] = run.case_robots ? Json(*run.case_robots) : Json();
  json["case_cells"] = run.case_cells ? Json(*run.case_cells) : Json();
  return json;
}

/// The text, each line escaped and indented.
std::string indented(const std::string& text) {
  std::string out;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out += "  " + escaped(text.substr(begin, end - begin)) + '\n';
    begin = end + 1;
  }
  return out;
}

std::string for_a_person(const PropertyReport& report) {
  const PropertyRun& run = report.run;
  std::string text =
      fmt::format("property  {} ({})\nroom      {}\n", escaped(run.title), report.id, run.room);
  if (!report.mutant.empty()) text += fmt::format("mutant    {}\n", escaped(report.mutant));
  text += fmt::format("status    {}, {} cases of {}, {} discarded, {:.2f} s\n", run.status, run.cases,
                      run.max_success, run.discards, static_cast<double>(run.wall_time_ns) * 1e-9);
  text += fmt::format("seed      {}\nstarted   {} on {}\n", run.seed, run.started_utc, escaped(report.host));
  text += fmt::format("build     {}, {}{}{}\n", report.compiler, report.build_type,
                      report.sanitizers.empty() ? "" : ", ", report.sanitizers);
  text += fmt::format("commit    {}{}\n", report.commit_hash.value_or("none"),
                      report.dirty ? ", changed since" : "");
  if (!run.classes.empty()) text += "classes\n";
  for (const auto& [name, cases] : run.classes) {
    text += fmt::format("  {:5.1f} %  {}\n",
                        100.0 * static_cast<double>(cases) / static_cast<double>(run.cases), escaped(name));
  }
  if (!run.message.empty()) text += "message\n" + indented(run.message);
  if (run.status != "failed") return text;
  text += fmt::format("counterexample, shrunk in {} steps of {} tried\n", run.shrinks, run.shrink_tries);
  text += indented(run.counterexample);
  if (run.plan_case.empty()) return text;
  return text +
         fmt::format("planned: {} robots, {} cells\n", run.case_robots.value_or(0),
                     run.case_cells.value_or(0)) +
         indented(run.plan_case);
}

Table table_of(const Json& json) {
  Table table{{"key", "value"}, {}};
  for (const auto& [key, value] : json.items()) {
    if (value.is_null()) {
      table.rows.push_back({key, Null{}});
    } else {
      table.rows.push_back({key, value.is_string() ? value.get<std::string>() : value.dump()});
    }
  }
  return table;
}

}  // namespace

std::string format_property_report(const PropertyReport& report, OutputFormat format) {
  if (format == OutputFormat::kTable) return for_a_person(report);
  const Json json = json_of(report);
  if (format == OutputFormat::kCsv) return format_csv(table_of(json));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sipplab::db
