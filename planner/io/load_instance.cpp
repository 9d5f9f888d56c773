// From files to an Instance: see instance_io.hpp.
#include "sipplab/instance_io.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

#include "planner/instance/reachability.hpp"
#include "planner/io/instance_parts.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab {

// Each is defined in the file of its format.
InstanceFormat movingai_map_format();
InstanceFormat movingai_scenario_format();
InstanceFormat xml_instance_format();

namespace {

/// In the order in which a text is asked for its format; null: it is of none.
const InstanceFormat* format_of(std::string_view text) {
  static const InstanceFormat formats[] = {
      xml_instance_format(),
      movingai_scenario_format(),
      movingai_map_format(),
  };
  constexpr std::size_t kHeadLength = 4096;  // no format begins with more blanks than that
  const std::string_view head = trimmed(without_byte_order_mark(text).substr(0, kHeadLength));
  const auto* const found =
      std::find_if(std::begin(formats), std::end(formats),
                   [&](const InstanceFormat& format) { return format.begins_so(head); });
  return found == std::end(formats) ? nullptr : found;
}

Input<InstanceParts> parse_parts(std::string_view text, const std::string& file_name) {
  if (const InstanceFormat* const format = format_of(text)) return format->parse(text, file_name);
  return Unexpected{
      InputError{file_name, 1, text.empty() ? "empty file" : "neither XML nor a MovingAI file",
                 "XML with <root>, or text that begins with 'type' (a map) or 'version' (a scenario)"}};
}

Input<InstanceParts> read_parts(const std::string& path) {
  const Input<std::string> text = read_text(path);
  if (!text) return Unexpected{text.error()};
  return parse_parts(*text, path);
}

/// Where the map that a scenario names may be, likeliest place first.
std::vector<std::string> map_places(const std::string& scenario_path, const std::string& map_name) {
  const std::filesystem::path folder = std::filesystem::path(scenario_path).parent_path();
  const std::filesystem::path file = std::filesystem::path(map_name).filename();
  return {(folder / map_name).string(), (folder / file).string(), (folder / ".." / "maps" / file).string()};
}

Input<InstanceParts> read_map_of_scenario(const InstanceParts& scenario) {
  const MapReference& reference = *scenario.map_reference;
  for (const std::string& place : map_places(scenario.file_name, reference.name)) {
    std::error_code ignored;
    if (std::filesystem::exists(place, ignored)) return read_parts(place);
  }
  return Unexpected{InputError{scenario.file_name, reference.line,
                               "map " + in_quotes(reference.name) + " not found",
                               "it beside the scenario or in ../maps, or a map given besides"}};
}

/// The files in the order in which they are asked for a part.
struct Sources {
  std::vector<InstanceParts> files;
  // Position in `files` of the file given for a role.
  std::optional<std::size_t> instance, map, task, config, obstacles;
};

/// The file to take a part from: the one given for it, else the instance, else any.
template <class Has>
InstanceParts* choose(Sources& sources, std::optional<std::size_t> given_for_it, const Has& has) {
  if (given_for_it && has(sources.files[*given_for_it])) return &sources.files[*given_for_it];
  if (sources.instance && has(sources.files[*sources.instance])) return &sources.files[*sources.instance];
  for (InstanceParts& parts : sources.files) {
    if (has(parts)) return &parts;
  }
  return nullptr;
}

std::string wrong_part(const char* what) { return std::string("no ") + what + " in this file"; }

/// Reads every file once and sees that a file given for a part holds it.
Input<Sources> read_sources(const InstanceFiles& files) {
  Sources sources;
  const auto add = [&sources](const std::optional<std::string>& path,
                              std::optional<std::size_t>& position) -> std::optional<InputError> {
    if (!path) return std::nullopt;
    Input<InstanceParts> parts = read_parts(*path);
    if (!parts) return parts.error();
    position = sources.files.size();
    sources.files.push_back(std::move(*parts));
    return std::nullopt;
  };
  if (auto error = add(files.instance, sources.instance)) return Unexpected{*error};
  if (auto error = add(files.task, sources.task)) return Unexpected{*error};
  if (auto error = add(files.map, sources.map)) return Unexpected{*error};
  if (auto error = add(files.config, sources.config)) return Unexpected{*error};
  if (auto error = add(files.obstacles, sources.obstacles)) return Unexpected{*error};

  const auto missing = [](const std::string& path, const char* what, const char* expected) {
    return Unexpected{InputError{path, 1, wrong_part(what), expected}};
  };
  if (sources.map && !sources.files[*sources.map].map) {
    return missing(*files.map, "map", "a <map> or a MovingAI map");
  }
  if (sources.task && !sources.files[*sources.task].agents) {
    return missing(*files.task, "agents", "<agents> or a MovingAI scenario");
  }
  if (sources.config && !sources.files[*sources.config].options) {
    return missing(*files.config, "options", "<algorithm>");
  }
  if (sources.obstacles && !sources.files[*sources.obstacles].obstacles) {
    return missing(*files.obstacles, "obstacles", "<dynamicobstacles>");
  }
  return sources;
}

/// Gives robots of a file without bodies the one that was asked for.
std::optional<InputError> set_bodies(InstanceParts& parts, const InstanceFiles& files) {
  if (!files.radius_cells && !files.speed_cells_per_s) return std::nullopt;
  if (parts.states_bodies) {
    return InputError{parts.file_name, parts.agents->line, "robots with a radius and speed of their own",
                      "a MovingAI scenario where a radius or speed is given besides"};
  }
  for (Agent& agent : parts.agents->items) {
    agent.radius_cells = files.radius_cells.value_or(agent.radius_cells);
    agent.speed_cells_per_s = files.speed_cells_per_s.value_or(agent.speed_cells_per_s);
  }
  return std::nullopt;
}

/// Cuts the list to the first `wanted` agents.
std::optional<InputError> keep_first(LinedList<Agent>& agents, std::size_t wanted,
                                     const std::string& file_name) {
  if (wanted > agents.items.size()) {
    return InputError{file_name, agents.line, std::to_string(agents.items.size()) + " agents",
                      "the " + std::to_string(wanted) + " that are asked for"};
  }
  agents.items.resize(wanted);
  agents.lines.resize(wanted);
  return std::nullopt;
}

/// The line of the agent or obstacle that breaks a rule.
InputError with_line(const InstanceError& error, const InstanceParts& agents,
                     const InstanceParts* obstacles) {
  // An obstacle may break a rule together with an agent, which is where it may be.
  if (error.obstacle && obstacles && *error.obstacle < obstacles->obstacles->lines.size()) {
    return {obstacles->file_name, obstacles->obstacles->lines[*error.obstacle], error.what, error.expected};
  }
  if (error.agent && *error.agent < agents.agents->lines.size()) {
    return {agents.file_name, agents.agents->lines[*error.agent], error.what, error.expected};
  }
  return {agents.file_name, agents.agents->line, error.what, error.expected};
}

void add_warnings(InstanceParts& parts, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), parts.warnings.begin(), parts.warnings.end());
}

}  // namespace

