#include "bench/temporary_folder.hpp"

#include <stdlib.h>

#include <cstdlib>
#include <system_error>
#include <utility>

namespace sipplab::bench {

namespace fs = std::filesystem;

Expected<TemporaryFolder, std::string> TemporaryFolder::make() {
  // Absolute: programs that are given its files run elsewhere. An empty TMPDIR is none.
  std::error_code error;
  fs::path parent = fs::temp_directory_path(error);
  if (!error) parent = fs::absolute(parent, error);
  if (error || parent.empty()) {
    const char* const named = std::getenv("TMPDIR");
    return Unexpected{std::string(named == nullptr ? "/tmp" : named) +
                      ": is no folder, expected one for temporary files (TMPDIR)"};
  }
  std::string pattern = (parent / "sipplab-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    return Unexpected{parent.string() +
                      ": no folder can be made in it, expected a place for temporary files"};
  }
  return TemporaryFolder(pattern);
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

TemporaryFolder& TemporaryFolder::operator=(TemporaryFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace sipplab::bench
