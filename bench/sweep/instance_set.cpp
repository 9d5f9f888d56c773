#include "bench/sweep/instance_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "planner/core/try.hpp"
#include "planner/generator/generator.hpp"
#include "planner/io/load_instance.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

PreparedInstance prepare(Instance instance, std::string name) {
  PreparedInstance prepared;
  prepared.row.content_hash = content_hash(instance);
  prepared.row.map_hash = content_hash(Instance{instance.map, {}, {}});
  prepared.row.name = std::move(name);
  prepared.row.robots = static_cast<std::int64_t>(instance.agents.size());
  prepared.row.width_cells = instance.map.width();
  prepared.row.height_cells = instance.map.height();
  prepared.row.blocked_cells = static_cast<std::int64_t>(instance.map.blocked_count());
  prepared.instance = std::move(instance);
  return prepared;
}

/// The value that all robots of the set share, or 0.
double common_value(const InstanceSet& set, double Agent::*member, double without_robots) {
  std::optional<double> common;
  for (const PreparedInstance& prepared : set.instances) {
    for (const Agent& agent : prepared.instance.agents) {
      if (common.value_or(agent.*member) != agent.*member) return 0;
      common = agent.*member;
    }
  }
  return common.value_or(without_robots);
}

bool all_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// The last names of a path, without those that only a machine or a count gives:
/// ../shared/aamas2018/warehouse/128 is aamas2018/warehouse. The same folder has the
/// same name on every machine.
std::string short_name(const fs::path& folder, bool with_number) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::absolute(folder).lexically_normal()) {
    if (!part.empty() && part != "/") parts.push_back(part.string());
  }
  std::string number;
  if (parts.size() > 1 && all_digits(parts.back())) {
    number = parts.back();
    parts.pop_back();
  }
  constexpr std::size_t kNames = 2;
  std::string name;
  for (std::size_t i = parts.size() - std::min(parts.size(), kNames); i < parts.size(); ++i) {
    name += (name.empty() ? "" : "/") + parts[i];
  }
  return with_number && !number.empty() ? name + "/" + number : name;
}

std::vector<fs::path> sorted_entries(const fs::path& folder, bool folders, std::error_code& error) {
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string extension = entry->path().extension().string();
    std::error_code ignored;
    if (folders ? entry->is_directory(ignored)
                : !entry->is_directory(ignored) && (extension == ".xml" || extension == ".scen")) {
      found.push_back(entry->path());
    }
  }
  // Digits compare as numbers: 2.xml before 10.xml.
  std::sort(found.begin(), found.end(),
            [](const fs::path& a, const fs::path& b) { return strverscmp(a.c_str(), b.c_str()) < 0; });
  return found;
}

/// Adds the files of one folder to `sets`, by number of robots.
std::optional<std::string> load_files(const fs::path& folder, const std::vector<fs::path>& files,
                                      std::optional<std::size_t> robots, std::vector<InstanceSet>& sets) {
  std::map<std::size_t, InstanceSet> by_robots;
  for (const fs::path& file : files) {
    InstanceFiles request;
    request.instance = file.string();
    request.agents = robots;
    Input<LoadedInstance> loaded = load_instance(request);
    if (!loaded) return loaded.error().message();
    const std::size_t agents = loaded->instance.agents.size();
    InstanceSet& set = by_robots[agents];
    set.robots = agents;
    set.instances.push_back(
        prepare(std::move(loaded->instance), short_name(folder, true) + "/" + file.filename().string()));
  }
  for (auto& [agents, set] : by_robots) {
    set.environment = short_name(folder, false);
    set.map_spec = "files";
    set.name = short_name(folder, true);
    set.radius_cells = common_value(set, &Agent::radius_cells, kDefaultRadiusCells);
    set.speed_cells_per_s = common_value(set, &Agent::speed_cells_per_s, kDefaultSpeedCellsPerS);
    sets.push_back(std::move(set));
  }
  return std::nullopt;
}

