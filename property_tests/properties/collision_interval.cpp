// Closed forms of unsafe times against distances and bisection.
#include "planner/geometry/collision_interval.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/unsafe_times.hpp"

namespace sipplab::collision_interval_laws {
namespace {

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

UnsafeTimes departures_of(const Encounter& encounter) {
  return departures_of(encounter.move(), encounter.obstacle(), encounter.reach());
}

UnsafeTimes collisions_of(const Encounter& encounter) {
  return collisions_of(centre(encounter.from), encounter.obstacle(), encounter.reach());
}

void have_no_flaw(const std::vector<Encounter>& encounters, UnsafeTimes (*times_of)(const Encounter&)) {
  Seen seen;
  for (const Encounter& encounter : encounters) {
    RC_LOG() << encounter << std::endl;
    const UnsafeTimes times = times_of(encounter);
    RC_ASSERT(find_flaw(times) == "");
    seen.add(times.bisected, times.reach);
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
    const UnsafeTimes question = departures_of(encounter);
    const Move move = encounter.move();
    const MovingDisk disk = encounter.obstacle();
    std::vector<double> times = times_to_check(question);
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
      const double apart = question.distance(departure_s);
      if (apart > encounter.reach() + kNearMissCells + question.rounding_cells) RC_ASSERT(!quick);
    }
    seen.add(question.bisected, question.reach);
  }
  RC_CLASSIFY(sure > 0, "some surely overlap");
  seen.classify();
}

/// Samples along the path, each of which speaks for a stretch around it. True when some of
/// the path intrudes.
bool agrees_with_samples(const Displacement& path, Vec2 place, Vec2 pardoned, double reach) {
  constexpr int kSamples = 500;
  const double stretch = path.length / kSamples / 2 + kPermittedDepthCells;
  bool must = false;
  bool may = false;
  for (int i = 0; i <= kSamples; ++i) {
    const Vec2 sample = path.from + (path.to - path.from) * (static_cast<double>(i) / kSamples);
    const double to_place = norm(sample - place);
    const double to_pardoned = norm(sample - pardoned);
    must = must ||
           (to_place < reach - 2 * kPermittedDepthCells && to_pardoned > reach + 2 * kPermittedDepthCells);
    may = may || (to_place < reach + stretch && to_pardoned > reach - stretch);
  }
  const bool answer = intrudes(path, place, pardoned, reach);
  if (must) RC_ASSERT(answer);
  if (!may) RC_ASSERT(!answer);
  return answer;
}

/// At the time of the first overlap the two are as near as their bodies allow, and never nearer before.
void begins_with_a_contact(const std::vector<Encounter>& encounters) {
  constexpr double kRoundingCells = 1e-6;
  constexpr int kSamples = 10;
  int met = 0;
  for (const Encounter& encounter : encounters) {
    RC_LOG() << encounter << std::endl;
    const UnsafeTimes question = departures_of(encounter);
    const Move move = encounter.move();
    const MovingDisk disk = encounter.obstacle();
    for (const double departure_s : times_to_check(question)) {
      const double first_s = first_overlap_s(move, departure_s, disk, encounter.reach());
      const double begin_s = std::max(departure_s, disk.begin_s);
      const double end_s = std::min(departure_s + move.duration, disk.end_s);
      if (first_s == kForever) {
        if (end_s - begin_s > kRoundingCells) {
          RC_ASSERT(question.distance(departure_s) > encounter.reach() - kRoundingCells);
        }
        continue;
      }
      ++met;
      RC_ASSERT(first_s >= begin_s && first_s <= end_s);
      const auto apart = [&](double time_s) {
        return norm(move.path.from + move.velocity * (time_s - departure_s) - disk.from -
                    disk.velocity * (time_s - disk.begin_s));
      };
      RC_ASSERT(apart(first_s) < encounter.reach() + kRoundingCells);
      for (int i = 0; i < kSamples; ++i) {
        const double before_s = begin_s + (first_s - begin_s) * i / kSamples;
        if (before_s < first_s) RC_ASSERT(apart(before_s) > encounter.reach() - kRoundingCells);
      }
    }
  }
  RC_CLASSIFY(met > 0, "some meet");
}

const PropertyRoom room("collision_interval", [] {
  bool passed = true;

  passed &= property("unsafe_departures (1)(3): overlap inside, none outside, contact at the ends",
                     [] { have_no_flaw(*any_encounters(), departures_of); });

  passed &= property("collision_interval (1)(3): overlap inside, none outside, contact at the ends",
                     [] { have_no_flaw(*any_encounters(), collisions_of); });

  passed &= property(
      "closeness (1)(2)(3): misses no unsafe departure, leaves out those far apart, is sure of overlaps",
      [] { check_quick_test(*any_encounters()); });

  passed &= property("first_overlap_s: a contact, and none before",
                     [] { begins_with_a_contact(*any_encounters()); });

  passed &= property("intrudes: agrees with samples of the path", [] {
    constexpr int kPaths = 10;
    constexpr std::int32_t kSide = 5;
    int intruding = 0;
    for (int i = 0; i < kPaths; ++i) {
      const Displacement path(centre(*any_cell(kSide, kSide)), centre(*any_cell(kSide, kSide)));
      const Vec2 place = centre(*any_cell(kSide, kSide));
      const Vec2 pardoned = centre(*any_cell(kSide, kSide));
      intruding += agrees_with_samples(path, place, pardoned, *any_radius() + 0.5) ? 1 : 0;
    }
    RC_CLASSIFY(intruding > 0 && intruding < kPaths, "some intrude, some do not");
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::collision_interval_laws
