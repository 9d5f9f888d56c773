// Claim: whatever files an instance is asked from (whole, or split into map, task, config and
// obstacles, in any mixture of formats), loading ends with an instance that keeps the rules or
// with one line; what is loaded can be written, loaded again and drawn.
//
// An input is a text in parts. A line "=== ROLE" begins the file for that role: instance,
// map, task, config, obstacles. "=== agents N" asks for the first N robots.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/svg.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Pictures of larger maps take longer than everything else.
constexpr std::size_t kMostCellsDrawn = 400;

/// A file in memory with a path of its own.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("part", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(file_)) {
    if (file_ < 0) {
      std::perror("memfd_create");
      std::abort();
    }
  }
  const std::string& hold(std::string_view text) {
    // In this sequence, so that its pages are used again.
    const auto size = static_cast<ssize_t>(text.size());
    const bool written = pwrite(file_, text.data(), text.size(), 0) == size && ftruncate(file_, size) == 0;
    if (!written) std::abort();
    return path_;
  }

 private:
  int file_;
  std::string path_;
};

struct Role {
  std::string_view name;
  std::optional<std::string> InstanceFiles::*path;
};
constexpr std::array<Role, 5> kRoles = {{{"instance", &InstanceFiles::instance},
                                         {"map", &InstanceFiles::map},
                                         {"task", &InstanceFiles::task},
                                         {"config", &InstanceFiles::config},
                                         {"obstacles", &InstanceFiles::obstacles}}};

void hold_part(std::string_view title, std::string_view text, InstanceFiles& files) {
  static std::array<MemoryFile, kRoles.size()> memory;
  for (std::size_t i = 0; i < kRoles.size(); ++i) {
    if (title == kRoles[i].name) files.*kRoles[i].path = memory[i].hold(text);
  }
  constexpr std::string_view kAgents = "agents ";
  if (title.substr(0, kAgents.size()) == kAgents) {
    std::size_t wanted = 0;
    title.remove_prefix(kAgents.size());
    std::from_chars(title.data(), title.data() + title.size(), wanted);
    files.agents = wanted;
  }
}

InstanceFiles files_of(std::string_view text) {
  constexpr std::string_view kMark = "=== ";
  InstanceFiles files;
  files.allow_unreachable = text.size() % 2 == 0;
  while (text.substr(0, kMark.size()) == kMark) {
    const std::size_t title_end = std::min(text.find('\n'), text.size());
    const std::string_view title = text.substr(kMark.size(), title_end - kMark.size());
    text.remove_prefix(std::min(title_end + 1, text.size()));
    const std::size_t next = text.substr(0, kMark.size()) == kMark ? 0 : text.find("\n=== ");
    const std::size_t end = next == std::string_view::npos ? text.size() : next == 0 ? 0 : next + 1;
    hold_part(title, text.substr(0, end), files);
    text.remove_prefix(end);
  }
  return files;
}

/// Written in parts, the instance loads as it was and the options are the same.
void check_parts(const Instance& instance, const PlannerOptions& options) {
  static std::array<MemoryFile, 4> written;
  InstanceFiles parts;
  parts.task = written[0].hold(write_task_xml(instance));
  parts.map = written[1].hold(write_map_xml(instance.map));
  parts.config = written[2].hold(write_config_xml(options, "folder", "file"));
  if (!instance.obstacles.empty()) parts.obstacles = written[3].hold(write_obstacles_xml(instance));
  parts.allow_unreachable = true;
  const auto joined = load_instance(parts);
  fuzz::require(Claim::kReadsBackEqual, joined && joined->instance == instance,
                "an instance in parts loads as another");
  fuzz::require(Claim::kReadsBackEqual, joined->options.applied_to({}) == options,
                "a configuration reads as another");
}

void check_loaded(const LoadedInstance& loaded) {
  for (const std::string& warning : loaded.warnings) fuzz::check_warning(warning);
  fuzz::require(Claim::kReadsBackEqual, !find_error(loaded.instance), "an instance that breaks a rule");
  static MemoryFile written;
  InstanceFiles again;
  again.instance = written.hold(write_instance_xml(loaded.instance));
  again.allow_unreachable = true;
  const auto reloaded = load_instance(again);
  fuzz::require(Claim::kReadsBackEqual, reloaded && reloaded->instance == loaded.instance,
                "an instance loads again as another");
  fuzz::require(Claim::kReadsBackEqual, content_hash(reloaded->instance) == content_hash(loaded.instance),
                "equal instances, different hashes");
  check_parts(loaded.instance, loaded.options.applied_to({}));
  if (loaded.instance.map.cell_count() <= kMostCellsDrawn) draw_svg(loaded.instance, {});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const InstanceFiles files = files_of(text);
  const auto loaded = load_instance(files);
  fuzz::count(loaded ? fuzz::Event::kAccepted : fuzz::Event::kRefused);
  if (loaded) {
    check_loaded(*loaded);
  } else {
    fuzz::check_refusal(loaded.error(), text);
  }
  if (files.map) static_cast<void>(load_map(*files.map));
  return 0;
}
