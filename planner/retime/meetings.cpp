#include "planner/retime/meetings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/geometry/collision_interval.hpp"

namespace sipplab {
namespace {

/// Cells. Smaller buckets than this are more than most moves need.
constexpr double kLeastBucketCells = 2;

/// A body and one of its moves, or the place where it stands for ever.
struct Occupant {
  std::uint32_t course = 0;
  std::uint32_t move = 0;
};

/// Square buckets that moves pass, found by sorting.
class MoveBuckets {
 public:
  explicit MoveBuckets(const std::vector<Course>& courses) {
    double widest = 0;
    for (const Course& course : courses) widest = std::max(widest, course.radius_cells);
    per_cell_ = 1 / std::max(kLeastBucketCells, 2 * widest);
    for (std::uint32_t c = 0; c < courses.size(); ++c) {
      for (std::uint32_t m = 0; m < std::max<std::size_t>(1, courses[c].moves.size()); ++m) {
        buckets_of(courses[c], m, keys_);
        for (const std::uint64_t key : keys_) entries_.push_back({key, {c, m}});
      }
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      if (a.key != b.key) return a.key < b.key;
      if (a.occupant.course != b.occupant.course) return a.occupant.course < b.occupant.course;
      return a.occupant.move < b.occupant.move;
    });
  }

  /// Calls visit(occupant) for those of later courses that share a bucket with the move, some more than once.
  template <class Visit>
  void for_each_later(const Course& course, Occupant move, Visit&& visit) {
    buckets_of(course, move.move, keys_);
    for (const std::uint64_t key : keys_) {
      const auto less = [](const Entry& entry, const std::pair<std::uint64_t, std::uint32_t>& wanted) {
        return entry.key != wanted.first ? entry.key < wanted.first : entry.occupant.course < wanted.second;
      };
      auto entry = std::lower_bound(entries_.begin(), entries_.end(), std::pair{key, move.course + 1}, less);
      for (; entry != entries_.end() && entry->key == key; ++entry) visit(entry->occupant);
    }
  }

 private:
  struct Entry {
    std::uint64_t key;
    Occupant occupant;
  };

  void buckets_of(const Course& course, std::uint32_t move, std::vector<std::uint64_t>& keys) const {
    keys.clear();
    const Vec2 from = course.moves.empty() ? course.start : course.moves[move].move.path.from;
    const Vec2 path = course.moves.empty() ? Vec2{} : course.moves[move].move.path.to - from;
    const double parts = std::max(1.0, std::ceil(norm(path) * per_cell_));
    const auto bucket = [this](double cells) {
      return static_cast<std::int64_t>(std::floor(cells * per_cell_));
    };
    for (double part = 0; part < parts; ++part) {
      const Vec2 a = from + path * (part / parts);
      const Vec2 b = from + path * ((part + 1) / parts);
      const double reach = course.radius_cells;
      for (auto x = bucket(std::min(a.x, b.x) - reach); x <= bucket(std::max(a.x, b.x) + reach); ++x) {
        for (auto y = bucket(std::min(a.y, b.y) - reach); y <= bucket(std::max(a.y, b.y) + reach); ++y) {
          keys.push_back(static_cast<std::uint64_t>(x) << 32 ^ static_cast<std::uint32_t>(y));
        }
      }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  }

  double per_cell_ = 1;
  std::vector<Entry> entries_;
  std::vector<std::uint64_t> keys_;
};

/// Move `a` of one course and move `b` of another one that collide for some departures.
struct Encounter {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  OpenInterval unsafe;  ///< departures of b relative to those of a
  double given_s = 0;   ///< that of the given plan
  double slack_s = 0;
  int vote = 0;  ///< 1: a goes first in the given plan, -1: b does, 0: they overlap
  double lean = 0;
  bool a_must_be_first = false;
  bool b_must_be_first = false;
  std::uint32_t group = 0;
};

class PairOfCourses {
 public:
  PairOfCourses(const Course& a, const Course& b) : a_(a), b_(b), reach_(a.radius_cells + b.radius_cells) {}

