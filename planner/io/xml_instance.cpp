// The parts of an XML instance: see xml_instance.hpp. The order of the functions is
// that of the parts in a file: agents, map, obstacles.
#include "planner/io/xml_instance.hpp"

#include <array>

#include "planner/io/xml_options.hpp"
#include "planner/io/xml_reader.hpp"
#include "planner/io/xml_sections.hpp"

namespace sipplab {
namespace {

using pugi::xml_node;

constexpr NumberRange kRadii{kMinRadiusCells, kMaxRadiusCells, "a radius in cells, 0.001 to 64"};
constexpr NumberRange kSpeeds{kMinSpeedCellsPerS, kMaxSpeedCellsPerS,
                              "a speed in cells per second, 0.001 to 1000"};
constexpr NumberRange kRotationSpeeds{kMinRotationSpeed, kMaxRotationSpeed,
                                      "half turns per second, 0.001 to 1000"};
constexpr NumberRange kHeadings{0, 360, "degrees from 0 to 360"};

/// The published format allows 360, which is 0.
double wrapped(double heading_deg) { return heading_deg == 360 ? 0 : heading_deg; }

std::string id_of(XmlReader& reader, xml_node node, std::size_t position) {
  return node.attribute("id") ? reader.words(node, "id") : std::to_string(position);
}

/// Overwrites what the element states of sizes, speeds and headings; the same for
/// <defaultparameters> and <agent>.
void read_agent_parameters(XmlReader& reader, xml_node node, Agent& agent) {
  agent.radius_cells = reader.optional_real(node, "size", kRadii).value_or(agent.radius_cells);
  agent.speed_cells_per_s =
      reader.optional_real(node, "movespeed", kSpeeds).value_or(agent.speed_cells_per_s);
  agent.rotation_speed =
      reader.optional_real(node, "rotationspeed", kRotationSpeeds).value_or(agent.rotation_speed);
  agent.start_heading_deg =
      wrapped(reader.optional_real(node, "start.heading", kHeadings).value_or(agent.start_heading_deg));
  if (const pugi::xml_attribute heading = node.attribute("goal.heading")) {
    const std::string_view word = trimmed(heading.value());
    agent.goal_heading_deg.reset();
    if (word != "whatever" && parse_real(word) != -1.0) {
      agent.goal_heading_deg = wrapped(reader.optional_real(node, "goal.heading", kHeadings).value_or(0));
    }
  }
}

LinedList<Agent> read_agents(XmlReader& reader, xml_node node) {
  reader.expect_only_children(node, {"defaultparameters", "agent"});
  reader.expect_only_attributes(node, {"number"});
  Agent defaults;
  if (const xml_node parameters = reader.only_child(node, "defaultparameters")) {
    reader.expect_only_attributes(parameters,
                                  {"size", "movespeed", "rotationspeed", "start.heading", "goal.heading"});
    read_agent_parameters(reader, parameters, defaults);
  }
  LinedList<Agent> agents;
  agents.line = reader.line(node);
  for (const xml_node element : node.children("agent")) {
    reader.expect_only_attributes(element, {"id", "start.x", "start.y", "goal.x", "goal.y", "size",
                                            "movespeed", "rotationspeed", "start.heading", "goal.heading"});
    reader.expect_only_children(element, {});
    Agent agent = defaults;
    agent.id = id_of(reader, element, agents.items.size());
    agent.start = {reader.required_integer(element, "start.x"), reader.required_integer(element, "start.y")};
    agent.goal = {reader.required_integer(element, "goal.x"), reader.required_integer(element, "goal.y")};
    read_agent_parameters(reader, element, agent);
    if (reader.failed()) return agents;
    agents.items.push_back(std::move(agent));
    agents.lines.push_back(reader.line(element));
  }
  if (node.attribute("number") &&
      reader.required_integer(node, "number") != static_cast<std::int64_t>(agents.items.size())) {
    reader.fail(node,
                "number " + in_quotes(node.attribute("number").value()) + " in <agents> that holds " +
                    std::to_string(agents.items.size()) + " <agent>",
                "the two to be equal");
  }
  return agents;
}

/// The older dialect: <agents>N</agents>, then N times <startx> <starty> <finishx>
/// <finishy>, all inside <map>. Counts decide, and the k-th of each kind belong together.
LinedList<Agent> read_archive_agents(XmlReader& reader, xml_node map_node) {
  LinedList<Agent> agents;
  const xml_node count_node = reader.only_child(map_node, "agents");
  agents.line = reader.line(count_node ? count_node : map_node);
  constexpr std::array<const char*, 4> kTags = {"startx", "starty", "finishx", "finishy"};
  std::array<std::vector<std::int32_t>, 4> values;
  for (std::size_t kind = 0; kind < kTags.size(); ++kind) {
    for (const xml_node element : map_node.children(kTags[kind])) {
      values[kind].push_back(reader.integer_text(element));
      if (kind == 0) agents.lines.push_back(reader.line(element));
      if (reader.failed()) return agents;
    }
  }
  const std::int64_t count =
      count_node ? reader.integer_text(count_node) : static_cast<std::int64_t>(values[0].size());
  for (std::size_t kind = 0; kind < kTags.size(); ++kind) {
    if (static_cast<std::int64_t>(values[kind].size()) == count) continue;
    reader.fail(count_node ? count_node : map_node,
                std::to_string(values[kind].size()) + " <" + kTags[kind] + "> for " + std::to_string(count) +
                    " agents",
                "one for each agent");
    return agents;
  }
  for (std::size_t i = 0; i < values[0].size(); ++i) {
    Agent agent;
    agent.id = std::to_string(i);
    agent.start = {values[0][i], values[1][i]};
    agent.goal = {values[2][i], values[3][i]};
    agents.items.push_back(std::move(agent));
  }
  return agents;
}

/// Appends the cells of one row, 1 where blocked. False after a complaint.
bool read_row(XmlReader& reader, xml_node row, std::size_t row_number, std::int32_t width,
              std::vector<std::uint8_t>& cells) {
  const std::string text = XmlReader::text_of(row);
  const std::string name = "row " + std::to_string(row_number);
  const std::size_t cells_before = cells.size();
  std::string_view rest = trimmed(text);
  while (!rest.empty()) {
    const std::string_view token = rest.substr(0, rest.find_first_of(" \t\r\n"));
    const auto value = parse_integer(token);
    if (!value) {
      reader.fail(row, "cell " + in_quotes(token) + " in " + name,
                  "0 where free, another integer where blocked");
      return false;
    }
    cells.push_back(*value == 0 ? 0 : 1);
    rest = trimmed(rest.substr(token.size()));
  }
  const std::size_t count = cells.size() - cells_before;
  if (count == static_cast<std::size_t>(width)) return true;
  reader.fail(row, count == 0 ? name + " has no text" : name + " has " + std::to_string(count) + " cells",
              std::to_string(width) + " cells");
  return false;
}

/// The size stands in attributes of <grid>, in the older dialect in <width> and
/// <height> beside it.
MapPart read_map(XmlReader& reader, xml_node node) {
  MapPart part;
  part.line = reader.line(node);
  reader.expect_only_children(
      node, {"grid", "width", "height", "agents", "startx", "starty", "finishx", "finishy", "cellsize"});
  reader.expect_only_attributes(node, {"type"});
  const xml_node grid = reader.only_child(node, "grid");
  if (!grid) {
    reader.fail(node, "no <grid> in <map>", "one");
    return part;
  }
  reader.expect_only_children(grid, {"row"});
  reader.expect_only_attributes(grid, {"width", "height"});
  const auto read_side = [&](const char* name) {
    const xml_node child = reader.only_child(node, name);
    return child && !grid.attribute(name) ? reader.integer_text(child) : reader.required_integer(grid, name);
  };
  const std::int32_t width = read_side("width");
  const std::int32_t height = read_side("height");
  if (reader.failed()) return part;
  const std::string size_error = GridMap::check_size(width, height);
  if (!size_error.empty()) {
    reader.fail(grid, size_error, "");
    return part;
  }

  // Rows are counted and read before the map is made: what is announced is allocated
  // only when the text is seen to hold it.
  std::int64_t row_count = 0;
  for (const xml_node row : grid.children("row")) row_count += row ? 1 : 0;
  if (row_count != height) {
    reader.fail(grid, std::to_string(row_count) + " rows", std::to_string(height));
    return part;
  }
  std::vector<std::uint8_t> cells;
  std::size_t row_number = 0;
  for (const xml_node row : grid.children("row")) {
    if (!read_row(reader, row, row_number++, width, cells)) return part;
  }
  part.map = GridMap(width, height);
  for (std::size_t i = 0; i < cells.size(); ++i) part.map.set_blocked(part.map.cell(i), cells[i] != 0);
  return part;
}

LinedList<DynamicObstacle> read_obstacles(XmlReader& reader, xml_node node) {
  reader.expect_only_children(node, {"defaultparameters", "obstacle"});
  double default_radius_cells = kDefaultRadiusCells;
  if (const xml_node parameters = reader.only_child(node, "defaultparameters")) {
    reader.expect_only_attributes(parameters, {"size"});
    default_radius_cells = reader.optional_real(parameters, "size", kRadii).value_or(default_radius_cells);
  }
  LinedList<DynamicObstacle> obstacles;
  obstacles.line = reader.line(node);
  for (const xml_node element : node.children("obstacle")) {
    reader.expect_only_children(element, {"section"});
    reader.expect_only_attributes(element, {"id", "size"});
    DynamicObstacle obstacle;
    obstacle.id = id_of(reader, element, obstacles.items.size());
    obstacle.radius_cells = reader.optional_real(element, "size", kRadii).value_or(default_radius_cells);
    if (!element.child("section")) reader.fail(element, "an <obstacle> without <section>", "at least one");
    obstacle.trajectory = read_sections(reader, element, SectionOptions{});
    if (reader.failed()) return obstacles;
    obstacles.items.push_back(std::move(obstacle));
    obstacles.lines.push_back(reader.line(element));
  }
  return obstacles;
}

bool holds_agents(xml_node map) { return map.child("agents") || map.child("startx"); }

bool begins_as_xml(std::string_view head) { return head.substr(0, 1) == "<"; }

/// "a solution" for XML with a <log>, "XML without agents", "XML of another kind", or nothing: the text may
/// be an instance, or no XML at all.
std::string xml_without_robots(std::string_view text, const std::string& file_name) {
  const Input<std::unique_ptr<XmlReader>> parsed = XmlReader::parse(text, file_name);
  if (!parsed) return parsed.error().expected == kRootTag ? "XML of another kind" : "";
  const xml_node root = (*parsed)->root();
  if (root.child("log")) return "a solution";
  return root.child("agents") || holds_agents(root.child("map")) ? "" : "XML without agents";
}

}  // namespace

Input<InstanceParts> parse_xml_instance(std::string_view text, const std::string& file_name) {
  Input<std::unique_ptr<XmlReader>> parsed = XmlReader::parse(text, file_name);
  if (!parsed) return Unexpected{parsed.error()};
  XmlReader& reader = **parsed;
  const xml_node root = reader.root();
  reader.expect_only_children(root, {"agents", "map", "algorithm", "options", "dynamicobstacles", "log"});

  InstanceParts parts;
  parts.file_name = file_name;
  const xml_node map = reader.only_child(root, "map");
  const bool agents_in_map = holds_agents(map);
  if (const xml_node agents = reader.only_child(root, "agents")) {
    if (agents_in_map) reader.fail(agents, "<agents> besides those in <map>", "one of the two");
    parts.agents = read_agents(reader, agents);
  } else if (agents_in_map) {
    parts.agents = read_archive_agents(reader, map);
  }
  if (map && !reader.failed()) parts.map = read_map(reader, map);
  parts.options = read_options(reader);
  if (const xml_node obstacles = reader.only_child(root, "dynamicobstacles")) {
    parts.obstacles = read_obstacles(reader, obstacles);
  }
  if (reader.failed()) return Unexpected{reader.error()};
  parts.warnings = reader.take_warnings();
  return parts;
}

InstanceFormat xml_instance_format() { return {begins_as_xml, parse_xml_instance, xml_without_robots}; }

}  // namespace sipplab
