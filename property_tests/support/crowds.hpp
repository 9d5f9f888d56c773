// Robots on most cells of a small map: as full as what LaCAM has to solve, and small enough for an exhaustive
// search.
#pragma once

#include "planner/io/plan_case.hpp"

namespace sipplab {

/// A few cells, and on most of them robots whose goals are among these cells. Notes and classifies the case.
PlanCase any_crowd();

}  // namespace sipplab
