// Closed forms of unsafe times against distances and bisection.
#include "planner/geometry/collision_interval.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab {
namespace {

/// Slacks from the end of an interval at which the verdict has to be that of its inside:
/// an end is off by one slack, rounding included by two.
constexpr double kSlacksInside = 4;
/// How far from an end the times near it are checked, in seconds.
constexpr double kBesideS[] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5};

/// What one comparison of an interval with distances needs to know.
struct Question {
  OpenInterval unsafe;
  BisectedSpan bisected;
  double first_s;  ///< nothing can overlap before ...
  double last_s;   ///< ... nor after, possibly kForever
  double reach;
  double slack_s;
  double rounding_cells;
  double rounding_s;
};

/// Times all over the span in which the two can meet, and dense around every end.
std::vector<double> times_to_ask(const Question& question) {
  const OpenInterval& unsafe = question.unsafe;
  const BisectedSpan& bisected = question.bisected;
  const double last_s = question.last_s == kForever ? bisected.deepest_s + 10 : question.last_s;
  std::vector<double> times{bisected.deepest_s};
  const auto spread = [&](double begin_s, double end_s) {
    constexpr int kTimes = 24;
    for (int i = 0; i <= kTimes; ++i) times.push_back(begin_s + (end_s - begin_s) * i / kTimes);
  };
  spread(question.first_s - 1, last_s + 1);
  if (!unsafe.empty() && unsafe.end_s < kForever) spread(unsafe.begin_s, unsafe.end_s);
  for (const double end_s : {unsafe.begin_s, unsafe.end_s, bisected.begin_s, bisected.end_s}) {
    if (end_s == kForever) continue;
    times.push_back(end_s);
    for (const double beside_s : kBesideS) {
      times.push_back(end_s - beside_s);
      times.push_back(end_s + beside_s);
    }
    times.push_back(end_s - 2 * kSlacksInside * question.slack_s);
    times.push_back(end_s + 2 * kSlacksInside * question.slack_s);
  }
  return times;
}

/// An end that is not where the obstacle's motion ends is a contact.
template <class Distance>
void check_end(const Question& question, double end_s, double motion_end_s, const Distance& distance) {
  if (end_s == kForever) {
    RC_ASSERT(motion_end_s == kForever);
    return;
  }
  const double margin_s = 2 * question.slack_s + question.rounding_s;
  if (std::abs(end_s - motion_end_s) <= margin_s) {
    RC_ASSERT(distance(motion_end_s) <= question.reach + question.rounding_cells);
    return;
  }
  const double off = distance(end_s) - question.reach;
  RC_ASSERT(std::abs(off) <= kPermittedDepthCells + question.rounding_cells);
}

template <class Distance>
void agrees_with_distances(const Question& question, const Distance& distance) {
  const OpenInterval& unsafe = question.unsafe;
  // Touching is not overlapping, however rounding falls.
  if (question.bisected.least_cells > question.reach - kTouchDepthCells / 2) RC_ASSERT(unsafe.empty());
  const double inside_s = kSlacksInside * question.slack_s + question.rounding_s;
  for (const double time_s : times_to_ask(question)) {
    const double apart = distance(time_s);
    if (!unsafe.contains(time_s)) {
      RC_ASSERT(apart >= question.reach - kPermittedDepthCells - question.rounding_cells);
    } else if (time_s > unsafe.begin_s + inside_s && time_s < unsafe.end_s - inside_s) {
      RC_ASSERT(apart < question.reach + question.rounding_cells);
    }
  }
  if (unsafe.empty()) return;
  check_end(question, unsafe.begin_s, question.first_s, distance);
  check_end(question, unsafe.end_s, question.last_s, distance);
}

/// What the encounters of a case were like, for the statistics.
struct Seen {
  int touching = 0;
  int overlapping = 0;
  int apart = 0;
  int cut = 0;

  void add(const BisectedSpan& span, double reach) {
    touching += std::abs(span.least_cells - reach) <= kTouchDepthCells;
    overlapping += !span.empty;
    apart += span.least_cells > reach + kTouchDepthCells;
    cut += !span.empty && (!span.contact_begin || !span.contact_end);
  }
  void classify() const {
    RC_CLASSIFY(touching > 0, "some only touch");
    RC_CLASSIFY(overlapping > 0, "some overlap");
    RC_CLASSIFY(apart > 0, "some stay apart");
    RC_CLASSIFY(cut > 0, "some overlap at the end of a motion");
  }
};

Question departures_of(const Encounter& encounter) {
  const Move move = encounter.move();
  const MovingDisk disk = encounter.obstacle();
  const double latest_s = (disk.end_s == kForever ? disk.begin_s : disk.end_s) + move.duration;
  return {unsafe_departures(move, disk, encounter.reach()),
          bisect_departures(move, disk, encounter.reach()),
          disk.begin_s - move.duration,
          disk.end_s,
          encounter.reach(),
          kContactSlackCells / std::max(move.speed, disk.speed),
          rounding_cells(latest_s, move.speed + disk.speed),
          time_rounding_s(latest_s)};
}

void check_departures(const std::vector<Encounter>& encounters) {
  Seen seen;
  for (const Encounter& encounter : encounters) {
    RC_LOG() << encounter << std::endl;
    const Question question = departures_of(encounter);
    const Move move = encounter.move();
    const MovingDisk disk = encounter.obstacle();
    agrees_with_distances(question, [&](double departure_s) {
      return closest_approach(leg_of(move, departure_s), leg_of(disk));
    });
    seen.add(question.bisected, question.reach);
  }
  seen.classify();
}

