// One property run as text: for a person, or exact for programs.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "db/aligned.hpp"
#include "db/json_text.hpp"
#include "db/property_runs.hpp"

namespace sipplab::db {
namespace {

using Json = nlohmann::ordered_json;

void put(Json& json, const char* name, const std::string& value) { json[name] = value; }
void put(Json& json, const char* name, const MaybeEmpty<const std::string>& value) {
  json[name] = value.text.empty() ? Json() : Json(value.text);
}
template <class T>
void put(Json& json, const char* name, const std::optional<T>& value) {
  json[name] = value ? Json(*value) : Json();
}
template <class T>
void put(Json& json, const char* name, const T& value) {
  json[name] = value;
}

Json json_of(const PropertyReport& report) {
  Json json;
  const auto visit = [&json](const char* name, const auto& value) { put(json, name, value); };
  json["id"] = report.id;
  json["property_run"] = report.run.uuid;
  PropertyRun::origin_columns(report.run, visit);
  json.erase("uuid");
  PropertyRun::columns(report.run, visit);
  json["classes"] = Json::object();
  for (const auto& [name, cases] : report.run.classes) json["classes"][name] = cases;
  PropertyReport::columns(report, visit);
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
  return json_text(json);
}

}  // namespace sipplab::db
