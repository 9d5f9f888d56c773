// Texts and numbers that are awkward to write down and read back, and texts with
// something wrong in them.
#pragma once

#include <rapidcheck.h>

#include <string>

namespace sipplab {

/// Valid UTF-8 of a few characters: letters, digits, blanks, line breaks, and what XML,
/// JSON, CSV and SQL give a meaning to. May be empty.
rc::Gen<std::string> any_text();

/// A double from `least` to `most` with all its bits in use, or one of the two.
rc::Gen<double> any_real_between(double least, double most);

/// The text after some mishaps: cut off, bytes replaced, parts left out or repeated, words
/// exchanged, numbers that are out of all bounds.
rc::Gen<std::string> any_damage(const std::string& text);

}  // namespace sipplab
