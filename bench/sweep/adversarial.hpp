// Small cases that are hard for their size, found by performance fuzzing: the files of
// bench/adversarial/, which the program carries with it.
#pragma once

#include <span>
#include <string_view>

namespace sipplab::bench {

struct AdversarialCase {
  std::string_view name;  ///< "01"
  std::string_view text;  ///< as planner/io/case_codec.hpp reads it
};

std::span<const AdversarialCase> adversarial_cases();

}  // namespace sipplab::bench
