// Reports of Google Benchmark, versions 1.5 to 1.9.
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
#include <sstream>
#include <string_view>
#include <tuple>

#include "bench/sweep/run_info.hpp"

namespace sipplab::bench {
namespace {

using Json = nlohmann::json;

/// Members of a benchmark that are no counters of its author.
constexpr std::array kKnownMembers{"name",
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

/// Google Benchmark writes bare NaN, inf and -inf, which JSON does not know: they become null.
std::string without_bare_words(std::string text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && quoted) {
      ++i;
      continue;
    }
    if (text[i] == '"') quoted = !quoted;
    if (quoted) continue;
    for (const std::string_view word : {"-nan", "-inf", "nan", "inf"}) {
      if (text.size() - i < word.size()) continue;
      bool same = true;
      for (std::size_t k = 0; k < word.size(); ++k) {
        same = same && std::tolower(static_cast<unsigned char>(text[i + k])) == word[k];
      }
      const std::size_t end = i + word.size();
      if (!same || (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0)) continue;
      text.replace(i, word.size(), "null");
      i += 3;
      break;
    }
  }
  return text;
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

/// "2026-01-31T12:00:00+01:00" as the history writes times; empty where it is none.
std::string utc_of(const std::string& date) {
  constexpr int kHoursOfDay = 24;
  constexpr int kMinutesOfHour = 60;
  constexpr std::size_t kLongest = std::string_view("2026-01-31T12:00:00+01:00").size();
  std::tm local = {};
  char sign = 'Z';
  int hours = 0;
  int minutes = 0;
  const int fields = date.size() > kLongest
                         ? 0
                         : std::sscanf(date.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c%2d:%2d", &local.tm_year,
                                       &local.tm_mon, &local.tm_mday, &local.tm_hour, &local.tm_min,
                                       &local.tm_sec, &sign, &hours, &minutes);
  const bool is_local = fields == 9 && (sign == '+' || sign == '-') && hours >= 0 && hours < kHoursOfDay &&
                        minutes >= 0 && minutes < kMinutesOfHour;
  if (!is_local && !(fields == 6 || (fields == 7 && sign == 'Z'))) return "";
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

bool is_counter(const std::string& member) {
  for (const char* known : kKnownMembers) {
    if (member == known) return false;
  }
  return true;
}

Expected<db::Measurement, std::string> read_benchmark(const Json& object,
                                                      std::map<std::string, std::int64_t>& seen) {
  db::Measurement measurement;
  const std::string name = object.value("run_name", object.value("name", ""));
  if (name.empty()) return Unexpected{std::string("a benchmark without name")};
  measurement.benchmark = name;
  measurement.repetition = seen[name]++;
  measurement.iterations = static_cast<std::int64_t>(number(object, "iterations").value_or(0));
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
    if (value.is_number() && is_counter(member))
      measurement.counters.emplace_back(member, value.get<double>());
  }
  return measurement;
}

db::RunInfo run_info(const Json& context, const ImportContext& given) {
  db::RunInfo info;
  const std::string program = context.value("executable", "");
  info.suite = given.suite;
  if (info.suite.empty()) info.suite = std::filesystem::path(program).filename().string();
  if (info.suite.empty()) info.suite = "google-benchmark";
  info.command_line = program;
  info.branch = given.branch;
  info.machine.host = context.value("host_name", "");
  info.machine.cores = static_cast<std::int64_t>(number(context, "num_cpus").value_or(0));
  if (const auto mhz = number(context, "mhz_per_cpu")) info.machine.cpu_model = fmt::format("{} MHz", *mhz);
  info.build.build_type = context.value("library_build_type", "");
  return info;
}

}  // namespace

Expected<db::MeasurementRun, std::string> read_google_benchmark(const std::string& path,
                                                                const ImportContext& given) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream stream;
  stream << file.rdbuf();
  if (!file || std::filesystem::is_directory(path))
    return Unexpected{path + ": cannot be read, expected a report"};
  const std::string text = stream.str();
  Json report;
  try {
    report = Json::parse(without_bare_words(text));
  } catch (const Json::parse_error& error) {
    const auto line =
        1 + std::count(text.begin(),
                       text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size())), '\n');
    return Unexpected{
        fmt::format("{}:{}: not JSON, expected what --benchmark_format=json writes", path, line)};
  } catch (const Json::out_of_range&) {
    return Unexpected{path +
                      ": a number beyond those of 64 bits, expected what --benchmark_format=json writes"};
  }
  if (!report.is_object() || !report.contains("benchmarks") || !report["benchmarks"].is_array() ||
      !report.value("context", Json::object()).is_object()) {
    return Unexpected{path + ":1: no list 'benchmarks', expected a report of Google Benchmark"};
  }
  const Json context = report.value("context", Json::object());
  db::MeasurementRun run;
  try {
    run.info = run_info(context, given);
    run.started_utc = utc_of(context.value("date", ""));
    if (run.started_utc.empty())
      return Unexpected{path + ":1: no date in its context, expected one such as 2026-01-31T12:00:00+00:00"};
    std::map<std::string, std::int64_t> seen;
    for (const Json& object : report["benchmarks"]) {
      if (!object.is_object()) return Unexpected{path + ":1: a benchmark that is no object, expected one"};
      if (object.value("run_type", "iteration") != "iteration") continue;
      auto measurement = read_benchmark(object, seen);
      if (!measurement) return Unexpected{path + ":1: " + measurement.error()};
      run.measurements.push_back(std::move(*measurement));
    }
  } catch (const Json::exception& error) {
    return Unexpected{fmt::format("{}:1: {}", path, error.what())};
  }
  if (run.measurements.empty()) return Unexpected{path + ":1: no benchmark that ran, expected at least one"};
  if (given.commit) {
    db::CommitInfo commit;
    commit.hash = *given.commit;
    commit.subject = given.subject;
    commit.committed_utc = run.started_utc;
    run.info.commit = std::move(commit);
  }
  run.uuid = uuid_of(text + "\n" + given.commit.value_or("") + "\n" + run.info.suite);
  return run;
}

}  // namespace sipplab::bench
