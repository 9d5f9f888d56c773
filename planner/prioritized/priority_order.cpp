#include "planner/prioritized/priority_order.hpp"

#include <algorithm>
#include <numeric>

#include "sipplab/error.hpp"

namespace sipplab {

PriorityOrder initial_order(InitialOrder kind, const std::vector<double>& lengths_s, Random& random) {
  PriorityOrder order(lengths_s.size());
  std::iota(order.begin(), order.end(), AgentIndex{0});
  const auto by_length = [&](AgentIndex a, AgentIndex b) { return lengths_s[a] < lengths_s[b]; };
  switch (kind) {
    case InitialOrder::kFifo:
      break;
    case InitialOrder::kShortestFirst:
      std::stable_sort(order.begin(), order.end(), by_length);
      break;
    case InitialOrder::kLongestFirst:
      std::stable_sort(order.begin(), order.end(),
                       [&](AgentIndex a, AgentIndex b) { return by_length(b, a); });
      break;
    case InitialOrder::kRandom:
      random.shuffle(order);
      break;
  }
  return order;
}

std::size_t OrderSequence::Hash::operator()(const PriorityOrder& order) const {
  std::size_t hash = 0xcbf29ce484222325u;  // FNV-1a over positions
  for (const AgentIndex agent : order) hash = (hash ^ agent) * 0x100000001b3u;
  return hash;
}

OrderSequence::OrderSequence(Rescheduling rescheduling, PriorityOrder first, Random random)
    : rescheduling_(rescheduling), current_(std::move(first)), random_(random) {
  tried_.insert(current_);
}

bool OrderSequence::all_orders_tried() const {
  std::size_t orders = 1;
  for (std::size_t n = 2; n <= current_.size(); ++n) {
    orders *= n;
    if (orders > tried_.size()) return false;
  }
  return true;
}

bool OrderSequence::advance(AgentIndex failed) {
  switch (rescheduling_) {
    case Rescheduling::kNone:
    case Rescheduling::kEjection:  // repairs its plan instead, see ejection.hpp
      return false;
    case Rescheduling::kDeterministic: {
      const auto place = std::find(current_.begin(), current_.end(), failed);
      PLANNER_ASSERT(place != current_.end());
      std::rotate(current_.begin(), place, place + 1);
      return tried_.insert(current_).second;
    }
    case Rescheduling::kRandom:
      if (all_orders_tried()) return false;
      do {
        random_.shuffle(current_);
      } while (!tried_.insert(current_).second);
      return true;
  }
  return false;
}

}  // namespace sipplab
