// On which line of a JSON text a value stands: parsed documents do not remember.
#pragma once

#include <string_view>

namespace sipplab {

/// The line, counted from 1, on which the value at `path` begins ("trajectories[3].motions[0].t1");
/// if there is none, the innermost list or object on the way to it. If a key repeats, the last
/// one counts, as in the parsed document.
///
/// REQUIRES: well-formed JSON. O(length of the text).
int json_line(std::string_view text, std::string_view path);

}  // namespace sipplab
