// Unsafe times against distances; see unsafe_times.hpp.
#include "property_tests/support/unsafe_times.hpp"

#include <algorithm>
#include <cmath>

#include "planner/geometry/collision_interval.hpp"

namespace sipplab {
namespace {

/// Slacks from the end of an interval at which the verdict has to be that of its inside:
/// an end is off by one slack, rounding included by two.
constexpr double kSlacksInside = 4;
/// How far from an end the times near it are checked, in seconds.
constexpr double kNearS[] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5};

/// An end that is not where the obstacle's motion ends is a contact.
std::string find_flaw_of_end(const UnsafeTimes& times, double end_s, double motion_end_s) {
  if (end_s == kForever) return motion_end_s == kForever ? "" : "endless without a reason";
  if (std::abs(end_s - motion_end_s) <= 2 * times.slack_s + times.rounding_s) {
    const bool overlaps = times.distance(motion_end_s) <= times.reach + times.rounding_cells;
    return overlaps ? "" : "an end at the end of the motion, though the two are apart there";
  }
  const double off = times.distance(end_s) - times.reach;
  const bool is_contact = std::abs(off) <= kPermittedDepthCells + times.rounding_cells;
  return is_contact ? "" : "an end that is no contact";
}

}  // namespace

UnsafeTimes departures_of(const Move& move, const MovingDisk& disk, double reach) {
  const double latest_s = (disk.end_s == kForever ? disk.begin_s : disk.end_s) + move.duration;
  return {unsafe_departures(move, disk, reach),
          bisect_departures(move, disk, reach),
          disk.begin_s - move.duration,
          disk.end_s,
          reach,
          kContactSlackCells / std::max(move.speed, disk.speed),
          rounding_cells(latest_s, move.speed + disk.speed),
          time_rounding_s(latest_s),
          [=](double departure_s) { return closest_approach(leg_of(move, departure_s), leg_of(disk)); }};
}

UnsafeTimes collisions_of(Vec2 place, const MovingDisk& disk, double reach) {
  const double latest_s = disk.end_s == kForever ? disk.begin_s : disk.end_s;
  return {collision_interval(place, disk, reach),
          bisect_collision(place, disk, reach),
          disk.begin_s,
          disk.end_s,
          reach,
          disk.at_rest() ? kContactSlackCells : kContactSlackCells / disk.speed,
          rounding_cells(latest_s, disk.speed),
          time_rounding_s(latest_s),
          [=](double time_s) { return distance_at(place, disk, time_s); }};
}

std::vector<double> times_to_check(const UnsafeTimes& times) {
  const OpenInterval& unsafe = times.unsafe;
  const BisectedSpan& bisected = times.bisected;
  const double last_s = times.last_s == kForever ? bisected.deepest_s + 10 : times.last_s;
  std::vector<double> chosen{bisected.deepest_s};
  const auto spread = [&](double begin_s, double end_s) {
    constexpr int kTimes = 24;
    for (int i = 0; i <= kTimes; ++i) chosen.push_back(begin_s + (end_s - begin_s) * i / kTimes);
  };
  spread(times.first_s - 1, last_s + 1);
  if (!unsafe.empty() && unsafe.end_s < kForever) spread(unsafe.begin_s, unsafe.end_s);
  for (const double end_s : {unsafe.begin_s, unsafe.end_s, bisected.begin_s, bisected.end_s}) {
    if (end_s == kForever) continue;
    chosen.push_back(end_s);
    for (const double near_s : kNearS) chosen.insert(chosen.end(), {end_s - near_s, end_s + near_s});
    const double inside_s = 2 * kSlacksInside * times.slack_s;
    chosen.insert(chosen.end(), {end_s - inside_s, end_s + inside_s});
  }
  return chosen;
}

std::string find_flaw(const UnsafeTimes& times) {
  const OpenInterval& unsafe = times.unsafe;
  // Touching is not overlapping, however rounding falls.
  if (times.bisected.least_cells > times.reach - kTouchDepthCells / 2 && !unsafe.empty()) {
    return "unsafe, though the two only touch";
  }
  const double inside_s = kSlacksInside * times.slack_s + times.rounding_s;
  for (const double time_s : times_to_check(times)) {
    const double apart = times.distance(time_s);
    if (!unsafe.contains(time_s)) {
      if (apart < times.reach - kPermittedDepthCells - times.rounding_cells) {
        return "overlap at a time that is called safe";
      }
    } else if (time_s > unsafe.begin_s + inside_s && time_s < unsafe.end_s - inside_s) {
      if (apart >= times.reach + times.rounding_cells) return "apart at a time that is called unsafe";
    }
  }
  if (unsafe.empty()) return "";
  const std::string flaw = find_flaw_of_end(times, unsafe.begin_s, times.first_s);
  return flaw.empty() ? find_flaw_of_end(times, unsafe.end_s, times.last_s) : flaw;
}

}  // namespace sipplab
