// Whole files in and out: see text_file.hpp.
#include "planner/io/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "planner/io/text.hpp"

namespace sipplab {
namespace {

/// What the operating system says, in the middle of a sentence.
std::string reason(int error_number) {
  std::string text = std::generic_category().message(error_number);
  if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z') text[0] = static_cast<char>(text[0] - 'A' + 'a');
  return text;
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (is_open()) ::close(descriptor_);
  }
  bool is_open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  /// 0, or the error number. Some file systems report a full disk only here.
  int close() {
    const int status = ::close(descriptor_);
    descriptor_ = -1;
    return status == 0 ? 0 : errno;
  }

 private:
  int descriptor_;
};

/// 0, or the error number.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

InputError cannot_write(const std::string& path, int error_number) {
  return {path, 0, "cannot be written: " + reason(error_number), ""};
}

std::optional<InputError> write_directly(const std::string& path, std::string_view text) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.is_open()) return cannot_write(path, errno);
  if (const int status = write_all(file.get(), text)) return cannot_write(path, status);
  if (const int status = file.close()) return cannot_write(path, status);
  return std::nullopt;
}

constexpr mode_t kNewFileMode = 0666;  // less what the user's umask takes away
constexpr mode_t kPermissionBits = 07777;

}  // namespace

Input<std::string> read_file(const std::string& path) {
  const auto cannot_read = [&path](int error_number) {
    return Unexpected{InputError{path, 0, "cannot be read: " + reason(error_number), "a readable file"}};
  };
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) return cannot_read(errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return cannot_read(errno);
  if (S_ISDIR(status.st_mode)) return Unexpected{InputError{path, 0, "is a directory", "a file"}};

  const auto too_large = [&path] {
    return Unexpected{
        InputError{path, 0, "is too large", "at most " + std::to_string(kMaxFileBytes) + " bytes"}};
  };
  if (status.st_size > static_cast<off_t>(kMaxFileBytes)) return too_large();
  constexpr std::size_t kChunkBytes = std::size_t{1} << 16;
  std::string text;
  std::size_t used = 0;
  // One byte more than the file is long, so that the end is seen without growing.
  text.resize(std::max(kChunkBytes, static_cast<std::size_t>(status.st_size) + 1));
  while (true) {
    const ssize_t got = ::read(file.get(), text.data() + used, text.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot_read(errno);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
    if (used > kMaxFileBytes) return too_large();
    if (used == text.size()) text.resize(2 * used);
  }
  text.resize(used);
  return text;
}

Input<std::string> read_text(const std::string& path) {
  Input<std::string> text = read_file(path);
  if (text && text->starts_with(kByteOrderMark)) text->erase(0, kByteOrderMark.size());
  return text;
}

std::optional<InputError> write_file(const std::string& path, std::string_view text) {
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return InputError{path, 0, "is a directory", "a file"};
  if (exists && !S_ISREG(status.st_mode)) return write_directly(path, text);
  // The directory alone decides about the renaming; a file that its owner has
  // closed to writing stays as it is.
  if (exists && ::access(path.c_str(), W_OK) != 0) return cannot_write(path, errno);

  // Through symbolic links, so that the link stays and its target changes.
  std::error_code ignored;
  const std::filesystem::path resolved = std::filesystem::canonical(path, ignored);
  const std::string target = ignored ? path : resolved.string();
  const std::string temporary = target + "." + std::to_string(::getpid()) + ".part";
  FileDescriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFileMode));
  if (!file.is_open()) return cannot_write(path, errno);
  int failure = write_all(file.get(), text);
  if (failure == 0 && exists && ::fchmod(file.get(), status.st_mode & kPermissionBits) != 0) failure = errno;
  const int closing = file.close();
  if (failure == 0) failure = closing;
  if (failure == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) failure = errno;
  if (failure == 0) return std::nullopt;
  ::unlink(temporary.c_str());
  return cannot_write(path, failure);
}

}  // namespace sipplab
