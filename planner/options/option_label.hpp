// How tables show which options a plan was made with.
#pragma once

#include <string>

#include "planner/options/option_table.hpp"

namespace sipplab {

/// What differs from the defaults: "sipplab", "sipplab connectedness:3 weight:1.05". Limits, seeds and what
/// tables tell beside it (start-safe interval, order, re-scheduling) are no part of it.
std::string label_of(const PlannerOptions& options, OptionRows rows = option_rows());

}  // namespace sipplab
