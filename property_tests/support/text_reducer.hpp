// From an input that breaks something to the smallest that still does: cases by what
// case_shrinker offers, any other text by leaving out parts.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace sipplab {

/// Whether the text still breaks what the first one broke.
using StillBreaks = std::function<bool(const std::string& text)>;

struct Reduction {
  std::string text;       ///< the smallest that was found
  std::size_t steps = 0;  ///< times that a smaller one still broke
  std::size_t tries = 0;  ///< texts that were asked about
};

/// Ends when no smaller text breaks, or after max_tries questions. A text that is a case
/// (case_codec.hpp) within the rules stays one.
Reduction reduce_text(const std::string& text, const StillBreaks& still_breaks, std::size_t max_tries);

}  // namespace sipplab