  /// REQUIRES: by a, then b.
  void add(std::uint32_t a, std::uint32_t b) {
    const CourseMove& first = a_.moves[a];
    const CourseMove& second = b_.moves[b];
    Encounter found;
    found.a = a;
    found.b = b;
    found.unsafe = unsafe_of(first.move, second.move);
    if (found.unsafe.empty()) return;
    const double fastest = std::max(first.move.speed, second.move.speed);
    found.given_s = second.given_begin_s - first.given_begin_s;
    found.slack_s = kGivenOverlapCells / fastest;
    const OpenInterval given = given_unsafe(first, second, found.unsafe);
    if (found.given_s >= given.end_s - found.slack_s) {
      found.vote = 1;
    } else if (found.given_s <= given.begin_s + found.slack_s) {
      found.vote = -1;
    } else {
      found.lean = (2 * found.given_s - given.begin_s - given.end_s) / (given.end_s - given.begin_s);
    }
    found.a_must_be_first = (a == 0 && reaches(second.move.path, a_.start, reach_)) ||
                            (b + 1 == b_.moves.size() && reaches(first.move.path, b_.end(), reach_));
    found.b_must_be_first = (b == 0 && reaches(first.move.path, b_.start, reach_)) ||
                            (a + 1 == a_.moves.size() && reaches(second.move.path, a_.end(), reach_));
    found.group = static_cast<std::uint32_t>(encounters_.size());
    encounters_.push_back(found);
  }

  /// Adds the orders of all encounters. False if there is none.
  bool decide(EventId first_a, EventId first_b, Meetings& meetings) {
    join();
    struct Group {
      int votes = 0;
      double lean = 0;
      bool a_must = false;
      bool b_must = false;
    };
    std::vector<Group> groups(encounters_.size());
    for (const Encounter& encounter : encounters_) {
      Group& group = groups[root(encounter.group)];
      group.votes += encounter.vote;
      group.lean += encounter.lean;
      group.a_must = group.a_must || encounter.a_must_be_first;
      group.b_must = group.b_must || encounter.b_must_be_first;
      if (!group.a_must || !group.b_must) continue;
      meetings.deadlock_place = a_.moves[encounter.a].move.path.to;
      return false;
    }
    for (const Encounter& encounter : encounters_) {
      const Group& group = groups[root(encounter.group)];
      const bool a_goes_first =
          group.a_must || (!group.b_must && (group.votes != 0 ? group.votes > 0 : group.lean >= 0));
      const EventId a = first_a + encounter.a;
      const EventId b = first_b + encounter.b;
      const OpenInterval unsafe = as_given(encounter);
      meetings.precedences.push_back(a_goes_first ? Precedence{b, a, unsafe.end_s}
                                                  : Precedence{a, b, -unsafe.begin_s});
    }
    return true;
  }

 private:
  OpenInterval unsafe_of(const Move& first, const Move& second) const {
    return meeting_interval(second, MovingDisk::moving(first.path, 0, first.duration, a_.radius_cells),
                            reach_);
  }

  /// By the given plan's own clock, which may be that of another speed.
  OpenInterval given_unsafe(const CourseMove& first, const CourseMove& second,
                            const OpenInterval& own) const {
    const auto own_clock = [](const CourseMove& move) {
      const double given_s = move.given_end_s - move.given_begin_s;
      return std::abs(given_s - move.move.duration) <= kDurationTolerance * std::max(1.0, move.given_end_s);
    };
    if (own_clock(first) && own_clock(second)) return own;
    const double first_s = first.given_end_s - first.given_begin_s;
    const double second_s = second.given_end_s - second.given_begin_s;
    if (!(first_s > 0) || !(second_s > 0)) return {0, 0};  // at once: who begins first
    const OpenInterval given = unsafe_of(Move(first.move.path, first.move.path.length / first_s),
                                         Move(second.move.path, second.move.path.length / second_s));
    return given.empty() ? OpenInterval{0, 0} : given;
  }

