// Inputs of targets that plan: the text of a case (planner/io/case_codec.hpp).
// case_mutator_hooks.cpp gives such a target its mutator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "planner/io/plan_case.hpp"

namespace sipplab::fuzz {

/// The case, if the text is one, keeps the rules of instances and is small enough to be
/// planned a thousand times a second. Its limits are cut to what a mutated case may cost.
/// Counts what the input was, and checks that its text is read back.
std::optional<PlanCase> read_case(const std::uint8_t* data, std::size_t size);

}  // namespace sipplab::fuzz
