// Many tests at once.
#pragma once

#include <vector>

namespace sipplab::bench {

/// Holm: each p value as it counts among all of them, in their order.
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace sipplab::bench
