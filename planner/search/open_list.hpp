// OPEN: nodes by least f, then greatest g, then first come. Besides settled nodes it
// holds promises: ways to a node whose arrival is only bounded from below so far.
// Entries that were overtaken stay in the heap and are recognised when they come up.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/search/sipp_node.hpp"

namespace sipplab {

class OpenList {
 public:
  struct Entry {
    double f;
    double arrival_s;  ///< g when queued; for a promise a lower bound on it
    NodeId node;
    NodeId from;    ///< for a promise the node next to it, kNoNode for a settled one
    NodeId parent;  ///< for a promise the node from which it may be reached straight, or kNoNode
    std::uint32_t sequence;

    bool is_promise() const { return from != kNoNode; }
  };

  bool empty() const { return heap_.empty(); }

  void clear() {
    heap_.clear();
    pushed_ = 0;
  }

  /// A node with its arrival. O(log size).
  void push(NodeId node, double f, double arrival_s) {
    push({f, arrival_s, node, kNoNode, kNoNode, pushed_});
  }

  /// A promise. O(log size).
  void push_promise(NodeId node, double f, double arrival_s, NodeId from, NodeId parent) {
    push({f, arrival_s, node, from, parent, pushed_});
  }

  /// O(log size). REQUIRES: !empty().
  Entry pop_min() {
    const Entry least = heap_.front();
    const Entry moved = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) sift_down(moved);
    return least;
  }

 private:
  /// Children of a heap node. Four lie in two cache lines and halve the depth of two.
  static constexpr std::size_t kArity = 4;

  static bool comes_before(const Entry& a, const Entry& b) {
    if (a.f != b.f) return a.f < b.f;
    if (a.arrival_s != b.arrival_s) return a.arrival_s > b.arrival_s;
    return a.sequence < b.sequence;
  }

  void push(const Entry& entry) {
    ++pushed_;
    std::size_t hole = heap_.size();
    heap_.push_back(entry);
    while (hole > 0) {
      const std::size_t above = (hole - 1) / kArity;
      if (!comes_before(entry, heap_[above])) break;
      heap_[hole] = heap_[above];
      hole = above;
    }
    heap_[hole] = entry;
  }

  /// Puts `entry` in place of the root.
  void sift_down(const Entry& entry) {
    std::size_t hole = 0;
    while (true) {
      const std::size_t first = hole * kArity + 1;
      if (first >= heap_.size()) break;
      const std::size_t last = std::min(first + kArity, heap_.size());
      std::size_t least = first;
      for (std::size_t child = first + 1; child < last; ++child) {
        if (comes_before(heap_[child], heap_[least])) least = child;
      }
      if (!comes_before(heap_[least], entry)) break;
      heap_[hole] = heap_[least];
      hole = least;
    }
    heap_[hole] = entry;
  }

  std::vector<Entry> heap_;
  std::uint32_t pushed_ = 0;
};

}  // namespace sipplab
