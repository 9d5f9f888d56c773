// The validator's verdict as an assertion of rapidcheck.
#pragma once

#include <rapidcheck.h>

#include "sipplab/validator.hpp"

namespace sipplab {

inline void assert_valid(const Instance& instance, const Solution& solution,
                         const ValidationOptions& options) {
  const ValidationReport report = validate(instance, solution, options);
  for (const Violation& violation : report.violations) RC_LOG() << violation.message << '\n';
  RC_ASSERT(report.valid());
}

}  // namespace sipplab
