// A folder for files that nobody needs afterwards.
#pragma once

#include <filesystem>

namespace sipplab {

/// Made in $TMPDIR if set, else in memory where the system offers that, else among its
/// temporary files; removed with all that is in it. Ends the program where no folder can
/// be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace sipplab
