// Reports of Google Benchmark, versions 1.4 to 1.9. What they can hold is what json_reporter.cc of these
// writes.
#include "bench/import/google_benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/sweep/run_info.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {
namespace {

using Json = nlohmann::json;

/// Members of the context that the library writes itself; any other came from --benchmark_context.
constexpr std::array kContextMembers{
    "date",        "host_name",           "executable",         "num_cpus",
    "mhz_per_cpu", "cpu_scaling_enabled", "aslr_enabled",       "caches",
    "load_avg",    "library_version",     "library_build_type", "json_schema_version"};

/// Members of a benchmark that are no counters of its author.
constexpr std::array kBenchmarkMembers{"name",
                                       "family_index",
                                       "per_family_instance_index",
                                       "run_name",
                                       "run_type",
                                       "repetitions",
                                       "repetition_index",
                                       "threads",
                                       "iterations",
                                       "real_time",
                                       "cpu_time",
                                       "time_unit",
                                       "error_occurred",
                                       "error_message",
                                       "label",
                                       "skipped",
                                       "skip_message",
                                       "aggregate_name",
                                       "aggregate_unit"};

/// Version 1.4 has no run_type: its aggregates are known by the ends of their names.
constexpr std::array<std::string_view, 4> kAggregateEnds{"_mean", "_median", "_stddev", "_cv"};

template <typename Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A bare word or number of the report that stands for no number: NaN, Infinity, -inf, -nan(ind), 1.#INF; and
/// the 12% of a fit's error, which versions before 1.1 write.
bool is_no_number(std::string_view word) {
  if (word.find(".#") != std::string_view::npos || word.ends_with('%')) return true;
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  std::string start(word.substr(0, 3));
  std::transform(start.begin(), start.end(), start.begin(), [](unsigned char c) { return std::tolower(c); });
  return start == "nan" || start == "inf";
}

/// What JSON does not know becomes what it knows: words that are no numbers become null, and backslashes that
/// escape nothing (version 1.4 does not escape) are doubled. Linear.
std::string as_json(std::string_view text) {
  constexpr std::string_view kStructure = "{}[],: \t\r\n\"";
  constexpr std::string_view kEscapes = "\"\\/bfnrtu";
  std::string json;
  json.reserve(text.size());
  bool quoted = false;
  for (std::size_t i = 0; i < text.size();) {
    if (quoted && text[i] == '\\') {
      const bool escapes = i + 1 < text.size() && kEscapes.find(text[i + 1]) != std::string_view::npos;
      json += escapes ? text.substr(i, 2) : std::string_view("\\\\");
      i += escapes ? 2 : 1;
    } else if (quoted || kStructure.find(text[i]) != std::string_view::npos) {
      if (text[i] == '"') quoted = !quoted;
      json += text[i++];
    } else {
      const std::string_view word = text.substr(i, text.find_first_of(kStructure, i) - i);
      json += is_no_number(word) ? std::string_view("null") : word;
      i += word.size();
    }
  }
  return json;
}

/// The document. A key that stands twice in an object has its first value: the library writes its own
/// measures before the counters, which may have any name.
Json parse(const std::string& json) {
  std::vector<std::set<std::string>> keys;
  return Json::parse(json, [&](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    return event != Json::parse_event_t::key || keys.back().insert(value.get<std::string>()).second;
  });
}

std::optional<double> number(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::optional<double> nanoseconds_per(const std::string& unit) {
  if (unit == "ns") return 1.0;
  if (unit == "us") return 1e3;
  if (unit == "ms") return 1e6;
  if (unit == "s") return 1e9;
  return std::nullopt;
}

/// The date of a report as the history writes times; empty if it is none. Without an offset (versions 1.4 to
/// 1.5.1, on Windows month/day/year) it is taken as UTC.
std::string utc_of(const std::string& date) {
  constexpr int kHoursOfDay = 24;
  constexpr int kMinutesOfHour = 60;
  constexpr std::size_t kLongest = std::string_view("2026-01-31T12:00:00+01:00").size();
  if (date.size() > kLongest) return "";
  std::tm local = {};
  char between = 'T';
  char sign = 'Z';
  int hours = 0;
  int minutes = 0;
  int end = 0;  // where the whole of a date without an offset ends
  const int fields = std::sscanf(date.c_str(), "%4d-%2d-%2d%c%2d:%2d:%2d%n%c%2d:%2d", &local.tm_year,
                                 &local.tm_mon, &local.tm_mday, &between, &local.tm_hour, &local.tm_min,
                                 &local.tm_sec, &end, &sign, &hours, &minutes);
  const bool has_offset = fields == 10 && (sign == '+' || sign == '-') && hours >= 0 && hours < kHoursOfDay &&
                          minutes >= 0 && minutes < kMinutesOfHour;
  const bool is_utc = fields == 7 || (fields == 8 && sign == 'Z');
  if (fields < 7) {
    local = {};
    if (std::sscanf(date.c_str(), "%2d/%2d/%2d %2d:%2d:%2d%n", &local.tm_mon, &local.tm_mday, &local.tm_year,
                    &local.tm_hour, &local.tm_min, &local.tm_sec, &end) != 6 ||
        static_cast<std::size_t>(end) != date.size())
      return "";
    local.tm_year += 2000;  // the library is younger
  } else if ((between != 'T' && between != ' ') || !(has_offset || is_utc)) {
    return "";
  }
  local.tm_year -= 1900;
  local.tm_mon -= 1;
  const std::tm given = local;
  const std::time_t moment = timegm(&local);
  // The library counts on from the 31st of April to the 1st of May, and so on.
  const auto fields_of = [](const std::tm& time) {
    return std::tie(time.tm_year, time.tm_mon, time.tm_mday, time.tm_hour, time.tm_min, time.tm_sec);
  };
  if (fields_of(local) != fields_of(given)) return "";
  const std::time_t offset_s = kMinutesOfHour * (hours * kMinutesOfHour + minutes);
  const std::time_t utc_moment = sign == '-' ? moment + offset_s : moment - offset_s;
  std::tm utc = {};
  if (gmtime_r(&utc_moment, &utc) == nullptr) return "";
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.000Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

/// A UUID made of a text (version 8).
std::string uuid_of(const std::string& text) {
  const std::string digits = text_digest(text) + text_digest("again " + text);
  return fmt::format("{}-{}-8{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(13, 3),
                     digits.substr(17, 3), digits.substr(20, 12));
}

/// Name of the aggregate that the object is, such as "median"; empty if it is a repetition. `names`: all of
/// the report.
std::string aggregate_of(const Json& object, const std::set<std::string>& names) {
  if (object.contains("run_type")) {
    return object.value("run_type", "") == "aggregate" ? object.value("aggregate_name", "unknown") : "";
  }
  if (object.contains("big_o")) return "BigO";
  if (object.contains("rms") && !object.contains("real_time")) return "RMS";
  const std::string name = object.value("name", "");
  for (const std::string_view end : kAggregateEnds) {
    if (!name.ends_with(end)) continue;
    const std::string base = name.substr(0, name.size() - end.size());
    if (names.contains(base) || (names.contains(base + "_mean") && names.contains(base + "_stddev")))
      return std::string(end.substr(1));
  }
  return "";
}

/// What the benchmark is called without the name of an aggregate.
std::string base_name(const Json& object, const std::string& aggregate) {
  const std::string name = object.value("name", "");
  const bool ends_so = !aggregate.empty() && name.ends_with("_" + aggregate);
  return object.value("run_name", ends_so ? name.substr(0, name.size() - aggregate.size() - 1) : name);
}

Expected<db::Measurement, std::string> read_benchmark(const Json& object, const std::string& name) {
  db::Measurement measurement;
  measurement.benchmark = name;
  const double iterations = number(object, "iterations").value_or(0);
  constexpr double kMostIterations = 9.2e18;  // just below 2^63, the range of the history and of the library
  if (!(iterations >= 0 && iterations <= kMostIterations))
    return Unexpected{fmt::format("{}: iterations {}, expected 0 to {}", name, iterations, kMostIterations)};
  measurement.iterations = static_cast<std::int64_t>(iterations);
  measurement.threads =
      static_cast<std::int64_t>(std::clamp(number(object, "threads").value_or(1), 1.0, 1e9));
  measurement.label = object.value("label", "");
  if (object.value("error_occurred", false)) measurement.error = object.value("error_message", "error");
  // What was skipped on purpose has no time either; its real_time is 0.
  if (object.value("skipped", false)) measurement.error = "skipped: " + object.value("skip_message", "");
  const std::string unit = object.value("time_unit", "ns");
  const std::optional<double> factor = nanoseconds_per(unit);
  if (!factor) return Unexpected{fmt::format("{}: time_unit '{}', expected ns, us, ms or s", name, unit)};
  if (measurement.error.empty()) {
    if (const auto time = number(object, "real_time")) measurement.real_time_ns = *time * *factor;
    if (const auto time = number(object, "cpu_time")) measurement.cpu_time_ns = *time * *factor;
  }
  for (const auto& [member, value] : object.items()) {
    if (value.is_number() && !contains(kBenchmarkMembers, member))
      measurement.counters.emplace_back(member, value.get<double>());
  }
  return measurement;
}

/// Every repetition; of a benchmark that has none, its median or mean.
Expected<std::vector<db::Measurement>, std::string> read_benchmarks(const Json& objects) {
  std::set<std::string> names;
  for (const Json& object : objects) {
    if (!object.is_object()) return Unexpected{std::string("a benchmark that is no object, expected one")};
    names.insert(object.value("name", ""));
  }
  if (names.contains("")) return Unexpected{std::string("a benchmark without a name, expected one")};
  std::vector<db::Measurement> measurements;
  std::map<std::string, std::int64_t> repetitions;
  for (const std::string_view wanted : {"", "median", "mean"}) {
    const std::map<std::string, std::int64_t> before = repetitions;
    for (const Json& object : objects) {
      const std::string aggregate = aggregate_of(object, names);
      const std::string name = base_name(object, aggregate);
      if (aggregate != wanted || before.contains(name)) continue;
      auto measurement = SIPPLAB_TRY(read_benchmark(object, name));
      measurement.repetition = repetitions[name]++;
      measurement.aggregate = aggregate;
      measurements.push_back(std::move(measurement));
    }
  }
  return measurements;
}

/// The last part of a path of any system, without ".exe".
std::string program_name(const std::string& path) {
  std::string name = path.substr(path.find_last_of("/\\") + 1);
  if (name.ends_with(".exe")) name.resize(name.size() - 4);
  return name;
}

db::RunInfo run_info(const Json& context, const ImportContext& given) {
  db::RunInfo info;
  const std::string program = context.value("executable", "");
  info.suite = given.suite;
  if (info.suite.empty()) info.suite = program_name(program);
  if (info.suite.empty()) info.suite = "google-benchmark";
  info.command_line = program;
  info.branch = given.branch;
  info.machine.host = context.value("host_name", "");
  info.machine.cores =
      static_cast<std::int64_t>(std::clamp(number(context, "num_cpus").value_or(0), 0.0, 1e9));
  if (const auto mhz = number(context, "mhz_per_cpu")) info.machine.cpu_model = fmt::format("{} MHz", *mhz);
  info.build.build_type = context.value("library_build_type", "");
  return info;
}

/// What --benchmark_context added: "commit=abc1234 compiler=gcc".
std::string custom_context(const Json& context) {
  std::string custom;
  for (const auto& [member, value] : context.items()) {
    if (contains(kContextMembers, member)) continue;
    if (!custom.empty()) custom += ' ';
    custom += member + "=";
    custom += value.is_string() ? value.get<std::string>() : value.dump();
  }
  return custom;
}

/// The hash of the commit: as given, else as the report's context says.
std::optional<std::string> commit_hash(const Json& context, const ImportContext& given) {
  if (given.commit) return given.commit;
  const std::string hash = context.value("commit", "");
  return is_commit_hash(hash) ? std::optional(hash) : std::nullopt;
}

}  // namespace

bool is_commit_hash(std::string_view text) {
  constexpr std::size_t kShortest = 7;  // what git abbreviates to
  return text.size() >= kShortest && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Expected<db::MeasurementRun, std::string> read_google_benchmark(const std::string& path,
                                                                const ImportContext& given) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream stream;
  stream << file.rdbuf();
  if (!file || std::filesystem::is_directory(path))
    return Unexpected{path + ": cannot be read, expected a report"};
  const std::string text = stream.str();
  const std::string json = as_json(text);
  Json report;
  try {
    report = parse(json);
  } catch (const Json::parse_error& error) {
    const auto end = json.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, json.size()));
    return Unexpected{fmt::format("{}:{}: not JSON, expected what --benchmark_format=json writes", path,
                                  1 + std::count(json.begin(), end, '\n'))};
  } catch (const Json::out_of_range&) {
    return Unexpected{path +
                      ":1: a number beyond those of 64 bits, expected what --benchmark_format=json writes"};
  }
  if (!report.is_object() || !report.contains("benchmarks") || !report["benchmarks"].is_array() ||
      !report.value("context", Json::object()).is_object()) {
    return Unexpected{path + ":1: no list 'benchmarks', expected a report of Google Benchmark"};
  }
  const Json context = report.value("context", Json::object());
  db::MeasurementRun run;
  std::optional<std::string> commit;
  try {
    run.info = run_info(context, given);
    run.info.options = custom_context(context);
    commit = commit_hash(context, given);
    run.started_utc = utc_of(context.value("date", ""));
    if (run.started_utc.empty())
      return Unexpected{path + ":1: no date in its context, expected one such as 2026-01-31T12:00:00+00:00"};
    auto measurements = read_benchmarks(report["benchmarks"]);
    if (!measurements) return Unexpected{path + ":1: " + measurements.error()};
    run.measurements = std::move(*measurements);
  } catch (const Json::exception& error) {
    return Unexpected{fmt::format("{}:1: {}", path, error.what())};
  }
  if (run.measurements.empty())
    return Unexpected{path + ":1: no repetition, median or mean of a benchmark, expected at least one"};
  if (commit) {
    run.info.commit.emplace();
    run.info.commit->hash = *commit;
    run.info.commit->subject = given.subject;
    run.info.commit->committed_utc = run.started_utc;
  }
  run.uuid = uuid_of(text + "\n" + commit.value_or("") + "\n" + run.info.suite);
  return run;
}

}  // namespace sipplab::bench
