#include "bench/sweep/instance_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "bench/sweep/run_info.hpp"
#include "planner/core/try.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"

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

/// As the history knows a file that is no instance it can hold: by its bytes.
PreparedInstance broken_instance(const fs::path& file, std::string name, std::string line) {
  const Input<std::string> text = read_file(file.string());
  PreparedInstance prepared;
  prepared.row.content_hash = text_digest(text ? *text : name);
  prepared.row.map_hash = prepared.row.content_hash;
  prepared.row.name = std::move(name);
  prepared.broken = std::move(line);
  return prepared;
}

/// The files of one folder, and what is to be said of them.
class FolderReader {
 public:
  FolderReader(const fs::path& folder, const FolderRequest& request, LoadedSets& loaded)
      : folder_(folder), request_(request), loaded_(loaded) {}

  /// The files that may be instances.
  std::vector<fs::path> instances(std::vector<fs::path> files) {
    std::erase_if(files, [this](const fs::path& file) {
      const std::string kind = kind_without_robots(file.string());
      if (!kind.empty()) say(fmt::format("{}: {}, expected an instance; left out", file.string(), kind));
      return !kind.empty();
    });
    if (request_.count && files.size() > *request_.count) files.resize(*request_.count);
    return files;
  }

  /// Adds a set for each number of robots, all with the same `robots` where that is given.
  void add_sets(const std::vector<fs::path>& files, std::optional<std::size_t> robots) {
    std::map<std::size_t, InstanceSet> by_robots;
    std::vector<PreparedInstance> broken;
    for (const fs::path& file : files) {
      const std::string name = short_name(folder_, true) + "/" + file.filename().string();
      InstanceFiles request;
      request.instance = file.string();
      request.agents = robots;
      request.radius_cells = request_.radius_cells;
      request.speed_cells_per_s = request_.speed_cells_per_s;
      Input<LoadedInstance> instance = load_instance(request);
      if (!instance) {
        broken.push_back(broken_instance(file, name, instance.error().message()));
        continue;
      }
      PreparedInstance prepared = prepare(std::move(instance->instance), name);
      note_equal(prepared);
      InstanceSet& set = by_robots[prepared.instance.agents.size()];
      set.robots = prepared.instance.agents.size();
      set.instances.push_back(std::move(prepared));
    }
    for (PreparedInstance& instance : broken) place(std::move(instance), by_robots);
    for (auto& [agents, set] : by_robots) {
      set.environment = short_name(folder_, false);
      set.map_spec = "files";
      set.name = short_name(folder_, true);
      set.radius_cells = common_value(set, &Agent::radius_cells, kDefaultRadiusCells);
      set.speed_cells_per_s = common_value(set, &Agent::speed_cells_per_s, kDefaultSpeedCellsPerS);
      loaded_.sets.push_back(std::move(set));
    }
  }

  /// The first file that could not be read, and, where the request is strict, the first thing said at all.
  const std::string& error() const { return error_; }

 private:
  void say(const std::string& line) {
    if (request_.strict && error_.empty()) error_ = line;
    loaded_.notes.push_back(line);
  }
  void note_equal(const PreparedInstance& prepared) {
    const auto [known, is_new] = seen_.emplace(prepared.row.content_hash, prepared.row.name);
    if (!is_new && known->second != prepared.row.name) {
      say(fmt::format("{}: the same instance as {}", prepared.row.name, known->second));
    }
  }
  /// Into the set with most instances; an error where there is none.
  void place(PreparedInstance broken, std::map<std::size_t, InstanceSet>& by_robots) {
    if (by_robots.empty() && error_.empty()) error_ = broken.broken;
    say(broken.broken);
    const auto largest = std::max_element(
        by_robots.begin(), by_robots.end(),
        [](const auto& a, const auto& b) { return a.second.instances.size() < b.second.instances.size(); });
    if (largest == by_robots.end()) return;
    broken.row.robots = static_cast<std::int64_t>(largest->first);
    largest->second.instances.push_back(std::move(broken));
  }

  const fs::path& folder_;
  const FolderRequest& request_;
  LoadedSets& loaded_;
  std::map<std::string, std::string> seen_;  ///< name by content
  std::string error_;
};

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

Expected<LoadedSets, std::string> load_sets(const std::string& folder, const FolderRequest& request) {
  std::error_code error;
  std::vector<fs::path> folders = {fs::path(folder)};
  if (sorted_entries(folder, false, error).empty() && !error) folders = sorted_entries(folder, true, error);
  if (error) return Unexpected{folder + ": " + error.message() + ", expected a folder of instances"};

  std::vector<std::optional<std::size_t>> wanted(request.robots.begin(), request.robots.end());
  if (wanted.empty()) wanted.push_back(std::nullopt);
  LoadedSets loaded;
  for (const fs::path& part : folders) {
    FolderReader reader(part, request, loaded);
    const std::vector<fs::path> files = reader.instances(sorted_entries(part, false, error));
    for (const std::optional<std::size_t> number : wanted) reader.add_sets(files, number);
    if (!reader.error().empty()) return Unexpected{reader.error()};
  }
  if (loaded.sets.empty()) {
    return Unexpected{loaded.notes.empty() ? folder + ": no instances in it, expected .xml or .scen files"
                                           : loaded.notes.front()};
  }
  return loaded;
}

}  // namespace sipplab::bench