void check_collisions(const std::vector<Encounter>& encounters) {
  Seen seen;
  for (const Encounter& encounter : encounters) {
    RC_LOG() << encounter << std::endl;
    const Vec2 place = centre(encounter.from);
    const MovingDisk disk = encounter.obstacle();
    const double latest_s = disk.end_s == kForever ? disk.begin_s : disk.end_s;
    const Question question{collision_interval(place, disk, encounter.reach()),
                            bisect_collision(place, disk, encounter.reach()),
                            disk.begin_s,
                            disk.end_s,
                            encounter.reach(),
                            disk.at_rest() ? kContactSlackCells : kContactSlackCells / disk.speed,
                            rounding_cells(latest_s, disk.speed),
                            time_rounding_s(latest_s)};
    agrees_with_distances(question, [&](double time_s) { return distance_at(place, disk, time_s); });
    seen.add(question.bisected, question.reach);
  }
  seen.classify();
}

/// The very ends of the unsafe departures, where a quick test may come to miss one.
std::vector<double> times_at_the_ends(const OpenInterval& unsafe, double slack_s) {
  if (unsafe.empty()) return {};
  std::vector<double> times{std::nextafter(unsafe.begin_s, kForever), unsafe.begin_s + slack_s / 2};
  if (unsafe.end_s < kForever) {
    times.push_back(std::nextafter(unsafe.end_s, unsafe.begin_s));
    times.push_back(unsafe.end_s - slack_s / 2);
  }
  return times;
}

void check_quick_test(const std::vector<Encounter>& encounters) {
  Seen seen;
  int sure = 0;
  for (const Encounter& encounter : encounters) {
    RC_LOG() << encounter << std::endl;
    const Question question = departures_of(encounter);
    const Move move = encounter.move();
    const MovingDisk disk = encounter.obstacle();
    std::vector<double> times = times_to_ask(question);
    const std::vector<double> ends = times_at_the_ends(question.unsafe, question.slack_s);
    times.insert(times.end(), ends.begin(), ends.end());
    for (const double departure_s : times) {
      const Closeness close = closeness(move, departure_s, disk, encounter.reach());
      const bool quick = close != Closeness::kApart;
      if (question.unsafe.contains(departure_s)) RC_ASSERT(quick);
      if (close == Closeness::kOverlapping) RC_ASSERT(question.unsafe.contains(departure_s));
      sure += close == Closeness::kOverlapping;
      const double margin_s = kNearMissCells / move.speed + question.rounding_s;
      const bool together =
          departure_s > question.first_s - margin_s && departure_s < question.last_s + margin_s;
      if (!together) RC_ASSERT(!quick);
      // Where the two are there together for next to no time, their distance is not asked.
      if (departure_s < question.first_s + margin_s || departure_s > question.last_s - margin_s) continue;
      const double apart = closest_approach(leg_of(move, departure_s), leg_of(disk));
      if (apart > encounter.reach() + kNearMissCells + question.rounding_cells) RC_ASSERT(!quick);
    }
    seen.add(question.bisected, question.reach);
  }
  RC_CLASSIFY(sure > 0, "some surely overlap");
  seen.classify();
}

/// Samples along the path, each of which speaks for a stretch around it. True when some of
/// the path intrudes.
bool agrees_with_samples(const Displacement& way, Vec2 place, Vec2 pardoned, double reach) {
  constexpr int kSamples = 500;
  const double stretch = way.length / kSamples / 2 + kPermittedDepthCells;
  bool must = false;
  bool may = false;
  for (int i = 0; i <= kSamples; ++i) {
    const Vec2 sample = way.from + (way.to - way.from) * (static_cast<double>(i) / kSamples);
    const double to_place = norm(sample - place);
    const double to_pardoned = norm(sample - pardoned);
    must = must ||
           (to_place < reach - 2 * kPermittedDepthCells && to_pardoned > reach + 2 * kPermittedDepthCells);
    may = may || (to_place < reach + stretch && to_pardoned > reach - stretch);
  }
  const bool answer = intrudes(way, place, pardoned, reach);
  if (must) RC_ASSERT(answer);
  if (!may) RC_ASSERT(!answer);
  return answer;
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("unsafe_departures (1)(3): overlap inside, none outside, contact at the ends",
                     [] { check_departures(*any_encounters()); });

  passed &= property("collision_interval (1)(3): overlap inside, none outside, contact at the ends",
                     [] { check_collisions(*any_encounters()); });

  passed &= property(
      "closeness (1)(2)(3): misses no unsafe departure, leaves out those far apart, is sure of overlaps",
      [] { check_quick_test(*any_encounters()); });

  passed &= property("intrudes: agrees with samples of the way", [] {
    constexpr int kWays = 10;
    constexpr std::int32_t kSide = 5;
    int intruding = 0;
    for (int i = 0; i < kWays; ++i) {
      const Displacement way(centre(*any_cell(kSide, kSide)), centre(*any_cell(kSide, kSide)));
      const Vec2 place = centre(*any_cell(kSide, kSide));
      const Vec2 pardoned = centre(*any_cell(kSide, kSide));
      intruding += agrees_with_samples(way, place, pardoned, *any_radius() + 0.5) ? 1 : 0;
    }
    RC_CLASSIFY(intruding > 0 && intruding < kWays, "some intrude, some do not");
  });

  return passed ? 0 : 1;
}
