// How tables show which options a plan was made with.
#pragma once

#include <string>

#include "planner/options/option_table.hpp"

namespace sipplab {

/// What differs from the defaults: "sipplab", "sipplab connectedness:3 weight:1.05". Not part of it:
/// time limit, limits on expansions and restarts, seed, start-safe interval, order and re-scheduling.
std::string label_of(const PlannerOptions& options, OptionRows rows = option_rows());

}  // namespace sipplab
