// Bad input as one line: see error.hpp.
#include "sipplab/error.hpp"

#include <algorithm>

namespace sipplab {

std::string InputError::message() const {
  std::string text = file;
  if (line > 0) text += (text.empty() ? "line " : ":") + std::to_string(line);
  if (!text.empty()) text += ": ";
  text += what;
  if (!expected.empty()) text += ", expected " + expected;
  // Names of files and values of attributes may hold anything, line breaks included.
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

}  // namespace sipplab
