// MovingAI's maps and scenarios: see movingai.hpp.
#include "planner/io/movingai.hpp"

#include <array>
#include <limits>
#include <optional>

#include "planner/io/instance_parts.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

/// MovingAI's letters; E is an emitter of the League of Robot Runners, where robots may stand. # is what
/// other text maps have for walls.
constexpr std::string_view kFreeCells = ".GSE";
constexpr std::string_view kBlockedCells = "@OTW#";
constexpr const char* kCellWords = "'.', 'G', 'S' or 'E' where free, '@', 'O', 'T', 'W' or '#' where blocked";

bool is_printable(char c) { return c > ' ' && c < 0x7f; }

/// The parts of a line, separated by blanks or tabs. A line with tabs is parted by
/// tabs alone, since the name of a map may hold blanks.
std::vector<std::string_view> fields_of(std::string_view line) {
  const std::string_view separators = line.find('\t') != std::string_view::npos ? "\t" : " ";
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return fields;
    const std::size_t end = line.find_first_of(separators, begin);
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end);
  }
}

/// Reads lines and words the complaints about them.
class Reader {
 public:
  Reader(std::string_view text, const std::string& file_name) : lines_(text), file_name_(file_name) {}

  std::optional<std::string_view> next() { return lines_.next(); }
  int line() const { return lines_.line(); }

  /// A complaint about the line that next() returned last.
  Unexpected<InputError> error(std::string what, std::string expected) const {
    return Unexpected{InputError{file_name_, lines_.line(), std::move(what), std::move(expected)}};
  }
  /// A complaint about the end of the text.
  Unexpected<InputError> error_at_end(std::string what, std::string expected) const {
    return Unexpected{InputError{file_name_, lines_.line() + 1, std::move(what), std::move(expected)}};
  }

 private:
  LineScanner lines_;
  const std::string& file_name_;
};

struct MapHeader {
  std::optional<std::int64_t> width;
  std::optional<std::int64_t> height;
};

/// Up to and including the line "map".
Input<MapHeader> read_map_header(Reader& reader) {
  MapHeader header;
  while (const auto line = reader.next()) {
    const std::vector<std::string_view> fields = fields_of(*line);
    if (fields.empty()) continue;
    const std::string_view key = fields[0];
    if (key == "map" && fields.size() == 1) {
      if (!header.width || !header.height) {
        return reader.error(std::string("no ") + (header.width ? "height" : "width") + " before the map",
                            "lines 'height H' and 'width W'");
      }
      return header;
    }
    if (fields.size() != 2 || (key != "type" && key != "width" && key != "height")) {
      return reader.error("line " + in_quotes(*line) + " in the header of a map",
                          "'type octile', 'height H', 'width W' or 'map'");
    }
    if (key == "type") {
      if (fields[1] != "octile" && fields[1] != "tile") {
        return reader.error("map of type " + in_quotes(fields[1]), "octile");
      }
      continue;
    }
    std::optional<std::int64_t>& side = key == "width" ? header.width : header.height;
    if (side) return reader.error("a second " + std::string(key), "one");
    side = parse_integer(fields[1]);
    if (!side) return reader.error(std::string(key) + " " + in_quotes(fields[1]), "a number of cells");
    const std::string size_error = GridMap::check_size(header.width.value_or(1), header.height.value_or(1));
    if (!size_error.empty()) {
      return reader.error(std::string(key) + " " + std::to_string(*side),
                          "1 to " + std::to_string(GridMap::kMaxSide));
    }
  }
  return reader.error_at_end("the text ends within the header of the map", "a line 'map' and rows of cells");
}

std::string_view first_word(std::string_view head) { return head.substr(0, head.find_first_of(" \t\r\n")); }

bool is_map(std::string_view head) {
  const std::string_view word = first_word(head);
  return word == "type" || word == "height" || word == "width";
}
bool is_scenario(std::string_view head) { return first_word(head) == "version"; }

Input<InstanceParts> parts_of_map(std::string_view text, const std::string& file_name) {
  Input<GridMap> map = parse_movingai_map(text, file_name);
  if (!map) return Unexpected{map.error()};
  InstanceParts parts;
  parts.file_name = file_name;
  parts.map = MapPart{std::move(*map), 1};
  return parts;
}

Input<InstanceParts> parts_of_scenario(std::string_view text, const std::string& file_name) {
  Input<MovingaiScenario> scenario = parse_movingai_scen(text, file_name);
  if (!scenario) return Unexpected{scenario.error()};
  InstanceParts parts;
  parts.file_name = file_name;
  if (!scenario->agents.empty()) {
    parts.map_reference = MapReference{std::move(scenario->map_name), scenario->map_width,
                                       scenario->map_height, scenario->agent_lines.front()};
  }
  parts.agents = LinedList<Agent>{std::move(scenario->agents), std::move(scenario->agent_lines), 1};
  parts.states_bodies = false;
  return parts;
}

}  // namespace

