// How often the gate is wrong on this machine: comparisons made of pairs that calibrations measured, drawn
// again and judged like any other.
#pragma once

#include <vector>

#include "bench/gate/comparison.hpp"

namespace sipplab::bench {

/// A row of times and its pairs of all calibrations, log ratios in the order in which they were measured.
struct MeasuredRow {
  Difference row;  ///< with its floor
  std::vector<double> pairs;
};

/// Draws pairs in blocks, since what disturbs a machine lasts, the same ones for all rows, and lets base and
/// head of a block change places. All rows have the same number of pairs, at least one.
ErrorRate error_rate(const std::vector<MeasuredRow>& rows, const Planted& planted, const GateRequest& request,
                     std::size_t comparisons);

/// Of equal builds; of one that is slower everywhere, by what can be seen over all cells; and of one that is
/// slower in the noisiest cell, by what can be seen there. Empty without calibrations.
std::vector<ErrorRate> error_rates(const GateRequest& request, const GateCases& cases,
                                   const std::vector<db::GateNoise>& noise, const GateResult& result);

}  // namespace sipplab::bench
