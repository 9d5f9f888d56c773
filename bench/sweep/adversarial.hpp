// Small cases that are hard for their size, found by performance fuzzing: the files of
// bench/adversarial/, which the program carries with it.
#pragma once

#include <span>

#include "db/embedded_text.hpp"

namespace sipplab::bench {

/// By name: "01". The text is as planner/io/case_codec.hpp reads it.
std::span<const db::EmbeddedText> adversarial_cases();

}  // namespace sipplab::bench
