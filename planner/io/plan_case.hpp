// A problem small enough to be read by a person, together with the options to plan
// it with: what generators make, what fuzzers decode, what a failure prints.
#pragma once

#include <iosfwd>

#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"

namespace sipplab {

struct PlanCase {
  Instance instance;
  PlannerOptions options;
};

/// Prints the text of encode_case.
std::ostream& operator<<(std::ostream& out, const PlanCase& plan_case);

}  // namespace sipplab
