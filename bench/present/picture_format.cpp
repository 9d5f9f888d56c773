#include "bench/present/picture_format.hpp"

#include <filesystem>
#include <system_error>

namespace sipplab::bench {
namespace {

/// /dev/stdout, or what a shell puts in the place of >(...): there is no name to go by, wherever it leads.
bool is_stream(const std::string& file) {
  namespace fs = std::filesystem;
  for (const char* names : {"/dev/std", "/dev/fd/", "/proc/self/fd/"}) {
    if (file.starts_with(names)) return true;
  }
  std::error_code ignored;
  const fs::file_type type = fs::status(file, ignored).type();
  return type == fs::file_type::character || type == fs::file_type::fifo;
}

}  // namespace

Expected<PictureFormat, std::string> picture_format(const std::string& file) {
  if (file.ends_with(".svg") || is_stream(file)) return PictureFormat::kSvg;
  if (file.ends_with(".pdf")) return PictureFormat::kPdf;
  return Unexpected{file + ": no picture, expected a name that ends in .svg or .pdf"};
}

std::optional<std::string> find_plan_picture_error(const std::string& file) {
  const auto format = picture_format(file);
  if (format && *format == PictureFormat::kSvg) return std::nullopt;
  return file + (format ? ": pictures of plans are SVG, expected a name that ends in .svg"
                        : ": no picture, expected a name that ends in .svg");
}

}  // namespace sipplab::bench
