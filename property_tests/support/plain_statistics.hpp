// Statistics by their definition, slowly: what the judges of results are checked against.
#pragma once

#include <cstddef>
#include <vector>

namespace sipplab::bench {

/// Equal but for rounding.
bool close(double a, double b);

/// 0 for no values.
double mean(const std::vector<double>& values);

/// The middle, or the mean of the two in the middle; 0 for no values.
double middle(std::vector<double> values);

/// P(X >= k) of n fair coins, in the order of Pascal's triangle.
double at_least(std::size_t k, std::size_t n);

/// Holm's p values by closed testing: a hypothesis stands as firmly as the least firm set that holds it, each
/// set tested by the smallest of its p values times their number. O(2^n).
std::vector<double> by_closed_testing(const std::vector<double>& p_values);

}  // namespace sipplab::bench
