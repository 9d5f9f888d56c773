// Start-safe intervals of a plan that was made without an order.
#pragma once

#include <vector>

#include "planner/retime/exact_time.hpp"
#include "planner/retime/visits.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// A priority order, and for how long the guarantee of start-safe intervals holds with it.
struct StartOrder {
  std::vector<AgentIndex> order;
  double kept_s = 0;
};

/// A robot that crosses the start of another one needs the lower priority of the two. The order that
/// keeps the guarantee the longest: in [0, kept_s], kept_s <= wanted_s, no robot comes too near
/// the start of one of lower priority; kept_s < wanted_s only if no order keeps it any
/// longer. Of such orders the one that comes first in the order of input.
/// O((robots + crossings) log(crossings)).
///
/// REQUIRES: wanted_s >= 0, infinity included: then goals on starts are pardoned as
/// PlannerOptions says, if that keeps the guarantee for ever. Robots are equally fast.
StartOrder longest_kept_order(const Instance& instance, const Visits& visits,
                              const std::vector<double>& arrivals_s, double wanted_s);

}  // namespace sipplab