Input<LoadedInstance> load_instance(const InstanceFiles& files) {
  Input<Sources> read = read_sources(files);
  if (!read) return Unexpected{read.error()};
  Sources& sources = *read;
  const std::string some_name = sources.files.empty() ? std::string() : sources.files.front().file_name;

  InstanceParts* const agents =
      choose(sources, sources.task, [](const InstanceParts& parts) { return parts.agents.has_value(); });
  if (!agents) {
    return Unexpected{
        InputError{some_name, sources.files.empty() ? 0 : 1, "no agents", "<agents> or a MovingAI scenario"}};
  }
  InstanceParts* const obstacles = choose(
      sources, sources.obstacles, [](const InstanceParts& parts) { return parts.obstacles.has_value(); });
  InstanceParts* const options =
      choose(sources, sources.config, [](const InstanceParts& parts) { return parts.options.has_value(); });

  LoadedInstance loaded;
  for (InstanceParts& parts : sources.files) add_warnings(parts, loaded.warnings);
  InstanceParts* map =
      choose(sources, sources.map, [](const InstanceParts& parts) { return parts.map.has_value(); });
  std::optional<InstanceParts> map_of_scenario;
  if (!map && agents->map_reference) {
    Input<InstanceParts> found = read_map_of_scenario(*agents);
    if (!found) return Unexpected{found.error()};
    if (!found->map) {
      return Unexpected{InputError{found->file_name, 1, wrong_part("map"), "a <map> or a MovingAI map"}};
    }
    map_of_scenario = std::move(*found);
    map = &*map_of_scenario;
    add_warnings(*map, loaded.warnings);
  }
  if (!map) return Unexpected{InputError{some_name, 1, "no map", "a <map> or a MovingAI map"}};

  Instance& instance = loaded.instance;
  instance.map = std::move(map->map->map);
  if (const std::optional<MapReference>& reference = agents->map_reference) {
    if (reference->width != instance.map.width() || reference->height != instance.map.height()) {
      const auto size = [](std::int64_t width, std::int64_t height) {
        return std::to_string(width) + " x " + std::to_string(height);
      };
      return Unexpected{InputError{agents->file_name, reference->line,
                                   "a scenario for a map of " + size(reference->width, reference->height),
                                   "the size of the map in " + map->file_name + ", " +
                                       size(instance.map.width(), instance.map.height())}};
    }
  }
  if (auto error = set_bodies(*agents, files)) return Unexpected{*error};
  if (files.agents) {
    if (auto error = keep_first(*agents->agents, *files.agents, agents->file_name)) return Unexpected{*error};
  }
  instance.agents = std::move(agents->agents->items);
  if (obstacles) instance.obstacles = std::move(obstacles->obstacles->items);
  if (options) loaded.options = options->options->options;

  if (const auto error = find_error(instance)) return Unexpected{with_line(*error, *agents, obstacles)};
  if (!files.allow_unreachable) {
    if (const auto error = find_unreachable_goal(instance)) {
      return Unexpected{with_line(*error, *agents, obstacles)};
    }
  }
  return loaded;
}

std::string kind_without_robots(const std::string& path) {
  const Input<std::string> text = read_text(path);
  if (!text) return "";
  if (const InstanceFormat* const format = format_of(*text)) {
    return format->without_robots != nullptr ? format->without_robots(*text, path) : "";
  }
  return text->empty() ? "an empty file" : "neither XML nor a MovingAI file";
}

Input<GridMap> load_map(const std::string& path) {
  Input<InstanceParts> parts = read_parts(path);
  if (!parts) return Unexpected{parts.error()};
  if (!parts->map) return Unexpected{InputError{path, 1, wrong_part("map"), "a <map> or a MovingAI map"}};
  return std::move(parts->map->map);
}

}  // namespace sipplab