Input<GridMap> parse_movingai_map(std::string_view text, const std::string& file_name) {
  Reader reader(text, file_name);
  const Input<MapHeader> header = read_map_header(reader);
  if (!header) return Unexpected{header.error()};
  const auto width = static_cast<std::size_t>(*header->width);
  const auto height = static_cast<std::size_t>(*header->height);

  // The rows first, as they stand in the text: what the header announces is
  // allocated only when the text is seen to hold it.
  std::vector<std::string_view> rows;
  while (rows.size() < height) {
    const auto row = reader.next();
    if (!row) {
      return reader.error_at_end("the text ends after " + std::to_string(rows.size()) + " rows of the map",
                                 std::to_string(height) + " rows");
    }
    if (row->size() != width) {
      return reader.error(
          "row " + std::to_string(rows.size()) + " has " + std::to_string(row->size()) + " cells",
          std::to_string(width));
    }
    for (const char cell : *row) {
      if (kFreeCells.find(cell) != std::string_view::npos ||
          kBlockedCells.find(cell) != std::string_view::npos)
        continue;
      const bool is_digit = cell >= '0' && cell <= '9';
      return reader.error(
          (is_printable(cell) ? "cell " + in_quotes({&cell, 1}) : std::string("unprintable cell")) +
              " in row " + std::to_string(rows.size()) +
              (is_digit ? " (weighted terrain, which has no meaning here)" : ""),
          kCellWords);
    }
    rows.push_back(*row);
  }
  while (const auto line = reader.next()) {
    if (!trimmed(*line).empty()) {
      return reader.error("text " + in_quotes(*line) + " after the last row",
                          std::to_string(height) + " rows");
    }
  }

  GridMap map(static_cast<std::int32_t>(width), static_cast<std::int32_t>(height));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (kFreeCells.find(rows[y][x]) != std::string_view::npos) continue;
      map.set_blocked({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, true);
    }
  }
  return map;
}

Input<MovingaiScenario> parse_movingai_scen(std::string_view text, const std::string& file_name) {
  Reader reader(text, file_name);
  const auto version = reader.next();
  const std::vector<std::string_view> version_fields = fields_of(version.value_or(""));
  if (version_fields.size() != 2 || version_fields[0] != "version" || parse_real(version_fields[1]) != 1.0) {
    return Unexpected{InputError{file_name, 1, "line " + in_quotes(version.value_or("")), "'version 1'"}};
  }

  MovingaiScenario scenario;
  while (const auto line = reader.next()) {
    const std::vector<std::string_view> fields = fields_of(*line);
    if (fields.empty()) continue;
    constexpr std::size_t kFields = 9;
    if (fields.size() != kFields) {
      return reader.error("row of " + std::to_string(fields.size()) + " fields",
                          "9: bucket, map, map width, map height, start x, start y, goal x, goal y, length");
    }
    if (!parse_integer(fields[0])) return reader.error("bucket " + in_quotes(fields[0]), "an integer");
    if (fields[1].empty()) return reader.error("a map name of blanks", "the name of a map");
    if (!parse_real(fields[8])) return reader.error("optimal length " + in_quotes(fields[8]), "a number");

    constexpr std::array<const char*, 6> kNames = {"map width", "map height", "start x",
                                                   "start y",   "goal x",     "goal y"};
    std::array<std::int32_t, 6> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number = parse_integer(fields[2 + i]);
      if (!number || *number < 0 || *number > std::numeric_limits<std::int32_t>::max()) {
        return reader.error(kNames[i] + std::string(" ") + in_quotes(fields[2 + i]), "an integer from 0");
      }
      numbers[i] = static_cast<std::int32_t>(*number);
    }
    if (scenario.agents.empty()) {
      scenario.map_name = std::string(fields[1]);
      scenario.map_width = numbers[0];
      scenario.map_height = numbers[1];
    } else if (scenario.map_name != fields[1] || scenario.map_width != numbers[0] ||
               scenario.map_height != numbers[1]) {
      return reader.error("map " + in_quotes(fields[1]) + " of " + std::to_string(numbers[0]) + " x " +
                              std::to_string(numbers[1]),
                          "the map of the rows before: " + in_quotes(scenario.map_name) + " of " +
                              std::to_string(scenario.map_width) + " x " +
                              std::to_string(scenario.map_height));
    }
    Agent agent;
    agent.id = std::to_string(scenario.agents.size());
    agent.start = {numbers[2], numbers[3]};
    agent.goal = {numbers[4], numbers[5]};
    scenario.agents.push_back(std::move(agent));
    scenario.agent_lines.push_back(reader.line());
  }
  return scenario;
}

InstanceFormat movingai_map_format() {
  return {is_map, parts_of_map, [](std::string_view, const std::string&) { return std::string("a map"); }};
}

InstanceFormat movingai_scenario_format() { return {is_scenario, parts_of_scenario}; }

}  // namespace sipplab
