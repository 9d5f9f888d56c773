#include "bench/sweep/run_info.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <vector>

// Set for this file alone by bench/CMakeLists.txt.
#ifndef SIPPLAB_BUILD_FLAGS
#error \
    "SIPPLAB_BUILD_FLAGS, SIPPLAB_BUILD_TYPE, SIPPLAB_COMPILER_VERSION and SIPPLAB_SANITIZERS are to be defined"
#endif

namespace sipplab::bench {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";
constexpr std::int64_t kGibibyte = std::int64_t{1} << 30;

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The value of the first "name : value" line of a file under /proc.
std::string proc_value(const char* path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, name.size(), name) != 0) continue;
    const std::size_t value = line.find_first_not_of(" \t:", name.size());
    return value == std::string::npos ? "" : line.substr(value);
  }
  return "";
}

std::string digest_text(XXH64_hash_t digest) { return fmt::format("{:016x}", digest); }

/// text_digest() of this program's file, piece by piece: what a sweep holds in memory, the
/// programs that it starts begin with.
std::string program_hash() {
  std::ifstream file(kThisProgram, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::vector<char> piece(std::size_t{1} << 16);
  bool empty = true;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0) {
    empty = false;
    XXH3_64bits_update(state.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  return empty ? "" : digest_text(XXH3_64bits_digest(state.get()));
}

}  // namespace

SourceInfo source_info() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink(kThisProgram, error);
  return error ? SourceInfo() : source_info(program);
}

SourceInfo source_info(const std::filesystem::path& program) {
  SourceInfo source;
  const nlohmann::json json =
      nlohmann::json::parse(read_text(program.parent_path() / "sipplab-source.json"), nullptr, false);
  if (!json.is_object() || !json.contains("hash")) return source;
  db::CommitInfo commit;
  commit.hash = json.value("hash", "");
  commit.committed_utc = json.value("committed_utc", "");
  commit.subject = json.value("subject", "");
  commit.first_parent = json.value("first_parent", "");
  commit.ancestor_count = json.value("ancestor_count", std::int64_t{0});
  commit.first_parent_count = json.value("first_parent_count", std::int64_t{0});
  std::istringstream later_parents(json.value("later_parents", ""));
  for (std::string hash; later_parents >> hash;) commit.later_parents.push_back(hash);
  source.branch = json.value("branch", "");
  source.dirty = json.value("dirty", false);
  source.commit = std::move(commit);
  return source;
}

db::MachineInfo machine_info() {
  db::MachineInfo machine;
  utsname system = {};
  if (uname(&system) == 0) {
    machine.host = system.nodename;
    machine.kernel = std::string(system.sysname) + " " + system.release;
  }
  machine.cpu_model = proc_value("/proc/cpuinfo", "model name");
  machine.cores = std::max<std::int64_t>(0, sysconf(_SC_NPROCESSORS_ONLN));
  machine.memory_bytes =
      std::max<std::int64_t>(0, sysconf(_SC_PHYS_PAGES)) * std::max<std::int64_t>(0, sysconf(_SC_PAGESIZE));
  // Each container has a host name of its own, and machines of one class differ by some pages.
  if (const char* name = std::getenv(kMachineVariable); name != nullptr && *name != '\0') {
    machine.host = name;
    machine.memory_bytes = (machine.memory_bytes + kGibibyte / 2) / kGibibyte * kGibibyte;
  }
  return machine;
}

db::BuildInfo build_info(const SourceInfo& source) {
  db::BuildInfo build;
#ifdef __clang__
  build.compiler = "clang";
#else
  build.compiler = "gcc";
#endif
  build.compiler_version = SIPPLAB_COMPILER_VERSION;
  build.flags = SIPPLAB_BUILD_FLAGS;
  build.build_type = SIPPLAB_BUILD_TYPE;
#ifdef SIPPLAB_ASSERTIONS
  build.assertions = true;
#endif
  build.sanitizers = SIPPLAB_SANITIZERS;
  build.binary_hash = program_hash();
  build.dirty = source.dirty;
  return build;
}

std::string text_uuid(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  const std::string digits = fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  return fmt::format("{}-{}-8{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 3),
                     digits.substr(15, 3), digits.substr(18, 12));
}

std::string text_digest(std::string_view text) { return digest_text(XXH3_64bits(text.data(), text.size())); }

db::RunOrigin run_origin() {
  const SourceInfo source = source_info();
  return {source.commit, source.branch, machine_info(), build_info(source)};
}

std::string unfit_for_timing() {
  std::string reasons;
  const auto add = [&reasons](const char* reason) {
    reasons += (reasons.empty() ? "" : ", ") + std::string(reason);
  };
#ifdef SIPPLAB_ASSERTIONS
  add("assertions are on");
#endif
#ifndef __OPTIMIZE__
  add("optimisation is off");
#endif
  if (!std::string_view(SIPPLAB_SANITIZERS).empty()) add("sanitizers are on");
  return reasons;
}

}  // namespace sipplab::bench