/// " radius:0.3,1.4 speed:1,2 headings obstacles:2"; nothing for robots as they usually are.
std::string words_for(const Bodies& bodies) {
  const Bodies usual;
  std::string words;
  const auto add = [&words](const char* name, const std::vector<double>& values) {
    words += name;
    for (std::size_t i = 0; i < values.size(); ++i) words += (i > 0 ? "," : "") + format_real(values[i]);
  };
  if (bodies.radii_cells != usual.radii_cells) add(" radius:", bodies.radii_cells);
  if (bodies.speeds_cells_per_s != usual.speeds_cells_per_s) add(" speed:", bodies.speeds_cells_per_s);
  if (bodies.headings) words += " headings";
  if (bodies.obstacles > 0) words += fmt::format(" obstacles:{}", bodies.obstacles);
  return words;
}

}  // namespace

InstanceSet single_instance_set(std::string environment, Instance instance) {
  InstanceSet set;
  set.map_spec = environment;
  set.name = environment;
  set.robots = instance.agents.size();
  set.instances.push_back(prepare(std::move(instance), environment));
  set.environment = std::move(environment);
  set.radius_cells = common_value(set, &Agent::radius_cells, kDefaultRadiusCells);
  set.speed_cells_per_s = common_value(set, &Agent::speed_cells_per_s, kDefaultSpeedCellsPerS);
  return set;
}

Expected<InstanceSet, std::string> generate_set(const std::string& map_spec, std::size_t robots,
                                                std::uint64_t count, std::uint64_t seed,
                                                const Bodies& bodies) {
  const auto spec = SIPPLAB_TRY(parse_map_spec(map_spec));
  InstanceSet set;
  set.environment = spec.kind == MapSpec::Kind::kFile ? fs::path(spec.path).stem().string()
                                                      : map_spec.substr(0, map_spec.find(':'));
  set.map_spec = spec.kind == MapSpec::Kind::kFile ? fs::path(spec.path).filename().string() : map_spec;
  const std::string body_words = words_for(bodies);
  if (!body_words.empty()) set.environment += "-mixed";
  set.name = fmt::format("generated/seed:{}{}", seed, body_words);
  set.robots = robots;
  for (std::uint64_t index = 0; index < count; ++index) {
    GeneratorOptions options;
    options.agents = robots;
    options.seed = seed;
    options.index = index;
    options.radii_cells = bodies.radii_cells;
    options.speeds_cells_per_s = bodies.speeds_cells_per_s;
    options.headings = bodies.headings;
    options.obstacles = bodies.obstacles;
    auto instance = SIPPLAB_TRY(generate_instance(spec, options));
    set.instances.push_back(prepare(
        std::move(instance),
        fmt::format("{} agents:{} seed:{} index:{}{}", set.map_spec, robots, seed, index, body_words)));
  }
  set.radius_cells = common_value(set, &Agent::radius_cells, kDefaultRadiusCells);
  set.speed_cells_per_s = common_value(set, &Agent::speed_cells_per_s, kDefaultSpeedCellsPerS);
  return set;
}

Expected<std::vector<InstanceSet>, std::string> load_sets(const std::string& folder,
                                                          const std::vector<std::size_t>& robots,
                                                          std::optional<std::uint64_t> count) {
  std::error_code error;
  std::vector<fs::path> folders = {fs::path(folder)};
  if (sorted_entries(folder, false, error).empty() && !error) folders = sorted_entries(folder, true, error);
  if (error) return Unexpected{folder + ": " + error.message() + ", expected a folder of instances"};

  std::vector<std::optional<std::size_t>> wanted(robots.begin(), robots.end());
  if (wanted.empty()) wanted.push_back(std::nullopt);
  std::vector<InstanceSet> sets;
  for (const fs::path& part : folders) {
    std::vector<fs::path> files = sorted_entries(part, false, error);
    if (count && files.size() > *count) files.resize(*count);
    for (const std::optional<std::size_t> number : wanted) {
      if (auto line = load_files(part, files, number, sets)) return Unexpected{std::move(*line)};
    }
  }
  if (sets.empty()) return Unexpected{folder + ": no instances in it, expected .xml or .scen files"};
  return sets;
}

}  // namespace sipplab::bench
