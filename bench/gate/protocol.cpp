#include "bench/gate/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/io/json_options.hpp"

namespace sipplab::bench {
namespace {

using Json = nlohmann::json;

constexpr const char* kNotOurWords = "a line that is not what this program's workers say";

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> optional_number(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::optional<db::ResultStatus> parse_status(const std::string& text) {
  for (const db::ResultStatus status : {db::ResultStatus::kSolved, db::ResultStatus::kFailed,
                                        db::ResultStatus::kLimit, db::ResultStatus::kInvalid}) {
    if (db::name(status) == text) return status;
  }
  return std::nullopt;
}

/// "max_expansions" of --max-expansions.
std::string key_of(const Option& option) {
  std::string key = option.name;
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// Calls `read`, which may throw as the library does on a value of another type.
template <class T, class Read>
Expected<T, std::string> guarded(Read read) {
  try {
    return read();
  } catch (const Json::exception&) {
    return Unexpected{std::string(kNotOurWords)};
  }
}

}  // namespace

Json to_json(const PlannerOptions& options) {
  Json json = Json::object();
  for (const Option& option : option_rows())
    json[key_of(option)] = Json::parse(option_to_json(option, options));
  json["ssi"] = format_ssi(options.ssi_s);  // a text always: so builds of version 1.0 read it
  return json;
}

Expected<PlannerOptions, std::string> options_from_json(const Json& object) {
  return guarded<PlannerOptions>([&object]() -> Expected<PlannerOptions, std::string> {
    PlannerOptions options;
    for (const Option& option : option_rows()) {
      const auto found = object.find(key_of(option));
      if (found == object.end()) continue;
      const bool is_read = found->is_string() ? option.set(options, found->get<std::string>())
                                              : option_from_json(option, *found, options);
      if (!is_read) return Unexpected{std::string(kNotOurWords)};
    }
    options.time_limit_s = db::kNoTimeLimit;  // a clock that strikes would change results
    return options;
  });
}

Json to_json(const WorkerGreeting& greeting) {
  const db::BuildInfo& build = greeting.build;
  return {{"sipplab_gate", greeting.protocol},
          {"compiler", build.compiler},
          {"compiler_version", build.compiler_version},
          {"flags", build.flags},
          {"build_type", build.build_type},
          {"assertions", build.assertions},
          {"sanitizers", build.sanitizers},
          {"binary_hash", build.binary_hash},
          {"dirty", build.dirty},
          {"program", greeting.program},
          {"unfit", greeting.unfit},
          {"injected_slowdown", greeting.injected_slowdown}};
}

Expected<WorkerGreeting, std::string> greeting_from_json(const Json& object) {
  return guarded<WorkerGreeting>([&object]() -> Expected<WorkerGreeting, std::string> {
    WorkerGreeting greeting;
    greeting.protocol = object.at("sipplab_gate").get<int>();
    if (greeting.protocol < kPlanningProtocol || greeting.protocol > kGateProtocol) {
      return Unexpected{
          fmt::format("protocol {} of the gate, expected {} to {}: ask the newer build to compare",
                      greeting.protocol, kPlanningProtocol, kGateProtocol)};
    }
    db::BuildInfo& build = greeting.build;
    build.compiler = object.at("compiler").get<std::string>();
    build.compiler_version = object.at("compiler_version").get<std::string>();
    build.flags = object.at("flags").get<std::string>();
    build.build_type = object.at("build_type").get<std::string>();
    build.assertions = object.at("assertions").get<bool>();
    build.sanitizers = object.at("sanitizers").get<std::string>();
    build.binary_hash = object.at("binary_hash").get<std::string>();
    build.dirty = object.at("dirty").get<bool>();
    greeting.program = object.at("program").get<std::string>();
    greeting.unfit = object.at("unfit").get<std::string>();
    greeting.injected_slowdown = object.at("injected_slowdown").get<double>();
    return greeting;
  });
}

Json to_json(const WorkerAnswer& answer) {
  const db::ResultRow& row = answer.row;
  Json object = {{"status", db::name(row.status)},
                 {"tries", row.tries},
                 {"expansions", row.expansions},
                 {"generations", row.generations},
                 {"makespan_s", optional_json(row.makespan_s)},
                 {"flowtime_s", optional_json(row.flowtime_s)},
                 {"cpu_ns", answer.cpu_ns},
                 {"message", row.message}};
  if (row.plan_hash) object["plan_hash"] = *row.plan_hash;
  if (row.valid) object["valid"] = *row.valid;
  if (row.peak_memory_bytes) object["peak_memory_bytes"] = *row.peak_memory_bytes;
  return object;
}

Expected<WorkerAnswer, std::string> answer_from_json(const Json& object) {
  return guarded<WorkerAnswer>([&object]() -> Expected<WorkerAnswer, std::string> {
    WorkerAnswer answer;
    db::ResultRow& row = answer.row;
    const auto status = parse_status(object.at("status").get<std::string>());
    if (!status) return Unexpected{std::string(kNotOurWords)};
    row.status = *status;
    row.tries = object.at("tries").get<std::uint64_t>();
    row.expansions = object.at("expansions").get<std::uint64_t>();
    row.generations = object.at("generations").get<std::uint64_t>();
    row.makespan_s = optional_number(object, "makespan_s");
    row.flowtime_s = optional_number(object, "flowtime_s");
    if (object.contains("plan_hash")) row.plan_hash = object.at("plan_hash").get<std::uint64_t>();
    if (object.contains("valid")) row.valid = object.at("valid").get<bool>();
    if (object.contains("peak_memory_bytes")) {
      row.peak_memory_bytes = object.at("peak_memory_bytes").get<std::int64_t>();
    }
    row.message = object.at("message").get<std::string>();
    answer.cpu_ns = object.at("cpu_ns").get<std::int64_t>();
    row.planning_time_ns = answer.cpu_ns;
    return answer;
  });
}

}  // namespace sipplab::bench
