// Pairs of bodies in interval arithmetic; see validator.hpp.
#include "sipplab/validator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "planner/core/tolerances.hpp"
#include "planner/validator/enclosure.hpp"

namespace sipplab {
namespace {

constexpr double kForeverS = std::numeric_limits<double>::infinity();

/// A span of uniform motion, or of rest if the two cells are equal.
struct Leg {
  double begin_s = 0;
  double end_s = kForeverS;
  Cell from;
  Cell to;
};

/// The cells between which a centre stays.
struct Box {
  Cell low;
  Cell high;
};

Box box_around(Cell a, Cell b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

Box box_around(Box a, Box b) { return {box_around(a.low, b.low).low, box_around(a.high, b.high).high}; }

/// A body from time 0 to infinity, without gaps.
struct Life {
  Enclosure radius_cells;
  std::vector<Leg> legs;
  Box box;
};

/// Nothing if motions do not follow each other exactly.
std::optional<Life> make_life(const Trajectory& trajectory, double radius_cells) {
  Life life;
  life.radius_cells = Enclosure(radius_cells);
  life.box = {trajectory.start, trajectory.start};
  double now_s = 0;
  Cell place = trajectory.start;
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s != now_s || motion.from != place || !std::isfinite(motion.end_s)) return std::nullopt;
    if (motion.is_wait() && motion.end_s == motion.begin_s) continue;
    if (!(motion.end_s > motion.begin_s)) return std::nullopt;
    life.legs.push_back({motion.begin_s, motion.end_s, motion.from, motion.to});
    life.box = box_around(life.box, box_around(motion.from, motion.to));
    now_s = motion.end_s;
    place = motion.to;
  }
  life.legs.push_back({now_s, kForeverS, place, place});
  return life;
}

/// The line from one centre to the other.
struct Way {
  Enclosure x;
  Enclosure y;
};

Way operator-(const Way& a, const Way& b) { return {a.x - b.x, a.y - b.y}; }
Enclosure dot(const Way& a, const Way& b) { return a.x * b.x + a.y * b.y; }
Enclosure cross(const Way& a, const Way& b) { return a.x * b.y - a.y * b.x; }
Enclosure squared_length(const Way& a) { return square(a.x) + square(a.y); }

/// Cell coordinates and their differences are exact in a double.
Enclosure coordinate(double from, double to, Enclosure part) {
  if (part.high == 0) return Enclosure(from);
  if (part.low == 1) return Enclosure(to);
  return Enclosure(from) + Enclosure(to - from) * part;
}

Way place_at(const Leg& leg, double time_s) {
  Enclosure part;
  if (time_s >= leg.end_s) {
    part = Enclosure(1);
  } else if (time_s > leg.begin_s && leg.from != leg.to) {
    part = (Enclosure(time_s) - Enclosure(leg.begin_s)) / (Enclosure(leg.end_s) - Enclosure(leg.begin_s));
  }
  return {coordinate(leg.from.x, leg.to.x, part), coordinate(leg.from.y, leg.to.y, part)};
}

/// Cells between two boxes along the axis on which they are farther apart. Exact.
double gap_cells(const Box& a, const Box& b) {
  const auto gap = [](std::int32_t low_a, std::int32_t high_a, std::int32_t low_b, std::int32_t high_b) {
    return std::max(static_cast<double>(low_a) - high_b, static_cast<double>(low_b) - high_a);
  };
  return std::max(gap(a.low.x, a.high.x, b.low.x, b.high.x), gap(a.low.y, a.high.y, b.low.y, b.high.y));
}

/// One pair of bodies. Distances are compared with the least one that counts as safe.
class PairProof {
 public:
  PairProof(Enclosure radius_a_cells, Enclosure radius_b_cells)
      : contact_cells_(radius_a_cells + radius_b_cells),
        least_cells_(contact_cells_ - Enclosure(kValidatorToleranceCells)),
        least_squared_(square({std::max(0.0, least_cells_.low), std::max(0.0, least_cells_.high)})) {}

  bool far_apart(const Box& a, const Box& b) const { return gap_cells(a, b) >= least_cells_.high; }

  /// Decides a span during which both bodies are on these legs.
  void add(const Leg& a, const Leg& b, double begin_s, double end_s) {
    // After both have come to rest one time stands for all.
    if (end_s == kForeverS) end_s = begin_s;
    waiting_.assign(1, {begin_s, end_s});
    int parts = 1;
    while (!waiting_.empty()) {
      const Span span = waiting_.back();
      waiting_.pop_back();
      const Way first = apart(a, b, span.begin_s);
      const Way last = apart(a, b, span.end_s);
      if (is_safe(first, last)) continue;
      if (find_collision(a, b, span, first, last)) return;
      const double middle_s = span.begin_s + (span.end_s - span.begin_s) / 2;
      const bool divisible = span.begin_s < middle_s && middle_s < span.end_s;
      if (!divisible || parts == kCertifiedParts) {
        undecided_ = true;
        return;
      }
      ++parts;
      waiting_.push_back({span.begin_s, middle_s});
      waiting_.push_back({middle_s, span.end_s});
    }
  }

  /// A proven collision counts, whatever else stays open.
  PairVerdict verdict() const {
    if (collision_.certificate == PairCertificate::kCollision) return collision_;
    return {undecided_ ? PairCertificate::kUndecided : PairCertificate::kSafe, 0, 0};
  }

