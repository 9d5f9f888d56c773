// In which format a picture is written: the name of its file says it, for every command.
#pragma once

#include <optional>
#include <string>

#include "sipplab/error.hpp"

namespace sipplab::bench {

enum class PictureFormat {
  kSvg,        ///< on a white page of its own
  kInlineSvg,  ///< within an HTML page, whose colour of text it takes
  kPdf,
};

/// .svg or .pdf by the name of a file; one line for another one. A device, a pipe or /dev/stdout gets SVG.
Expected<PictureFormat, std::string> picture_format(const std::string& file);

/// One line if the file is not called .svg, else none: pictures of plans are SVG alone.
std::optional<std::string> find_plan_picture_error(const std::string& file);

}  // namespace sipplab::bench
