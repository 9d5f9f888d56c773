// Least times that keep difference constraints, against rounds over all of them (Bellman 1958); circles that
// ask for more time than they give, against all walks.
#include "planner/retime/longest_paths.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <vector>

#include "property_tests/support/property.hpp"

namespace sipplab::longest_paths_laws {
namespace {

struct Graph {
  using Time = std::int64_t;
  std::vector<Time> earliest_times;
  std::vector<std::vector<Lag<Time>>> lags;  ///< by event

  std::size_t size() const { return earliest_times.size(); }
  Time earliest(EventId event) const { return earliest_times[event]; }
  std::optional<Lag<Time>> lag(EventId event, std::uint32_t n) const {
    if (n >= lags[event].size()) return std::nullopt;
    return lags[event][n];
  }
  bool is_later(Time a, Time b) const { return a > b; }
};

/// Sparse, so that some have an order; waits may be negative. No event waits for itself.
Graph make_graph() {
  Graph graph;
  const int events = *rc::gen::inRange(0, 9);
  const int most_lags = *rc::gen::inRange(0, 3);
  const int least = *rc::gen::element(-4, -1, 0);
  for (int event = 0; event < events; ++event) {
    graph.earliest_times.push_back(*rc::gen::inRange(0, 4));
    graph.lags.emplace_back();
    for (int lag = *rc::gen::inRange(0, most_lags + 1); lag > 0; --lag) {
      const auto before = static_cast<EventId>(*rc::gen::inRange(0, events));
      const int lag_s = *rc::gen::inRange(least, 4);
      if (before != static_cast<EventId>(event)) graph.lags.back().push_back({before, lag_s});
    }
  }
  return graph;
}

std::ostream& operator<<(std::ostream& out, const Graph& graph) {
  for (EventId event = 0; event < graph.size(); ++event) {
    out << event << " not before " << graph.earliest_times[event];
    for (const auto& lag : graph.lags[event]) out << ", " << lag.lag << " after " << lag.before;
    out << "\n";
  }
  return out;
}

/// Nothing if the rounds do not end.
std::optional<std::vector<std::int64_t>> times_by_rounds(const Graph& graph) {
  std::vector<std::int64_t> times = graph.earliest_times;
  for (std::size_t round = 0; round <= graph.size(); ++round) {
    bool changed = false;
    for (EventId event = 0; event < graph.size(); ++event) {
      for (const auto& lag : graph.lags[event]) {
        if (times[lag.before] + lag.lag <= times[event]) continue;
        times[event] = times[lag.before] + lag.lag;
        changed = true;
      }
    }
    if (!changed) return times;
  }
  return std::nullopt;
}

/// Fewest events of a circle through this one that asks for more time than none; 0 if there is none.
std::size_t least_circle_through(const Graph& graph, EventId begin) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  std::vector<std::int64_t> most(graph.size(), kNever);  // of walks of so many constraints from `begin`
  most[begin] = 0;
  for (std::size_t length = 1; length <= graph.size(); ++length) {
    std::vector<std::int64_t> next(graph.size(), kNever);
    for (EventId event = 0; event < graph.size(); ++event) {
      if (most[event] == kNever) continue;
      for (const auto& lag : graph.lags[event]) {
        next[lag.before] = std::max(next[lag.before], most[event] + lag.lag);
      }
    }
    most = next;
    if (most[begin] > 0) return length;
  }
  return 0;
}

/// How much more time the circle asks for than none, by the longest constraint of each pair.
std::optional<std::int64_t> asked_by(const Graph& graph, const std::vector<EventId>& circle) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < circle.size(); ++i) {
    std::optional<std::int64_t> longest;
    for (const auto& lag : graph.lags[circle[i]]) {
      if (lag.before != circle[(i + 1) % circle.size()]) continue;
      longest = std::max(longest.value_or(lag.lag), lag.lag);
    }
    if (!longest) return std::nullopt;
    sum += *longest;
  }
  return sum;
}

const PropertyRoom room("longest_paths", [] {
  bool passed = true;

  passed &= property("least_times (1)(2): as rounds over all constraints have it, or a circle", [] {
    const Graph graph = at_full_size(make_graph);
    const auto expected = times_by_rounds(graph);
    const LeastTimes<std::int64_t> found = least_times(graph);
    RC_CLASSIFY(!expected, "circle");
    RC_ASSERT(found.circle.empty() == expected.has_value());
    if (expected) RC_ASSERT(found.times == *expected);
  });

  passed &= property("least_times (3): a circle of few events that cannot be kept", [] {
    const Graph graph = at_full_size(make_graph);
    const LeastTimes<std::int64_t> found = least_times(graph);
    RC_PRE(!found.circle.empty());
    RC_ASSERT(found.times.empty());
    const auto asked = asked_by(graph, found.circle);
    RC_ASSERT(asked.has_value());
    RC_ASSERT(*asked > 0);
    // Through one of its events no other has fewer.
    RC_ASSERT(std::any_of(found.circle.begin(), found.circle.end(), [&](EventId event) {
      return least_circle_through(graph, event) == found.circle.size();
    }));
    RC_CLASSIFY(found.circle.size() > 2, "more than two events");
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::longest_paths_laws
