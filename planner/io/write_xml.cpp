// Pieces of AA-SIPP(m)'s XML: see write_xml.hpp.
#include "planner/io/write_xml.hpp"

#include <cmath>

#include "planner/grid/heading.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

void append_agent(std::string& out, const Agent& agent) {
  out += "\t\t<agent";
  append_attribute(out, "id", agent.id);
  append_attribute(out, "start.x", std::int64_t{agent.start.x});
  append_attribute(out, "start.y", std::int64_t{agent.start.y});
  append_attribute(out, "goal.x", std::int64_t{agent.goal.x});
  append_attribute(out, "goal.y", std::int64_t{agent.goal.y});
  const Agent defaults;
  if (agent.radius_cells != defaults.radius_cells) append_attribute(out, "size", agent.radius_cells);
  if (agent.speed_cells_per_s != defaults.speed_cells_per_s) {
    append_attribute(out, "movespeed", agent.speed_cells_per_s);
  }
  if (agent.rotation_speed != defaults.rotation_speed) {
    append_attribute(out, "rotationspeed", agent.rotation_speed);
  }
  if (agent.start_heading_deg != defaults.start_heading_deg) {
    append_attribute(out, "start.heading", agent.start_heading_deg);
  }
  if (agent.goal_heading_deg) append_attribute(out, "goal.heading", *agent.goal_heading_deg);
  out += "/>\n";
}

void append_obstacle(std::string& out, const DynamicObstacle& obstacle) {
  out += "\t\t<obstacle";
  append_attribute(out, "id", obstacle.id);
  append_attribute(out, "size", obstacle.radius_cells);
  out += ">\n";
  if (obstacle.trajectory.motions.empty()) {
    // An obstacle that never moves has a section all the same: it says where it is.
    append_sections(
        out, {obstacle.trajectory.start, {{0, 0, obstacle.trajectory.start, obstacle.trajectory.start}}},
        "\t\t\t");
  } else {
    append_sections(out, obstacle.trajectory, "\t\t\t");
  }
  out += "\t\t</obstacle>\n";
}

std::string_view published_name(InitialOrder order) {
  switch (order) {
    case InitialOrder::kShortestFirst:
      return "shortest_first";
    case InitialOrder::kLongestFirst:
      return "longest_first";
    case InitialOrder::kRandom:
      return "random";
    case InitialOrder::kFifo:
      break;
  }
  return "fifo";
}

std::string_view published_name(Rescheduling rescheduling) {
  switch (rescheduling) {
    case Rescheduling::kDeterministic:
      return "rulebased";
    case Rescheduling::kRandom:
      return "random";
    case Rescheduling::kEjection:
      return "ejection";  // not known to the published planner
    case Rescheduling::kNone:
      break;
  }
  return "no";
}

void append_element(std::string& out, const char* name, std::string_view text) {
  out += std::string("\t\t<") + name + ">";
  out += text;
  out += std::string("</") + name + ">\n";
}

}  // namespace

void append_escaped(std::string& out, std::string_view text) {
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += "&#" + std::to_string(static_cast<int>(c)) + ";";  // readers turn a bare line break into a blank
    } else {
      out += c;
    }
  }
}

void append_attribute(std::string& out, std::string_view name, std::string_view value) {
  out += ' ';
  out += name;
  out += "=\"";
  append_escaped(out, value);
  out += '"';
}

void append_attribute(std::string& out, std::string_view name, double value) {
  append_attribute(out, name, std::string_view(format_real(value)));
}

void append_attribute(std::string& out, std::string_view name, std::int64_t value) {
  append_attribute(out, name, std::string_view(std::to_string(value)));
}

void append_agents_xml(std::string& out, const Instance& instance) {
  out += "\t<agents";
  append_attribute(out, "number", static_cast<std::int64_t>(instance.agents.size()));
  out += ">\n";
  for (const Agent& agent : instance.agents) append_agent(out, agent);
  out += "\t</agents>\n";
}

