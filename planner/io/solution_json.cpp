// Solutions as JSON: see solution_io.hpp. Written by hand, so that keys keep their
// order and each trajectory has a line of its own.
#include <cmath>

#include "planner/core/assert.hpp"
#include "planner/io/solution_io.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

void append_string(std::string& out, std::string_view text) {
  constexpr const char* kHexDigits = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20) {
      out += "\\u00";
      out += kHexDigits[byte >> 4];
      out += kHexDigits[byte & 0xf];
    } else {
      out += c;
    }
  }
  out += '"';
}

/// JSON has neither infinity nor NaN: they become null.
void append_number(std::string& out, std::optional<double> value) {
  if (value && std::isfinite(*value)) {
    append_real(out, *value);
  } else {
    out += "null";
  }
}

/// Digits that every JSON reader keeps, even one that stores all numbers as double.
constexpr std::size_t kSafeDigits = 15;

bool is_canonical_integer(std::string_view id) {
  if (id.substr(0, 1) == "-" && id != "-0") id.remove_prefix(1);
  if (id.empty() || id.size() > kSafeDigits || (id.size() > 1 && id[0] == '0')) return false;
  return id.find_first_not_of("0123456789") == std::string_view::npos;
}

void append_id(std::string& out, const std::string& id) {
  if (is_canonical_integer(id)) {
    out += id;
  } else {
    append_string(out, id);
  }
}

void append_trajectory(std::string& out, const Agent& agent, const Trajectory& trajectory) {
  out += "{\"id\": ";
  append_id(out, agent.id);
  out += ", \"radius\": ";
  append_number(out, agent.radius_cells);
  out += ", \"speed\": ";
  append_number(out, agent.speed_cells_per_s);
  out += ", \"motions\": [";
  bool first = true;
  for (const TimedMotion& motion : trajectory.motions) {
    out += first ? "{\"t0\": " : ", {\"t0\": ";
    first = false;
    append_number(out, motion.begin_s);
    out += ", \"t1\": ";
    append_number(out, motion.end_s);
    out += ", \"x0\": " + std::to_string(motion.from.x) + ", \"y0\": " + std::to_string(motion.from.y) +
           ", \"x1\": " + std::to_string(motion.to.x) + ", \"y1\": " + std::to_string(motion.to.y);
    if (motion.turn_to_deg) {
      out += ", \"turn_to\": ";
      append_number(out, *motion.turn_to_deg);
    }
    out += '}';
  }
  out += "]}";
}

void append_ssi(std::string& out, double ssi_s) {
  if (std::isinf(ssi_s)) {
    out += "\"inf\"";
  } else {
    append_number(out, ssi_s);
  }
}

void append_options(std::string& out, const PlannerOptions& options) {
  out += ",\n  \"ssi\": ";
  append_ssi(out, options.ssi_s);
  out += ",\n  \"reschedule\": \"" + std::string(name(options.rescheduling)) + "\"";
  out += ",\n  \"initial_order\": \"" + std::string(name(options.order)) + "\"";
  out += std::string(",\n  \"any_angle\": ") + (options.any_angle ? "true" : "false");
  out += ",\n  \"connectedness\": " + std::to_string(options.connectedness);
  out += ",\n  \"seed\": " + std::to_string(options.seed);
  if (options.weight != 1) {
    out += ",\n  \"weight\": ";
    append_number(out, options.weight);
  }
  const MotionRules& rules = options.rules;
  if (rules.turns) out += ",\n  \"turns\": true";
  const auto append_margin = [&out](const char* key, double margin) {
    if (margin <= 0) return;
    out += std::string(",\n  \"") + key + "\": ";
    append_number(out, margin);
  };
  append_margin("wait_before_move", rules.wait_before_move_s);
  append_margin("inflate_distance", rules.inflate_distance_cells);
  append_margin("inflate_time", rules.inflate_time_s);
}

void append_indices(std::string& out, const std::vector<AgentIndex>& agents) {
  out += '[';
  for (std::size_t i = 0; i < agents.size(); ++i) out += (i > 0 ? ", " : "") + std::to_string(agents[i]);
  out += ']';
}

/// A list with one element a line.
template <class Elements, class Append>
void append_lines(std::string& out, const Elements& elements, Append&& append) {
  out += '[';
  bool first = true;
  for (const auto& element : elements) {
    out += first ? "\n    " : ",\n    ";
    first = false;
    append(element);
  }
  out += "\n  ]";
}

