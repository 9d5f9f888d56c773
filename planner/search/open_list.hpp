// OPEN: nodes by least f, then greatest g, then first come. Old entries of nodes
// that were improved stay in the heap and are recognised when they come up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "planner/search/sipp_node.hpp"

namespace sipplab {

class OpenList {
 public:
  struct Entry {
    double f;
    double arrival_s;  ///< g when queued: differs from the node's where the entry is stale
    NodeId node;
    std::uint32_t sequence;
  };

  bool empty() const { return heap_.empty(); }

  void clear() {
    heap_.clear();
    pushed_ = 0;
  }

  /// O(log size).
  void push(NodeId node, double f, double arrival_s) {
    heap_.push_back({f, arrival_s, node, pushed_++});
    std::push_heap(heap_.begin(), heap_.end(), comes_after);
  }

  /// O(log size). REQUIRES: !empty().
  Entry pop_min() {
    std::pop_heap(heap_.begin(), heap_.end(), comes_after);
    const Entry least = heap_.back();
    heap_.pop_back();
    return least;
  }

 private:
  static bool comes_after(const Entry& a, const Entry& b) {
    if (a.f != b.f) return a.f > b.f;
    if (a.arrival_s != b.arrival_s) return a.arrival_s < b.arrival_s;
    return a.sequence > b.sequence;
  }

  std::vector<Entry> heap_;
  std::uint32_t pushed_ = 0;
};

}  // namespace sipplab
