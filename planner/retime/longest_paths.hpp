// The least times that keep difference constraints, "this one at least so long after that one": longest
// paths. Linear in events and constraints where these have an order (Tarjan 1972); constraints that go in a
// circle are relaxed among themselves (Bellman 1958), and a circle that asks for more time than it gives is
// named.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sipplab {

using EventId = std::uint32_t;

/// `after` happens `lag` after `before` or later.
template <class Time>
struct Lag {
  EventId before = 0;
  Time lag{};
};

template <class Time>
struct LeastTimes {
  std::vector<Time> times;  ///< of all events; empty if there are none that keep the constraints
  /// Events of which each has to wait for the next one, and the last for the first: a circle that cannot be
  /// kept. Empty otherwise.
  std::vector<EventId> circle = {};
};

/// A graph says of its events what they wait for:
///     using Time = ...                              with +, < and ==; Time{} is 0
///     std::size_t size() const
///     Time earliest(EventId) const                  the least time of an event that waits for nothing
///     std::optional<Lag<Time>> lag(EventId, std::uint32_t n) const   the n-th constraint, which is not about
///                                                                    the event itself; none: no more
///     bool is_later(Time a, Time b) const           by more than rounding explains
template <class Graph>
class LongestPaths {
 public:
  using Time = typename Graph::Time;

  explicit LongestPaths(const Graph& graph) : graph_(graph), rank_(graph.size(), 0), times_(graph.size()) {}

  /// O(events + constraints), and for each set of events that wait for each other its events times its
  /// constraints.
  ///  (1) No time is less than earliest(), and all constraints are kept, as far as is_later() sees;
  ///  (2) no other times that do so are earlier for any event;
  ///  (3) a circle is returned exactly if there are no such times, one of as few events as any through those
  ///  of
  ///      the circle that was found first.
  LeastTimes<Time> solve() {
    for (EventId event = 0; event < graph_.size(); ++event) {
      if (rank_[event] == 0 && !visit(event)) return {{}, std::move(circle_)};
    }
    return {std::move(times_)};
  }

 private:
  struct Frame {
    EventId event;
    std::uint32_t next = 0;  // constraint to look at
    bool is_root = true;
  };

  /// Finds the sets of events that wait for each other, each after those that it waits for. [Pe05]: Pearce's
  /// variant with one number an event: 0 unseen, else rank on the stack, else more than any rank.
  bool visit(EventId wanted) {
    enter(wanted);
    while (!frames_.empty()) {
      Frame& frame = frames_.back();
      const auto lag = graph_.lag(frame.event, frame.next);
      if (lag && rank_[lag->before] == 0) {
        enter(lag->before);
      } else if (lag) {
        if (rank_[lag->before] < rank_[frame.event]) {
          rank_[frame.event] = rank_[lag->before];
          frame.is_root = false;
        }
        ++frame.next;
      } else {
        const Frame left = frame;
        frames_.pop_back();
        if (!leave(left)) return false;
      }
    }
    return true;
  }

  void enter(EventId event) {
    rank_[event] = next_rank_++;
    frames_.push_back({event});
  }

  bool leave(const Frame& frame) {
    if (!frame.is_root) {
      stack_.push_back(frame.event);
      return true;
    }
    --next_rank_;
    std::vector<EventId> together;
    while (!stack_.empty() && rank_[frame.event] <= rank_[stack_.back()]) {
      --next_rank_;
      together.push_back(stack_.back());
      stack_.pop_back();
    }
    rank_[frame.event] = kDone;
    for (const EventId event : together) rank_[event] = kDone;
    if (together.empty()) {
      times_[frame.event] = waited(frame.event, [](EventId) { return true; });
      return true;
    }
    together.push_back(frame.event);
    return relax(together);
  }

  /// The time of an event from those of the events before it for which `counts` says so.
  template <class Counts>
  Time waited(EventId event, Counts&& counts) const {
    Time time = graph_.earliest(event);
    for (std::uint32_t n = 0;; ++n) {
      const auto lag = graph_.lag(event, n);
      if (!lag) return time;
      if (!counts(lag->before)) continue;
      const Time ready = times_[lag->before] + lag->lag;
      if (time < ready) time = ready;
    }
  }

