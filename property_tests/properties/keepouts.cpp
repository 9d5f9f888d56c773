// Places that the reservation table keeps robots away from for ever, one disk excepted:
// what a start-safe interval without end asks of it. Against sampled paths.
#include "planner/reservation/reservation_table.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

#include "planner/geometry/collision_interval.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::keepouts_laws {
namespace {

constexpr std::int32_t kWidth = 8;
constexpr std::int32_t kHeight = 7;
constexpr double kLargestRadiusCells = 1.5;
/// Cells between two samples of a path, and how far from an edge a sample says something.
constexpr double kSampleCells = 1.0 / 64;
constexpr double kEdgeCells = 1e-6;

struct Keepout {
  Cell place;
  double radius = 0.5;
  Cell pardoned;  ///< offset from the place, (1, 1) for none
};

struct Question {
  Cell from;
  Cell to;  ///< the same as from: a stay
  double radius = 0.5;
};

std::ostream& operator<<(std::ostream& out, const Keepout& keepout) {
  return out << "radius " << keepout.radius << " at " << keepout.place << ", pardoned (x + "
             << keepout.pardoned.x - 1 << ", y + " << keepout.pardoned.y - 1 << ")";
}

std::ostream& operator<<(std::ostream& out, const Question& question) {
  return out << question.from << " -> " << question.to << " radius " << question.radius;
}

Vec2 pardoned_place(const Keepout& keepout) {
  return centre({keepout.place.x + keepout.pardoned.x - 1, keepout.place.y + keepout.pardoned.y - 1});
}

rc::Gen<Keepout> any_keepout() {
  return rc::gen::build<Keepout>(rc::gen::set(&Keepout::place, any_cell(kWidth, kHeight)),
                                 rc::gen::set(&Keepout::radius, any_of({0.5, 0.25, 0.75, 1.0, 1.5})),
                                 rc::gen::set(&Keepout::pardoned, any_cell(4, 4)));
}

rc::Gen<Question> any_question() {
  return rc::gen::build<Question>(rc::gen::set(&Question::from, any_cell(kWidth, kHeight)),
                                  rc::gen::set(&Question::to, any_cell(kWidth, kHeight)),
                                  rc::gen::set(&Question::radius, any_of({0.5, 0.25, 0.75, 1.0, 1.5})));
}

template <class Value>
rc::Gen<std::vector<Value>> up_to(std::size_t most, const rc::Gen<Value>& any) {
  return rc::gen::mapcat(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, most + 1)),
      [any](std::size_t count) { return rc::gen::container<std::vector<Value>>(count, any); });
}

enum class Verdict { kIntrudes, kKeepsAway, kNearTheEdge };

/// What samples of the path say about one keepout.
Verdict sampled(const Keepout& keepout, const Question& question) {
  const double reach = keepout.radius + question.radius;
  const Vec2 from = centre(question.from);
  const Vec2 path = centre(question.to) - from;
  const auto steps = static_cast<int>(std::ceil(norm(path) / kSampleCells));
  bool away = true;
  for (int i = 0; i <= steps; ++i) {
    const Vec2 here = from + path * (steps == 0 ? 0.0 : static_cast<double>(i) / steps);
    const double to_place = norm(here - centre(keepout.place));
    const double to_pardoned = norm(here - pardoned_place(keepout));
    if (to_place < reach - kEdgeCells && to_pardoned > reach + kEdgeCells) return Verdict::kIntrudes;
    const double missed = steps == 0 ? 0 : kSampleCells;  // between two samples
    away = away && (to_place >= reach + missed || to_pardoned <= reach - missed - kEdgeCells);
  }
  if (away) return Verdict::kKeepsAway;
  // A straight move that touches: where it comes nearest is known.
  const Leg leg{from, centre(question.to), 0, 1};
  const bool touches = closest_approach(leg, leg_at(centre(keepout.place))) >= reach;
  return touches ? Verdict::kKeepsAway : Verdict::kNearTheEdge;
}

