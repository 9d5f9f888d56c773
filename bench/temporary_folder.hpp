// A folder for temporary files.
#pragma once

#include <filesystem>
#include <string>

#include "sipplab/error.hpp"

namespace sipplab::bench {

/// Among the system's temporary files; removed with all that is in it.
class TemporaryFolder {
 public:
  /// Errors: one line, if none can be made.
  static Expected<TemporaryFolder, std::string> make();

  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&& other) noexcept;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;  ///< empty after a move
};

}  // namespace sipplab::bench