void append_ejections(std::string& out, const std::vector<EjectionRecord>& ejections) {
  out += ",\n  \"ejections\": ";
  append_lines(out, ejections, [&out](const EjectionRecord& record) {
    out += "{\"failed\": " + std::to_string(record.failed) + ", \"ejected\": ";
    append_indices(out, record.ejected);
    out += '}';
  });
}

void append_costs(std::string& out, double flowtime, double makespan) {
  out += "{\"flowtime\": ";
  append_number(out, flowtime);
  out += ", \"makespan\": ";
  append_number(out, makespan);
  out += '}';
}

void append_steps(std::string& out, const std::vector<BestStep>& steps) {
  out += ",\n  \"steps\": ";
  append_lines(out, steps, [&out](const BestStep& step) {
    out += "{\"kind\": \"" + std::string(name(step.kind)) + "\", \"ssi\": ";
    append_ssi(out, step.ssi_s);
    out += ", \"status\": \"" + std::string(name(step.status)) + "\"";
    out += ", \"tries\": " + std::to_string(step.tries) + ", \"seconds\": ";
    append_number(out, step.seconds);
    out += ", \"ended\": ";
    append_number(out, step.ended_s);
    out += ", \"cost\": ";
    if (step.cost) {
      append_costs(out, step.cost->flowtime_s, step.cost->makespan_s);
    } else {
      out += "null";
    }
    out += '}';
  });
}

void append_improvement(std::string& out, const ImprovementLog& log) {
  out += ",\n  \"improvement\": {\"objective\": ";
  append_string(out, format_objective(log.objective));
  out += ", \"iterations\": " + std::to_string(log.iterations);
  out += ", \"improvements\": " + std::to_string(log.improvements);
  out += std::string(", \"ssi_promise\": ") + (log.keeps_promise ? "true" : "false");
  out += ", \"lower_bound\": ";
  append_costs(out, log.bound.flowtime_s, log.bound.makespan_s);
  const PlanCost& last = log.curve.back().cost;
  out += ", \"gap\": ";
  append_costs(out, gap(last.flowtime_s, log.bound.flowtime_s), gap(last.makespan_s, log.bound.makespan_s));
  out += ", \"curve\": ";
  append_lines(out, log.curve, [&out](const ProgressPoint& point) {
    out += "{\"seconds\": ";
    append_number(out, point.seconds);
    out += ", \"iteration\": " + std::to_string(point.iteration) + ", \"flowtime\": ";
    append_number(out, point.cost.flowtime_s);
    out += ", \"makespan\": ";
    append_number(out, point.cost.makespan_s);
    out += '}';
  });
  out += '}';
}

}  // namespace

std::string solution_to_json(const Instance& instance, const SolutionDocument& document) {
  const std::vector<Trajectory>& trajectories = document.solution.trajectories;
  PLANNER_ASSERT(trajectories.empty() || trajectories.size() == instance.agents.size());
  std::string out = "{\n  \"status\": ";
  append_string(out, document.status);
  out += std::string(",\n  \"valid\": ") + (document.valid ? "true" : "false");
  out += ",\n  \"robots\": " + std::to_string(instance.agents.size());
  out += ",\n  \"makespan\": ";
  append_number(out, document.makespan_s);
  out += ",\n  \"flowtime\": ";
  append_number(out, document.flowtime_s);
  out += ",\n  \"tries\": " + std::to_string(document.tries);
  out += ",\n  \"expansions\": " + std::to_string(document.expansions);
  out += ",\n  \"generations\": " + std::to_string(document.generations);
  out += ",\n  \"planning_seconds\": ";
  append_number(out, document.planning_seconds);
  out += ",\n  \"plan_hash\": ";
  if (document.plan_hash.empty()) {
    out += "null";
  } else {
    append_string(out, document.plan_hash);
  }
  out += ",\n  \"order\": ";
  append_indices(out, document.order);
  out += ",\n  \"trajectories\": [";
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    out += i > 0 ? ",\n    " : "\n    ";
    append_trajectory(out, instance.agents[i], trajectories[i]);
  }
  out += trajectories.empty() ? "]" : "\n  ]";
  if (document.options) append_options(out, *document.options);
  if (!document.made_by.empty()) {
    out += ",\n  \"made_by\": ";
    append_string(out, document.made_by);
  }
  if (document.ssi_kept_s) {
    out += ",\n  \"ssi_kept\": ";
    append_ssi(out, *document.ssi_kept_s);
  }
  if (!document.ejections.empty()) append_ejections(out, document.ejections);
  if (!document.steps.empty()) append_steps(out, document.steps);
  if (document.improvement) append_improvement(out, *document.improvement);
  out += "\n}\n";
  return out;
}

}  // namespace sipplab
