// Priority orders: the first one, and the next one after a robot has failed.
#pragma once

#include <optional>
#include <unordered_set>
#include <vector>

#include "planner/core/random.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {

/// The order of the first try. `lengths_s` holds a lower bound on each agent's travel
/// time. Ties by input position. O(n log n).
PriorityOrder initial_order(InitialOrder kind, const std::vector<double>& lengths_s, Random& random);

/// Chooses the orders to try, each at most once. [AY18], section 4.
class OrderSequence {
 public:
  /// `first` counts as tried.
  OrderSequence(Rescheduling rescheduling, PriorityOrder first, Random random);

  const PriorityOrder& current() const { return current_; }

  /// Moves on to the order to try after `failed` found no trajectory:
  ///  (1) none: there is no next order;
  ///  (2) deterministic: `failed` goes to the front, the others keep their order; none if that order was
  ///      tried before;
  ///  (3) random: a uniform draw from the orders not tried yet; none if all were.
  /// False if there is no next order.
  bool advance(AgentIndex failed);

 private:
  struct Hash {
    std::size_t operator()(const PriorityOrder& order) const;
  };
  bool all_orders_tried() const;

  Rescheduling rescheduling_;
  PriorityOrder current_;
  Random random_;
  std::unordered_set<PriorityOrder, Hash> tried_;
};

}  // namespace sipplab
