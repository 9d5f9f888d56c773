// A folder that vanishes; see scratch_folder.hpp.
#include "property_tests/support/scratch_folder.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <system_error>

namespace sipplab {
namespace {

/// In memory if the system has a place for that: a database that is made a thousand
/// times waits for the disk and for nothing else.
std::filesystem::path parent_folder() {
  constexpr const char* kInMemory = "/dev/shm";
  if (getenv("TMPDIR") == nullptr && access(kInMemory, W_OK | X_OK) == 0) return kInMemory;
  return std::filesystem::temp_directory_path();
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::string pattern = (parent_folder() / "sipplab-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    std::perror(pattern.c_str());
    std::abort();
  }
  path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace sipplab