std::vector<SafeInterval> safe_intervals(ReservationTable& table, const Question& question) {
  const std::span<const SafeInterval> safe = table.safe_intervals(question.from, question.radius);
  return {safe.begin(), safe.end()};
}

/// When the robot may leave, or stay from, at time 0 with nothing else on the map.
bool may_go(ReservationTable& table, const Question& question) {
  if (question.from == question.to) {
    const std::vector<SafeInterval> safe = safe_intervals(table, question);
    RC_ASSERT(safe.empty() || safe == std::vector<SafeInterval>{SafeInterval{}});
    return !safe.empty();
  }
  const Move move(Displacement(centre(question.from), centre(question.to)), 1.0);
  const double departure_s = table.earliest_departure(move, question.radius, 0, kForever);
  RC_ASSERT(departure_s == 0 || departure_s == kForever);
  return departure_s == 0;
}

void agrees_with_samples(const std::vector<Keepout>& keepouts, const std::vector<Question>& questions) {
  const GridMap map(kWidth, kHeight);
  ReservationTable table(map, kLargestRadiusCells);
  for (const Keepout& keepout : keepouts) {
    table.add_keepout(centre(keepout.place), keepout.radius, pardoned_place(keepout));
  }
  int refused = 0;
  int pardoned = 0;
  for (const Question& question : questions) {
    bool intrudes = false;
    bool away = true;
    for (const Keepout& keepout : keepouts) {
      const Verdict verdict = sampled(keepout, question);
      intrudes = intrudes || verdict == Verdict::kIntrudes;
      away = away && verdict == Verdict::kKeepsAway;
      const double nearest =
          closest_approach({centre(question.from), centre(question.to), 0, 1}, leg_at(centre(keepout.place)));
      pardoned += verdict == Verdict::kKeepsAway && nearest < keepout.radius + question.radius - kEdgeCells;
    }
    RC_LOG() << question.from << " -> " << question.to << " radius " << question.radius << std::endl;
    if (intrudes) RC_ASSERT(!may_go(table, question));
    if (away) RC_ASSERT(may_go(table, question));
    refused += intrudes;
  }
  table.clear_keepouts();
  for (const Question& question : questions) RC_ASSERT(may_go(table, question));
  RC_CLASSIFY(refused > 0, "some refused");
  RC_CLASSIFY(pardoned > 0, "some pardoned");
}

const PropertyRoom room("keepouts", [] {
  bool passed = true;

  passed &=
      property("add_keepout: paths and stays within reach are refused, but for those in what is pardoned",
               [] { agrees_with_samples(*up_to(3, any_keepout()), *up_to(24, any_question())); });

  passed &= property("add_keepout: changes nothing for those who keep away", [] {
    const Walk walk = *any_walk(kWidth, kHeight);
    const Keepout keepout = *any_keepout();
    const GridMap map(kWidth, kHeight);
    ReservationTable free(map, kLargestRadiusCells);
    ReservationTable kept(map, kLargestRadiusCells);
    free.add(walk.trajectory(), walk.radius);
    kept.add(walk.trajectory(), walk.radius);
    kept.add_keepout(centre(keepout.place), keepout.radius, pardoned_place(keepout));
    for (const Question& question : *up_to(24, any_question())) {
      const Verdict verdict = sampled(keepout, question);
      if (verdict == Verdict::kNearTheEdge) continue;
      const bool away = verdict == Verdict::kKeepsAway;
      if (question.from == question.to) {
        const auto expected = away ? safe_intervals(free, question) : std::vector<SafeInterval>{};
        RC_ASSERT(safe_intervals(kept, question) == expected);
        continue;
      }
      const Move move(Displacement(centre(question.from), centre(question.to)), 1.0);
      const double expected_s = away ? free.earliest_departure(move, question.radius, 0, kForever) : kForever;
      RC_ASSERT(kept.earliest_departure(move, question.radius, 0, kForever) == expected_s);
    }
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::keepouts_laws
