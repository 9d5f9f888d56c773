// sipplab generate: seeded instances as files. Instance K of a seed is the same,
// whatever the count.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::cli {
namespace {

/// More files than this in one folder are a slip of the finger.
constexpr std::uint64_t kMaxInstances = 100'000;

/// More of them would be a wall.
constexpr std::uint64_t kMaxObstacles = 1'000;

struct GenerateArguments {
  std::string map = "warehouse";
  std::uint64_t agents = 0;
  std::uint64_t count = 1;
  std::uint64_t seed = 1;
  std::vector<std::string> radii;
  std::vector<std::string> speeds;
  std::vector<std::string> rotation_speeds;
  bool headings = false;
  std::uint64_t obstacles = 0;
  std::string format = "xml";
  std::string folder;
  bool json = false;
};

struct File {
  std::string path;
  std::string text;
};

std::vector<File> files_of(const GenerateArguments& arguments, const Instance& instance,
                           std::uint64_t index) {
  const std::filesystem::path stem = std::filesystem::path(arguments.folder) / std::to_string(index);
  if (arguments.format == "xml") return {{stem.string() + ".xml", write_instance_xml(instance)}};
  return {{stem.string() + ".map", write_movingai_map(instance.map)},
          {stem.string() + ".scen", write_movingai_scen(instance, std::to_string(index) + ".map")}};
}

GeneratorOptions generator_options(const GenerateArguments& arguments, std::uint64_t index) {
  GeneratorOptions options;
  options.agents = arguments.agents;
  options.seed = arguments.seed;
  options.index = index;
  if (!arguments.radii.empty()) options.radii_cells = numbers_of(arguments.radii);
  if (!arguments.speeds.empty()) options.speeds_cells_per_s = numbers_of(arguments.speeds);
  if (!arguments.rotation_speeds.empty()) options.rotation_speeds = numbers_of(arguments.rotation_speeds);
  options.headings = arguments.headings;
  options.obstacles = arguments.obstacles;
  return options;
}

/// What was asked for and has no place in a MovingAI map and scenario; empty where all has.
std::string lost_in_movingai(const GenerateArguments& arguments) {
  if (arguments.format != "movingai") return "";
  // One value for all is given back with --radius and --speed when the files are read.
  const auto differ = [](const std::vector<std::string>& values) {
    const std::vector<double> numbers = numbers_of(values);
    return std::any_of(numbers.begin(), numbers.end(),
                       [&](double number) { return number != numbers.front(); });
  };
  if (differ(arguments.radii)) return "several radii";
  if (differ(arguments.speeds)) return "several speeds";
  const std::vector<double> rotation_speeds = numbers_of(arguments.rotation_speeds);
  if (rotation_speeds != std::vector<double>(rotation_speeds.size(), kDefaultRotationSpeed)) {
    return "rotation speeds";
  }
  if (arguments.headings) return "headings";
  return arguments.obstacles > 0 ? "moving obstacles" : "";
}

/// What a scenario does not state, as the flags that say it again.
std::string unwritten_flags(const GenerateArguments& arguments) {
  std::string flags;
  if (arguments.format != "movingai") return flags;
  if (!arguments.radii.empty()) flags += " --radius " + arguments.radii.front();
  if (!arguments.speeds.empty()) flags += " --speed " + arguments.speeds.front();
  return flags;
}

int run_generate(const GenerateArguments& arguments) {
  if (const std::string lost = lost_in_movingai(arguments); !lost.empty()) {
    return bad_usage("--format movingai has no place for " + lost + ", expected --format xml");
  }
  const MapSpec spec = SIPPLAB_TRY_OR(bad_usage, parse_map_spec(arguments.map));

  // Once without writing, so that an impossible wish leaves no files behind.
  for (std::uint64_t index = 0; index < arguments.count; ++index) {
    SIPPLAB_TRY_OR(bad_usage, generate_instance(spec, generator_options(arguments, index)));
  }

  std::error_code error;
  for (std::uint64_t index = 0; spec.kind == MapSpec::Kind::kFile && index < arguments.count; ++index) {
    const auto instance = generate_instance(spec, generator_options(arguments, index));
    for (const File& file : files_of(arguments, *instance, index)) {
      if (!std::filesystem::equivalent(file.path, spec.path, error)) continue;
      return bad_usage("-o and --map: " + file.path + " is the map, expected another folder");
    }
  }
  std::filesystem::create_directories(arguments.folder, error);
  if (error) return bad_usage("cannot make folder " + arguments.folder + ": " + error.message());
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  for (std::uint64_t index = 0; index < arguments.count; ++index) {
    const auto instance = generate_instance(spec, generator_options(arguments, index));
    if (!instance) return fail(kInternalError, "sipplab: internal error: " + instance.error());
    for (const File& file : files_of(arguments, *instance, index)) {
      if (const auto failure = write_file(file.path, file.text)) return fail(failure->message());
      written.push_back(file.path);
    }
  }
  if (arguments.json) {
    nlohmann::ordered_json json;
    json["map"] = arguments.map;
    json["agents"] = arguments.agents;
    json["seed"] = arguments.seed;
    json["files"] = std::move(written);
    print_json(json);
  } else {
    print(fmt::format("{} instance{} of {} robot{} on {} in {}\nsweep them: sipplab bench --instances {}{}\n",
                      arguments.count, arguments.count == 1 ? "" : "s", arguments.agents,
                      arguments.agents == 1 ? "" : "s", arguments.map, arguments.folder, arguments.folder,
                      unwritten_flags(arguments)));
  }
  return kSuccess;
}

}  // namespace

Command add_generate_command(CLI::App& program) {
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command = program.add_subcommand("generate", "make seeded instances");
  command
      ->add_option(
          "--map", arguments->map,
          "empty:WxH, random:WxH:DENSITY, caves:WxH:DENSITY, rooms:WxH:GAP, maze:WxH:GAP, warehouse, "
          "shelves:COLUMNSxROWS:LENGTHxWIDTH:GAP, or a map file")
      ->capture_default_str()
      ->type_name("MAP");
  command->add_option("--agents", arguments->agents, "robots in each instance")
      ->required()
      ->check(CLI::Range(std::size_t{0}, kMostRobots));
  command->add_option("--count", arguments->count, "number of instances")
      ->check(CLI::Range(std::uint64_t{1}, kMaxInstances))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed of maps, starts and goals")
      ->check(CLI::Range(std::uint64_t{0}, kMaxSeed))
      ->capture_default_str();
  add_values(*command, "--radius", arguments->radii, "cells; drawn from these for each robot; default 0.5");
  add_values(*command, "--speed", arguments->speeds, "cells per second; default 1");
  add_values(*command, "--rotation-speed", arguments->rotation_speeds, "half turns per second; default 1");
  command->add_option("--obstacles", arguments->obstacles, "moving obstacles that cross the map")
      ->check(CLI::Range(std::uint64_t{0}, kMaxObstacles))
      ->capture_default_str();
  command->add_flag("--headings", arguments->headings, "draw start and goal headings and rotation speeds");
  command->add_option("--format", arguments->format, "xml, or movingai (.map and .scen)")
      ->check(CLI::IsMember({"xml", "movingai"}))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->folder, "folder to write to, made if missing")
      ->required()
      ->type_name("DIR");
  command->add_flag("--json", arguments->json, "print one JSON document");
  return {command, [arguments] { return run_generate(*arguments); }};
}

}  // namespace sipplab::cli
