// Solutions as JSON: see solution_io.hpp.
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "planner/io/json_options.hpp"
#include "planner/io/text.hpp"
#include "sipplab/error.hpp"
#include "sipplab/solution_io.hpp"

namespace sipplab {
namespace {

using Json = nlohmann::ordered_json;

/// Whole numbers without a point. JSON has neither infinity nor NaN: they become null.
Json number(std::optional<double> value) {
  constexpr double kWholeBelow = 0x1p53;  // each whole number is a double up to here
  if (!value || !std::isfinite(*value)) return nullptr;
  const bool is_whole = std::trunc(*value) == *value && std::abs(*value) < kWholeBelow;
  if (is_whole && (*value != 0 || !std::signbit(*value))) return static_cast<std::int64_t>(*value);
  return *value;
}

Json ssi(double ssi_s) { return std::isinf(ssi_s) ? Json("inf") : number(ssi_s); }

/// Digits that every JSON reader keeps, even one that stores all numbers as double.
constexpr std::size_t kSafeDigits = 15;

bool is_canonical_integer(std::string_view id) {
  if (id.substr(0, 1) == "-" && id != "-0") id.remove_prefix(1);
  if (id.empty() || id.size() > kSafeDigits || (id.size() > 1 && id[0] == '0')) return false;
  return id.find_first_not_of("0123456789") == std::string_view::npos;
}

/// On one line, with a blank after each comma and colon: line breaks of a text would be escaped.
std::string text_of(const Json& value) {
  std::string text;
  for (const char c : value.dump(0, ' ', false, Json::error_handler_t::replace)) {
    if (c != '\n') text += c;
    if (c == '\n' && text.back() == ',') text += ' ';
  }
  return text;
}

std::string real(double value) { return std::isfinite(value) ? format_real(value) : "null"; }

/// Nearly all of a file is motions, and they are numbers alone: as documents each would take seven times as
/// long.
void append_motion(std::string& out, const TimedMotion& motion) {
  fmt::format_to(std::back_inserter(out), R"({{"t0": {}, "t1": {}, "x0": {}, "y0": {}, "x1": {}, "y1": {})",
                 real(motion.begin_s), real(motion.end_s), motion.from.x, motion.from.y, motion.to.x,
                 motion.to.y);
  if (motion.turn_to_deg) out += R"(, "turn_to": )" + real(*motion.turn_to_deg);
  out += '}';
}

std::string trajectory_text(const Agent& agent, const Trajectory& trajectory) {
  std::string out = fmt::format(
      R"({{"id": {}, "radius": {}, "speed": {}, "start": [{}, {}], "goal": [{}, {}], "motions": [)",
      is_canonical_integer(agent.id) ? agent.id : text_of(agent.id), real(agent.radius_cells),
      real(agent.speed_cells_per_s), trajectory.start.x, trajectory.start.y, agent.goal.x, agent.goal.y);
  for (std::size_t i = 0; i < trajectory.motions.size(); ++i) {
    if (i > 0) out += ", ";
    append_motion(out, trajectory.motions[i]);
  }
  return out + "]}";
}

void add_options(Json& out, const PlannerOptions& options) {
  for (const Option& option : option_rows()) {
    if (*option.json == '\0' || !is_told(option, options)) continue;
    out[option.json] = Json::parse(option_to_json(option, options));
  }
}

Json costs(double flowtime, double makespan) {
  return {{"flowtime", number(flowtime)}, {"makespan", number(makespan)}};
}

Json step_of(const BestStep& step) {
  return {{"kind", name(step.kind)},
          {"ssi", ssi(step.ssi_s)},
          {"status", name(step.status)},
          {"tries", step.tries},
          {"seconds", number(step.seconds)},
          {"ended", number(step.ended_s)},
          {"cost", step.cost ? costs(step.cost->flowtime_s, step.cost->makespan_s) : Json()}};
}

Json improvement_of(const ImprovementLog& log) {
  const PlanCost& last = log.curve.back().cost;
  Json out = {
      {"objective", format_objective(log.objective)},
      {"iterations", log.iterations},
      {"improvements", log.improvements},
      {"ssi_promise", log.keeps_guarantee},
      {"lower_bound", costs(log.bound.flowtime_s, log.bound.makespan_s)},
      {"gap", costs(gap(last.flowtime_s, log.bound.flowtime_s), gap(last.makespan_s, log.bound.makespan_s))},
      {"curve", Json::array()}};
  for (const ProgressPoint& point : log.curve) {
    out["curve"].push_back({{"seconds", number(point.seconds)},
                            {"iteration", point.iteration},
                            {"flowtime", number(point.cost.flowtime_s)},
                            {"makespan", number(point.cost.makespan_s)}});
  }
  return out;
}

/// One key a line; lists of objects have a line for each.
std::string laid_out(const Json& document, const std::vector<std::string>& trajectories) {
  std::string out = "{";
  for (const auto& [key, value] : document.items()) {
    std::vector<std::string> objects;
    if (value.is_array() && !value.empty() && value[0].is_object()) {
      for (const Json& object : value) objects.push_back(text_of(object));
    }
    const std::vector<std::string>& lines = key == "trajectories" ? trajectories : objects;
    out += fmt::format("{}\n  \"{}\": ", out.size() > 1 ? "," : "", key);
    out += lines.empty() ? text_of(value) : fmt::format("[\n    {}\n  ]", fmt::join(lines, ",\n    "));
  }
  return out + "\n}\n";
}

}  // namespace

std::string solution_to_json(const Instance& instance, const SolutionDocument& document) {
  const std::vector<Trajectory>& trajectories = document.solution.trajectories;
  PLANNER_ASSERT(trajectories.empty() || trajectories.size() == instance.agents.size());
  Json out = {{"status", document.status},
              {"valid", document.valid},
              {"robots", instance.agents.size()},
              {"makespan", number(document.makespan_s)},
              {"flowtime", number(document.flowtime_s)},
              {"tries", document.tries},
              {"expansions", document.expansions},
              {"generations", document.generations},
              {"planning_seconds", number(document.planning_seconds)},
              {"plan_hash", document.plan_hash.empty() ? Json() : Json(document.plan_hash)},
              {"order", document.order},
              {"trajectories", Json::array()}};
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    lines.push_back(trajectory_text(instance.agents[i], trajectories[i]));
  }
  if (document.options) add_options(out, *document.options);
  if (!document.made_by.empty()) out["made_by"] = document.made_by;
  if (document.ssi_kept_s) out["ssi_kept"] = ssi(*document.ssi_kept_s);
  for (const EjectionRecord& record : document.ejections) {
    out["ejections"].push_back({{"failed", record.failed}, {"ejected", record.ejected}});
  }
  for (const BestStep& step : document.steps) out["steps"].push_back(step_of(step));
  if (document.improvement) out["improvement"] = improvement_of(*document.improvement);
  return laid_out(out, lines);
}

}  // namespace sipplab
