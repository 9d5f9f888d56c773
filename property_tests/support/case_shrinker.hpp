// Simpler cases: what a person would try first when looking for the cause of a
// failure.
#pragma once

#include <vector>

#include "planner/io/plan_case.hpp"

namespace sipplab {

/// Cases that are simpler than this one by one step, the boldest first: fewer
/// robots, fewer obstacles, a smaller map, fewer blocked cells, default sizes and
/// speeds, plainer options. Each keeps the rules of find_error.
std::vector<PlanCase> simpler_cases(const PlanCase& plan_case);

}  // namespace sipplab
