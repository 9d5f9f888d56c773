#include "property_tests/support/plain_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sipplab::bench {

bool close(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

double mean(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

double at_least(std::size_t k, std::size_t n) {
  std::vector<double> row = {1};
  for (std::size_t coin = 0; coin < n; ++coin) {
    row.push_back(0);
    for (std::size_t i = row.size(); i-- > 1;) row[i] = (row[i] + row[i - 1]) / 2;
    row[0] /= 2;
  }
  return k > n ? 0 : std::accumulate(row.begin() + static_cast<std::ptrdiff_t>(k), row.end(), 0.0);
}

std::vector<double> by_closed_testing(const std::vector<double>& p_values) {
  std::vector<double> adjusted(p_values.size(), 0);
  for (std::size_t set = 1; set < std::size_t{1} << p_values.size(); ++set) {
    double least = 1;
    double size = 0;
    for (std::size_t i = 0; i < p_values.size(); ++i) {
      if ((set >> i & 1U) == 0) continue;
      least = std::min(least, p_values[i]);
      ++size;
    }
    for (std::size_t i = 0; i < p_values.size(); ++i) {
      if ((set >> i & 1U) != 0) adjusted[i] = std::max(adjusted[i], std::min(1.0, size * least));
    }
  }
  return adjusted;
}

}  // namespace sipplab::bench
