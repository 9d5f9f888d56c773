// Where a run comes from: commit, machine and build.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "db/records.hpp"

namespace sipplab::bench {

/// The source tree that the program was built from.
struct SourceInfo {
  std::optional<db::CommitInfo> commit;  ///< none outside a checkout
  std::string branch;
  bool dirty = false;
};

/// Read from the file that the build leaves beside the program. It is a file of its
/// own so that a commit which changes no code gives a byte-identical program.
SourceInfo source_info();

/// The same of another program.
SourceInfo source_info(const std::filesystem::path& program);

/// Names this machine where a host name does not: for containers, which have one each.
inline constexpr const char* kMachineVariable = "SIPPLAB_MACHINE";
db::MachineInfo machine_info();

/// Compiler, flags and the hash of the program that runs.
db::BuildInfo build_info(const SourceInfo& source);

/// All of it for the program that runs.
db::RunOrigin run_origin();

/// What makes this build's times worthless ("assertions are on"); empty for a build to
/// measure with.
std::string unfit_for_timing();

/// A UUID (version 8) that is the same for the same text.
std::string text_uuid(std::string_view text);

/// 16 hexadecimal digits that tell texts apart.
std::string text_digest(std::string_view text);

}  // namespace sipplab::bench