void append_map_xml(std::string& out, const GridMap& map) {
  out += "\t<map type=\"grid\">\n\t\t<grid";
  append_attribute(out, "width", std::int64_t{map.width()});
  append_attribute(out, "height", std::int64_t{map.height()});
  out += ">\n";
  out.reserve(out.size() + 2 * map.cell_count() + 16 * static_cast<std::size_t>(map.height()));
  for (std::int32_t y = 0; y < map.height(); ++y) {
    out += "\t\t\t<row>";
    for (std::int32_t x = 0; x < map.width(); ++x) {
      if (x > 0) out += ' ';
      out += map.is_blocked({x, y}) ? '1' : '0';
    }
    out += "</row>\n";
  }
  out += "\t\t</grid>\n\t</map>\n";
}

void append_obstacles_xml(std::string& out, const Instance& instance) {
  if (instance.obstacles.empty()) return;
  out += "\t<dynamicobstacles>\n";
  for (const DynamicObstacle& obstacle : instance.obstacles) append_obstacle(out, obstacle);
  out += "\t</dynamicobstacles>\n";
}

void append_instance_xml(std::string& out, const Instance& instance) {
  append_agents_xml(out, instance);
  append_map_xml(out, instance.map);
  append_obstacles_xml(out, instance);
}

void append_options_xml(std::string& out, const PlannerOptions& options) {
  const auto time = [](double time_s, const char* infinite) {
    return std::isinf(time_s) ? std::string(infinite) : format_real(time_s);
  };
  out += "\t<algorithm>\n";
  append_element(out, "allowanyangle", options.any_angle ? "true" : "false");
  append_element(out, "connectedness", std::to_string(options.connectedness));
  if (options.weight != 1) append_element(out, "weight", format_real(options.weight));
  append_element(out, "prioritization", published_name(options.order));
  append_element(out, "rescheduling", published_name(options.rescheduling));
  append_element(out, "startsafeinterval", time(options.ssi_s, "infinity"));
  append_element(out, "timelimit", time(options.time_limit_s, "-1"));
  const MotionRules& rules = options.rules;
  if (rules.turns) append_element(out, "planforturns", "true");
  const auto append_margin = [&out](const char* name, double margin) {
    if (margin > 0) append_element(out, name, format_real(margin));
  };
  append_margin("waitbeforemove", rules.wait_before_move_s);
  append_margin("inflatecollisionintervals", rules.inflate_distance_cells);
  append_margin("inflatecollisiontime", rules.inflate_time_s);
  out += "\t</algorithm>\n";
}

void append_sections(std::string& out, const Trajectory& trajectory, std::string_view indent,
                     std::optional<double> start_heading_deg) {
  std::int64_t id = 0;
  double now_deg = start_heading_deg.value_or(0);
  for (const TimedMotion& motion : trajectory.motions) {
    out += indent;
    out += "<section";
    append_attribute(out, "id", id++);
    append_attribute(out, "start.x", std::int64_t{motion.from.x});
    append_attribute(out, "start.y", std::int64_t{motion.from.y});
    if (!motion.is_wait()) now_deg = heading_deg(motion.from, motion.to);
    const double before_deg = now_deg;
    if (start_heading_deg) append_attribute(out, "start.heading", before_deg);
    append_attribute(out, "goal.x", std::int64_t{motion.to.x});
    append_attribute(out, "goal.y", std::int64_t{motion.to.y});
    now_deg = motion.turn_to_deg.value_or(now_deg);
    if (start_heading_deg) append_attribute(out, "goal.heading", now_deg);
    // Else it would be read as a wait.
    if (start_heading_deg && motion.is_turn() && now_deg == before_deg) {
      append_attribute(out, "turn", std::string_view("true"));
    }
    // Times may be any numbers here: a wrong solution is written as it is.
    const double duration_s = motion.end_s - motion.begin_s;
    append_attribute(out, "duration", std::isfinite(duration_s) ? duration_s : 0.0);
    append_attribute(out, "begin", motion.begin_s);
    append_attribute(out, "end", motion.end_s);
    out += "/>\n";
  }
}

}  // namespace sipplab
