// How counterexamples show values of the planner.
#pragma once

#include <ostream>

#include "planner/validator/closest_approach.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"

namespace sipplab {

std::ostream& operator<<(std::ostream& out, const Instance& instance);
std::ostream& operator<<(std::ostream& out, const GridMap& map);
std::ostream& operator<<(std::ostream& out, const OpenInterval& span);
std::ostream& operator<<(std::ostream& out, Fraction fraction);

// rapidcheck finds these before it looks for operator<<.
void showValue(const Objective& objective, std::ostream& out);
void showValue(const LinearMotion& motion, std::ostream& out);

}  // namespace sipplab
