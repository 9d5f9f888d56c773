// A folder for temporary files.
#pragma once

#include <filesystem>

namespace sipplab {

/// Made in $TMPDIR if set, else in memory if the system offers that, else among its
/// temporary files; removed with all that is in it. Ends the program if no folder can
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
