// Reading solutions from JSON: see solution_io.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "planner/io/json_line.hpp"
#include "planner/io/json_options.hpp"
#include "planner/io/solution_parts.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

using nlohmann::json;

/// Takes values out of a parsed document; the first complaint is kept, and says
/// what in the document it is about ("trajectories[3].motions[0].t1").
class JsonReader {
 public:
  /// Both must outlive it.
  JsonReader(std::string_view text, const std::string& file_name) : text_(text), file_name_(file_name) {}

  void fail(const std::string& where, const std::string& expected) {
    fail_with(where, where + " is missing or of the wrong kind", expected);
  }
  void fail_with(const std::string& where, const std::string& what, const std::string& expected) {
    if (!error_) error_ = InputError{file_name_, json_line(text_, where), what, expected};
  }
  const std::optional<InputError>& error() const { return error_; }

  const json* find(const json& object, const char* key) const {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
  }

  double number(const json& object, const char* key, const std::string& where) {
    const json* value = find(object, key);
    const double result = value && value->is_number() ? value->get<double>() : std::nan("");
    if (!std::isfinite(result)) fail(where + key, "a finite number");
    return result;
  }
  std::optional<double> number_or_null(const json& object, const char* key, const std::string& where = "") {
    const json* value = find(object, key);
    if (!value || value->is_null()) return std::nullopt;
    return number(object, key, where);
  }
  std::int32_t coordinate(const json& object, const char* key, const std::string& where) {
    return coordinate(find(object, key), where + key);
  }
  std::int32_t coordinate(const json* value, const std::string& where) {
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    if (value && value->is_number_integer()) {
      // Above 63 bits an unsigned number would come back negative.
      const bool huge = value->is_number_unsigned() && value->get<std::uint64_t>() > kMost;
      const auto result = value->get<std::int64_t>();
      if (!huge && result >= -kMost && result <= kMost) return static_cast<std::int32_t>(result);
    }
    fail(where, "an integer within 32 bits");
    return 0;
  }
  /// [x, y]; none where there is no such key.
  std::optional<Cell> place(const json& object, const char* key, const std::string& where) {
    const json* value = find(object, key);
    if (!value) return std::nullopt;
    if (!value->is_array() || value->size() != 2) {
      fail(where + key, "a cell, [x, y]");
      return std::nullopt;
    }
    const std::string here = where + key;
    return Cell{coordinate(&(*value)[0], here + "[0]"), coordinate(&(*value)[1], here + "[1]")};
  }
  std::uint64_t count(const json& object, const char* key) {
    const json* value = find(object, key);
    if (!value || value->is_null()) return 0;
    if (value->is_number_unsigned()) return value->get<std::uint64_t>();
    fail(key, "a number of things, 0 or more");
    return 0;
  }
  /// What was counted, or 0 where it is not said; XML holds no more.
  std::uint64_t work(const json& object, const char* key) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 53;
    const std::uint64_t counted = count(object, key);
    if (counted > kMost) fail(key, "a number of things up to 2^53");
    return counted;
  }
  std::optional<double> duration(const json& object, const char* key) {
    const std::optional<double> seconds = number_or_null(object, key);
    if (seconds && *seconds < 0) fail(key, "seconds, 0 or more");
    return seconds;
  }
  std::string text(const json& object, const char* key, const std::string& otherwise) {
    const json* value = find(object, key);
    if (!value || value->is_null()) return otherwise;
    if (value->is_string()) return value->get<std::string>();
    fail(key, "text");
    return otherwise;
  }
  bool boolean(const json& object, const char* key, bool otherwise) {
    const json* value = find(object, key);
    if (!value || value->is_null()) return otherwise;
    if (value->is_boolean()) return value->get<bool>();
    fail(key, "true or false");
    return otherwise;
  }

 private:
  std::string_view text_;
  const std::string& file_name_;
  std::optional<InputError> error_;
};

Trajectory read_trajectory(JsonReader& reader, const json& value, const std::string& where) {
  Trajectory trajectory;
  const json* motions = reader.find(value, "motions");
  if (!motions || !motions->is_array()) {
    reader.fail(where + "motions", "a list");
    return trajectory;
  }
  std::size_t position = 0;
  for (const json& motion : *motions) {
    const std::string here = where + "motions[" + std::to_string(position++) + "].";
    trajectory.motions.push_back(
        {reader.number(motion, "t0", here),
         reader.number(motion, "t1", here),
         {reader.coordinate(motion, "x0", here), reader.coordinate(motion, "y0", here)},
         {reader.coordinate(motion, "x1", here), reader.coordinate(motion, "y1", here)},
         reader.number_or_null(motion, "turn_to", here)});
    if (trajectory.motions.back().is_turn() && !trajectory.motions.back().is_wait()) {
      reader.fail_with(here + "turn_to", here + "turn_to in a motion that changes place",
                       "turns in place alone");
    }
    if (reader.error()) return trajectory;
  }
  return trajectory;
}

std::optional<std::string> read_id(JsonReader& reader, const json& value, const std::string& where) {
  const json* id = reader.find(value, "id");
  if (!id) return std::nullopt;
  if (id->is_string()) return id->get<std::string>();
  if (id->is_number_unsigned()) return std::to_string(id->get<std::uint64_t>());
  if (id->is_number_integer()) return std::to_string(id->get<std::int64_t>());
  reader.fail(where + "id", "text or an integer");
  return std::nullopt;
}

