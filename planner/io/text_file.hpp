// Whole files in and out. Every failure is one line that names the file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "sipplab/error.hpp"

namespace sipplab {

/// Bytes. The largest map (8192 x 8192) takes 134 MB as XML, two characters a
/// cell; twice that leaves room for everything else. Keeps a mistaken path (a disk
/// image, /dev/zero) from filling the memory.
inline constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;

/// The bytes of a regular file or a pipe. Errors: missing, a directory, no
/// permission, larger than kMaxFileBytes.
Input<std::string> read_file(const std::string& path);

/// The same without the byte order mark that some editors put in front of UTF-8.
Input<std::string> read_text(const std::string& path);

/// Writes the whole text or nothing: into a temporary file next to `path` that then
/// takes its place. Devices and pipes are written directly. The error's `what` says
/// why it failed ("no space left on device").
std::optional<InputError> write_file(const std::string& path, std::string_view text);

}  // namespace sipplab
