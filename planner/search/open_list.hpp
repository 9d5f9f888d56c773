// OPEN: nodes by least f, then greatest g, then oldest entry. Besides nodes with a known arrival it holds
// lazy successors: nodes whose arrival is so far only bounded from below. Overtaken entries stay in the list
// and are recognised when they are popped.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "planner/core/arena.hpp"
#include "planner/search/sipp_node.hpp"

namespace sipplab {

/// Entries wait unsorted in buckets of equal width in f. Only the bucket from which entries are popped is a
/// heap: most entries of later buckets are never looked at again.
class OpenList {
 public:
  explicit OpenList(Arena& arena) : heap_(arena), later_(arena), heads_(arena) {}

  struct Entry {
    double f;
    double arrival_s;  ///< g when queued; for a lazy successor a lower bound on it
    NodeId node;
    NodeId from;         ///< for a lazy successor the node it is reached from, else kNoNode
    NodeId parent;       ///< for a lazy successor the node to try a straight move from, or kNoNode; `from`
                         ///< for a leg
    std::uint32_t link;  ///< in a bucket the entry before it, on the heap its sequence number

    bool is_lazy() const { return from != kNoNode; }
    /// Reached by a straight move that is no step.
    bool is_leg() const { return is_lazy() && from == parent; }
  };

  bool empty() const { return size_ == 0; }

  /// Empties the list for a search whose f values begin near `least_f`; the two arguments affect speed, not
  /// order. REQUIRES: bucket_width > 0.
  void begin(double least_f, double bucket_width) {
    heap_.clear();
    later_.clear();
    heads_.clear();
    least_f_ = least_f;
    buckets_per_unit_ = 1 / bucket_width;
    current_ = 0;
    size_ = 0;
  }

  /// A node and its arrival. O(log size of a bucket).
  void push(NodeId node, double f, double arrival_s) { push({f, arrival_s, node, kNoNode, kNoNode, 0}); }

  /// A lazy successor. O(log size of a bucket).
  void push_lazy(NodeId node, double f, double arrival_s, NodeId from, NodeId parent) {
    push({f, arrival_s, node, from, parent, 0});
  }

  /// O(log size of a bucket). REQUIRES: !empty().
  Entry pop_min() {
    while (heap_.empty()) open_next_bucket();
    const Entry least = heap_[0];
    const Entry moved = heap_.back();
    heap_.pop_back();
    --size_;
    if (!heap_.empty()) sift_down(0, moved);
    return least;
  }

 private:
  /// Children of a heap node. Four fit in two cache lines; the heap is half as deep as with two.
  static constexpr std::size_t kArity = 4;
  /// Entries beyond this many buckets share the last one.
  static constexpr std::size_t kLastBucket = 8191;

  static constexpr std::uint32_t kNone = UINT32_MAX;

  static bool comes_before(const Entry& a, const Entry& b) {
    if (a.f != b.f) return a.f < b.f;
    if (a.arrival_s != b.arrival_s) return a.arrival_s > b.arrival_s;
    return a.link < b.link;
  }

  std::size_t bucket_of(double f) const {
    const double bucket = (f - least_f_) * buckets_per_unit_;
    if (!(bucket < static_cast<double>(kLastBucket))) return kLastBucket;
    return bucket > 0 ? static_cast<std::size_t>(static_cast<std::int64_t>(bucket)) : 0;
  }

  void push(Entry entry) {
    ++size_;
    const auto sequence = static_cast<std::uint32_t>(later_.size());
    const std::size_t bucket = bucket_of(entry.f);
    if (bucket <= current_) {
      entry.link = sequence;
      later_.push_back(entry);  // its index is its number
      sift_up(entry);
      return;
    }
    if (bucket >= heads_.size()) heads_.resize(bucket + 1, kNone);
    entry.link = std::exchange(heads_[bucket], sequence);
    later_.push_back(entry);
  }

  void open_next_bucket() {
    ++current_;
    for (std::uint32_t next = std::exchange(heads_[current_], kNone); next != kNone;) {
      heap_.push_back(later_[next]);
      heap_.back().link = std::exchange(next, later_[next].link);
    }
    if (heap_.size() < 2) return;
    for (std::size_t i = (heap_.size() - 2) / kArity + 1; i-- > 0;) sift_down(i, Entry{heap_[i]});
  }

  void sift_up(const Entry& entry) {
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

  /// Puts `entry` at `hole` or where it belongs below it.
  void sift_down(std::size_t hole, const Entry& entry) {
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

  ArenaVector<Entry> heap_;           ///< the bucket at current_ and all before it
  ArenaVector<Entry> later_;          ///< all entries pushed
  ArenaVector<std::uint32_t> heads_;  ///< by bucket: its newest entry in later_
  double least_f_ = 0;
  double buckets_per_unit_ = 1;
  std::size_t current_ = 0;
  std::size_t size_ = 0;
};

}  // namespace sipplab