  /// Constraints among the events of one set, each kept in turn until all are.
  bool relax(const std::vector<EventId>& together) {
    std::unordered_map<EventId, EventId> waits_for;  // the event that its time comes from
    waits_for.reserve(together.size());
    for (const EventId event : together) waits_for.emplace(event, event);
    const auto is_inside = [&](EventId event) { return waits_for.count(event) != 0; };
    for (const EventId event : together) {
      times_[event] = waited(event, [&](EventId before) { return !is_inside(before); });
    }
    std::size_t next_look = 1;
    for (std::size_t round = 1;; ++round) {
      bool changed = false;
      for (const EventId event : together) {
        for (std::uint32_t n = 0;; ++n) {
          const auto lag = graph_.lag(event, n);
          if (!lag) break;
          if (!is_inside(lag->before)) continue;
          const Time ready = times_[lag->before] + lag->lag;
          if (!graph_.is_later(ready, times_[event])) continue;
          times_[event] = ready;
          waits_for[event] = lag->before;
          changed = true;
        }
      }
      if (!changed) return true;
      if (round < next_look) continue;
      next_look = 2 * round;
      if (const EventId on_circle = find_circle(together, waits_for); on_circle != kNone) {
        shorten(on_circle, waits_for);
        return false;
      }
    }
  }

  /// An event on a circle of events of which each has its time from the next.
  EventId find_circle(const std::vector<EventId>& together,
                      const std::unordered_map<EventId, EventId>& waits_for) const {
    std::unordered_map<EventId, std::size_t> seen_by;
    for (std::size_t walk = 0; walk < together.size(); ++walk) {
      EventId event = together[walk];
      while (seen_by.emplace(event, walk).second) {
        const EventId next = waits_for.at(event);
        if (next == event) break;
        event = next;
      }
      if (seen_by.at(event) == walk && waits_for.at(event) != event) return event;
    }
    return kNone;
  }

  /// Keeps the circle, or one of fewer events through an event of it.
  void shorten(EventId on_circle, const std::unordered_map<EventId, EventId>& waits_for) {
    std::vector<EventId> found;
    EventId event = on_circle;
    do {
      found.push_back(event);
      event = waits_for.at(event);
    } while (event != on_circle);
    circle_ = found;
    std::size_t work = 0;
    for (const EventId begin : found) {
      if (const auto shorter = shorter_circle(begin, circle_.size(), work)) circle_ = *shorter;
    }
  }

  /// A circle through the event that has fewer events than `size` and cannot be kept: the longest walks of
  /// one step, of two and so on, against the constraints.
  std::optional<std::vector<EventId>> shorter_circle(EventId begin, std::size_t size,
                                                     std::size_t& work) const {
    struct Step {
      Time lag{};
      EventId from = kNone;
    };
    std::vector<std::unordered_map<EventId, Step>> layers{{{begin, {}}}};
    while (layers.size() < size) {
      std::unordered_map<EventId, Step> next;
      for (const auto& [event, step] : layers.back()) {
        for (std::uint32_t n = 0;; ++n, ++work) {
          const auto lag = graph_.lag(event, n);
          if (!lag) break;
          const Step longer{step.lag + lag->lag, event};
          const auto [place, is_new] = next.emplace(lag->before, longer);
          if (!is_new && place->second.lag < longer.lag) place->second = longer;
        }
      }
      if (work > kMostWork) return std::nullopt;
      const auto back = next.find(begin);
      const bool closes = back != next.end() && graph_.is_later(back->second.lag, Time{});
      layers.push_back(std::move(next));
      if (!closes) continue;
      std::vector<EventId> circle;
      EventId event = begin;
      for (std::size_t layer = layers.size() - 1; layer > 0; --layer) {
        event = layers[layer].at(event).from;
        circle.push_back(event);
      }
      std::reverse(circle.begin(), circle.end());
      return circle;
    }
    return std::nullopt;
  }

  static constexpr EventId kNone = UINT32_MAX;
  static constexpr EventId kDone = UINT32_MAX;
  /// Constraints looked at in search of a shorter circle: a second's work.
  static constexpr std::size_t kMostWork = 10'000'000;

  const Graph& graph_;
  std::vector<EventId> rank_;
  std::vector<Time> times_;
  EventId next_rank_ = 1;
  std::vector<Frame> frames_;
  std::vector<EventId> stack_;
  std::vector<EventId> circle_;
};

template <class Graph>
LeastTimes<typename Graph::Time> least_times(const Graph& graph) {
  return LongestPaths<Graph>(graph).solve();
}

}  // namespace sipplab