/// Without a plan the list may be empty.
void read_trajectories(JsonReader& reader, const json& document, const Instance& instance, bool is_solved,
                       Solution& solution) {
  const json* values = reader.find(document, "trajectories");
  if (!values || !values->is_array()) return reader.fail("trajectories", "a list");
  if (values->empty() && !is_solved) return;
  TrajectoryCollector collector(instance);
  std::size_t position = 0;
  for (const json& value : *values) {
    const std::string where = "trajectories[" + std::to_string(position) + "].";
    const std::optional<std::string> id = read_id(reader, value, where);
    const std::optional<Cell> start = reader.place(value, "start", where);
    reader.place(value, "goal", where);  // whether it is reached is the validator's question
    const std::string problem = collector.add(id, position++, read_trajectory(reader, value, where), start);
    if (!problem.empty()) reader.fail_with(where, problem, "one trajectory for each robot of the instance");
    if (reader.error()) return;
  }
  if (const auto missing = collector.missing()) {
    return reader.fail_with("trajectories",
                            "no trajectory of robot " + in_quotes(instance.agents[*missing].id),
                            "one for each robot of the instance");
  }
  solution = collector.take();
}

void read_order(JsonReader& reader, const json& document, const Instance& instance,
                std::vector<AgentIndex>& order) {
  const json* values = reader.find(document, "order");
  if (!values || values->is_null()) return;
  if (!values->is_array()) return reader.fail("order", "a list");
  for (const json& value : *values) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= instance.agents.size()) {
      return reader.fail("order[" + std::to_string(order.size()) + "]",
                         "the position of a robot, counted from 0");
    }
    order.push_back(static_cast<AgentIndex>(value.get<std::uint64_t>()));
  }
}

/// None where there is no such key.
std::optional<double> read_ssi(JsonReader& reader, const json& document, const char* key) {
  const json* ssi = reader.find(document, key);
  if (!ssi) return std::nullopt;
  if (ssi->is_string() && ssi->get<std::string>() == "inf") return kInfiniteSsi;
  const double ssi_s = reader.number(document, key, "");
  if (!is_ssi(ssi_s)) reader.fail(key, fmt::format("a number from 0 to {:g}, or \"inf\"", kMaxSsiS));
  return ssi_s;
}

/// Only where there is a start-safe interval or a rule of motion: other programs may mean something else by a
/// key such as "method". A start-safe interval that is not stated is 0.
void read_planner_options(JsonReader& reader, const json& document, SolutionDocument& result) {
  PlannerOptions options;
  options.ssi_s = 0;
  const auto value_of = [&](const Option& option) {
    const json* value = *option.json != '\0' ? reader.find(document, option.json) : nullptr;
    return value && !value->is_null() ? value : nullptr;
  };
  const OptionRows rows = option_rows();
  const bool is_ours = std::any_of(rows.begin(), rows.end(), [&](const Option& option) {
    const bool is_telling = option.group == OptionGroup::kMotion || option.name == std::string_view("ssi");
    return is_telling && value_of(option);
  });
  if (!is_ours) return;
  for (const Option& option : rows) {
    const json* value = value_of(option);
    if (value && !option_from_json(option, *value, options)) reader.fail(option.json, option.expected);
  }
  result.options = options;
}

bool is_json(std::string_view head) { return head.substr(0, 1) == "{"; }

Input<SolutionDocument> parse_solution_json(std::string_view text, const std::string& file_name,
                                            const Instance& instance) {
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& failure) {
    const auto* where = dynamic_cast<const json::parse_error*>(&failure);
    const std::size_t offset = where && where->byte > 0 ? where->byte - 1 : 0;
    const int line = LineTable(text).line(std::min(offset, text.size()));
    return Unexpected{InputError{file_name, line, "not well-formed JSON", "a complete document"}};
  }
  JsonReader reader(text, file_name);
  SolutionDocument result;
  result.status = reader.text(document, "status", "solved");
  if (result.status != "solved" && result.status != "failed" && result.status != "limit") {
    reader.fail("status", "solved, failed or limit");
  }
  result.valid = reader.boolean(document, "valid", false);
  result.makespan_s = reader.duration(document, "makespan");
  result.flowtime_s = reader.duration(document, "flowtime");
  result.tries = reader.work(document, "tries");
  result.expansions = reader.work(document, "expansions");
  result.generations = reader.work(document, "generations");
  result.planning_seconds = reader.duration(document, "planning_seconds").value_or(0);
  result.plan_hash = reader.text(document, "plan_hash", "");
  if (reader.find(document, "robots") && reader.count(document, "robots") != instance.agents.size()) {
    reader.fail_with("robots", "robots is " + std::to_string(reader.count(document, "robots")),
                     "the " + std::to_string(instance.agents.size()) + " of the instance");
  }
  read_order(reader, document, instance, result.order);
  read_trajectories(reader, document, instance, result.status == "solved", result.solution);
  read_planner_options(reader, document, result);
  result.made_by = reader.text(document, "made_by", "");
  result.ssi_kept_s = read_ssi(reader, document, "ssi_kept");
  if (reader.error()) return Unexpected{*reader.error()};
  return result;
}

}  // namespace

SolutionFormat json_format() {
  return {"json", "JSON of this program", is_json, parse_solution_json, always<solution_to_json>};
}

}  // namespace sipplab