  /// The ends of the interval, but no farther than the given plan went, as far as that is right.
  OpenInterval as_given(const Encounter& encounter) const {
    OpenInterval unsafe = encounter.unsafe;
    if (encounter.given_s < unsafe.end_s && encounter.given_s >= unsafe.end_s - encounter.slack_s) {
      unsafe.end_s = encounter.given_s;
    }
    if (encounter.given_s > unsafe.begin_s && encounter.given_s <= unsafe.begin_s + encounter.slack_s) {
      unsafe.begin_s = encounter.given_s;
    }
    return unsafe;
  }

  std::uint32_t root(std::uint32_t group) {
    while (encounters_[group].group != group) {
      group = encounters_[group].group = encounters_[encounters_[group].group].group;
    }
    return group;
  }

  /// One group of what hangs together: the next move of a body goes on from where it may stand in the way.
  void join() {
    const auto less = [](const Encounter& encounter, const std::pair<std::uint32_t, std::uint32_t>& wanted) {
      return std::pair{encounter.a, encounter.b} < wanted;
    };
    for (std::uint32_t i = 0; i < encounters_.size(); ++i) {
      const Encounter& here = encounters_[i];
      if (i + 1 < encounters_.size() && encounters_[i + 1].a == here.a &&
          encounters_[i + 1].b == here.b + 1 &&
          reaches(a_.moves[here.a].move.path, b_.moves[here.b].move.path.to, reach_)) {
        encounters_[root(i + 1)].group = root(i);
      }
      const auto next =
          std::lower_bound(encounters_.begin() + i, encounters_.end(), std::pair{here.a + 1, here.b}, less);
      if (next != encounters_.end() && next->a == here.a + 1 && next->b == here.b &&
          reaches(b_.moves[here.b].move.path, a_.moves[here.a].move.path.to, reach_)) {
        encounters_[root(static_cast<std::uint32_t>(next - encounters_.begin()))].group = root(i);
      }
    }
  }

  const Course& a_;
  const Course& b_;
  double reach_;
  std::vector<Encounter> encounters_;
};

/// Whether somebody passes a body that never moves, or two of those are too near.
bool passes_standing(const Course& standing, const Course& other, std::uint32_t move) {
  const double reach = standing.radius_cells + other.radius_cells;
  if (other.moves.empty()) return reaches(Displacement(other.start, other.start), standing.start, reach);
  return reaches(other.moves[move].move.path, standing.start, reach);
}

}  // namespace

Meetings find_meetings(const std::vector<Course>& courses) {
  Meetings meetings;
  EventId events = 0;
  for (const Course& course : courses) {
    meetings.first.push_back(events);
    events += static_cast<EventId>(course.moves.size());
  }
  meetings.first.push_back(events);

  MoveBuckets buckets(courses);
  using Candidate =
      std::array<std::uint32_t, 3>;  // the other course, a move of this one, a move of the other
  std::vector<Candidate> near;
  for (std::uint32_t c = 0; c < courses.size(); ++c) {
    const Course& course = courses[c];
    near.clear();
    for (std::uint32_t m = 0; m < std::max<std::size_t>(1, course.moves.size()); ++m) {
      buckets.for_each_later(course, {c, m}, [&](const Occupant& other) {
        if (course.is_fixed && courses[other.course].is_fixed) return;
        near.push_back({other.course, m, other.move});
      });
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (auto at = near.begin(); at != near.end();) {
      const std::uint32_t other = (*at)[0];
      const Course& second = courses[other];
      PairOfCourses pair(course, second);
      for (; at != near.end() && (*at)[0] == other; ++at) {
        if (!course.moves.empty() && !second.moves.empty()) {
          pair.add((*at)[1], (*at)[2]);
        } else if (course.moves.empty() ? passes_standing(course, second, (*at)[2])
                                        : passes_standing(second, course, (*at)[1])) {
          meetings.deadlock = {c, other};
          meetings.deadlock_place = course.moves.empty() ? course.start : second.start;
          return meetings;
        }
      }
      if (!pair.decide(meetings.first[c], meetings.first[other], meetings)) {
        meetings.deadlock = {c, other};
        return meetings;
      }
    }
  }
  return meetings;
}

}  // namespace sipplab
