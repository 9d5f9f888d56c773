// Bad input, as one line: `file:line: what is wrong, expected what`.
#pragma once

#include <string>

#include "planner/core/expected.hpp"

namespace sipplab {

struct InputError {
  std::string file;
  int line = 0;  ///< counted from 1; 0 if no line can be named
  std::string what;
  std::string expected;

  /// "file:line: what, expected what", without line break.
  std::string message() const;
};

template <class T>
using Input = Expected<T, InputError>;

}  // namespace sipplab