 private:
  struct Span {
    double begin_s;
    double end_s;
  };

  static Way apart(const Leg& a, const Leg& b, double time_s) {
    return place_at(a, time_s) - place_at(b, time_s);
  }

  /// While both move uniformly, the line between them runs straight from `first` to
  /// `last`. Is all of that segment far enough from the origin?
  bool is_safe(const Way& first, const Way& last) const {
    if (least_cells_.high <= 0) return true;  // bodies so small that no overlap is too deep
    const Enclosure at_first = squared_length(first);
    if (!certainly_at_least(at_first, least_squared_)) return false;
    if (!certainly_at_least(squared_length(last), least_squared_)) return false;
    const Way change = last - first;
    // Away from the origin all along, or towards it all along: an end is nearest.
    if (dot(first, change).low >= 0 || dot(last, change).high <= 0) return true;
    // The line through both is far enough: its distance is |first x change| / |change|.
    // Where the two ends are one, the line has no distance, but the end was far enough.
    const Enclosure length_squared = squared_length(change);
    if (certainly_at_least(square(cross(first, change)), least_squared_ * length_squared)) return true;
    // Too little change to come nearer by what is left.
    return certainly_at_least(square_root(at_first) - square_root(length_squared), least_cells_);
  }

  /// Where the bodies seem nearest is guessed; what is certain then is computed.
  bool find_collision(const Leg& a, const Leg& b, const Span& span, const Way& first, const Way& last) {
    const Vec2 from{first.x.guess(), first.y.guess()};
    const Vec2 change{last.x.guess() - from.x, last.y.guess() - from.y};
    const double length_squared = squared_norm(change);
    const double part =
        length_squared > 0 ? std::clamp(-sipplab::dot(from, change) / length_squared, 0.0, 1.0) : 0.0;
    const double nearest_s =
        std::clamp(span.begin_s + part * (span.end_s - span.begin_s), span.begin_s, span.end_s);
    bool found = false;
    for (const double time_s : {nearest_s, span.begin_s, span.end_s}) {
      const Enclosure distance_cells = square_root(squared_length(apart(a, b, time_s)));
      if (!certainly_less(distance_cells, least_cells_)) continue;
      found = true;
      const double depth_cells = (contact_cells_ - distance_cells).low;
      if (depth_cells > collision_.depth_cells)
        collision_ = {PairCertificate::kCollision, time_s, depth_cells};
    }
    return found;
  }

  Enclosure contact_cells_;
  Enclosure least_cells_;
  Enclosure least_squared_;
  std::vector<Span> waiting_;
  bool undecided_ = false;
  PairVerdict collision_;
};

PairVerdict certify_lives(const Life& a, const Life& b) {
  PairProof proof(a.radius_cells, b.radius_cells);
  if (proof.far_apart(a.box, b.box)) return {PairCertificate::kSafe, 0, 0};
  auto leg_a = a.legs.begin();
  auto leg_b = b.legs.begin();
  double now_s = 0;
  while (leg_a != a.legs.end() && leg_b != b.legs.end()) {
    const double until_s = std::min(leg_a->end_s, leg_b->end_s);
    if (!proof.far_apart(box_around(leg_a->from, leg_a->to), box_around(leg_b->from, leg_b->to))) {
      proof.add(*leg_a, *leg_b, now_s, until_s);
    }
    now_s = until_s;
    if (leg_a->end_s == until_s) ++leg_a;
    if (leg_b->end_s == until_s) ++leg_b;
  }
  return proof.verdict();
}

}  // namespace

std::string_view name(PairCertificate certificate) {
  constexpr std::string_view kNames[] = {"safe", "collision", "undecided"};
  return kNames[static_cast<std::size_t>(certificate)];
}

PairVerdict certify_pair(const Trajectory& a, double radius_a_cells, const Trajectory& b,
                         double radius_b_cells) {
  const std::optional<Life> life_a = make_life(a, radius_a_cells);
  const std::optional<Life> life_b = make_life(b, radius_b_cells);
  if (!life_a || !life_b) return {};
  return certify_lives(*life_a, *life_b);
}

Certification certify(const Instance& instance, const Solution& solution, std::size_t max_findings) {
  const std::size_t agents = instance.agents.size();
  std::vector<std::optional<Life>> lives;
  lives.reserve(agents + instance.obstacles.size());
  for (AgentIndex i = 0; i < agents; ++i) {
    lives.push_back(i < solution.trajectories.size()
                        ? make_life(solution.trajectories[i], instance.agents[i].radius_cells)
                        : std::nullopt);
  }
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    lives.push_back(make_life(obstacle.trajectory, obstacle.radius_cells));
  }

  Certification result;
  for (AgentIndex i = 0; i < agents; ++i) {
    for (std::size_t j = i + 1; j < lives.size(); ++j) {
      const PairVerdict verdict = lives[i] && lives[j] ? certify_lives(*lives[i], *lives[j]) : PairVerdict{};
      if (verdict.certificate == PairCertificate::kSafe) {
        ++result.safe;
        continue;
      }
      ++(verdict.certificate == PairCertificate::kCollision ? result.collisions : result.undecided);
      if (result.findings.size() >= max_findings) continue;
      const bool with_obstacle = j >= agents;
      result.findings.push_back({i, with_obstacle ? j - agents : j, with_obstacle, verdict});
    }
  }
  return result;
}

}  // namespace sipplab
