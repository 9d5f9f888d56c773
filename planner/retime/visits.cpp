#include "planner/retime/visits.hpp"

#include <algorithm>
#include <limits>

namespace sipplab {

Visits::Visits(const std::vector<std::vector<CellId>>& steps, std::size_t cells) {
  if (steps.empty()) return;
  std::vector<VisitId> last_at(cells, kNoVisit);
  std::vector<VisitId> last_of(steps.front().size(), kNoVisit);
  std::size_t size = last_of.size();
  for (std::size_t i = 1; i < steps.size(); ++i) {
    for (RobotId robot = 0; robot < last_of.size(); ++robot) size += steps[i][robot] != steps[i - 1][robot];
  }
  visits_.reserve(size);
  for (const std::vector<CellId>& step : steps) {
    for (RobotId robot = 0; robot < step.size(); ++robot) {
      const CellId cell = step[robot];
      const VisitId before = last_of[robot];
      if (before != kNoVisit && visits_[before].cell == cell) continue;
      const auto id = static_cast<VisitId>(visits_.size());
      const VisitId before_here = last_at[cell];
      visits_.push_back({cell, robot, before, kNoVisit, before_here, kNoVisit});
      if (before != kNoVisit) visits_[before].after = id;
      if (before_here != kNoVisit) visits_[before_here].after_here = id;
      last_of[robot] = id;
      last_at[cell] = id;
    }
  }
  for (RobotId robot = 0; robot < steps.front().size(); ++robot) first_.push_back(robot);
}

void Visits::remove_round_trips() {
  std::vector<VisitId> to_look_at;
  for (VisitId id = 0; id < visits_.size(); ++id) {
    to_look_at.push_back(id);
    while (!to_look_at.empty()) {
      const VisitId earlier = to_look_at.back();
      const VisitId later = visits_[earlier].after_here;
      if (later == kNoVisit || visits_[later].robot != visits_[earlier].robot) {
        to_look_at.pop_back();
      } else {
        join(earlier, later, to_look_at);
      }
    }
  }
}

/// Makes one visit of the two, and takes out those between.
void Visits::join(VisitId earlier, VisitId later, std::vector<VisitId>& to_look_at) {
  VisitId removed = visits_[earlier].after;
  const VisitId after = visits_[later].after;
  while (removed != after) {
    Visit& visit = visits_[removed];
    if (visit.before_here != kNoVisit) {
      visits_[visit.before_here].after_here = visit.after_here;
      to_look_at.push_back(visit.before_here);
    }
    if (visit.after_here != kNoVisit) visits_[visit.after_here].before_here = visit.before_here;
    visit.before_here = visit.after_here = kNoVisit;
    removed = visit.after;
  }
  visits_[earlier].after = after;
  if (after != kNoVisit) visits_[after].before = earlier;
}

void VisitCollector::add_robot(CellId cell) {
  const auto id = static_cast<VisitId>(visits_.visits_.size());
  const auto robot = static_cast<RobotId>(visits_.first_.size());
  visits_.first_.push_back(id);
  visits_.visits_.push_back({cell, robot, kNoVisit, kNoVisit, kNoVisit, kNoVisit});
  stays_.push_back({0, std::numeric_limits<double>::infinity()});
}

void VisitCollector::add_move(CellId cell, double begin_s, double end_s) {
  const auto id = static_cast<VisitId>(visits_.visits_.size());
  Visit& before = visits_.visits_.back();
  before.after = id;
  stays_.back().end_s = begin_s;
  const RobotId robot = before.robot;
  visits_.visits_.push_back({cell, robot, id - 1, kNoVisit, kNoVisit, kNoVisit});
  stays_.push_back({end_s, std::numeric_limits<double>::infinity()});
}

std::optional<Visits> VisitCollector::take() && {
  std::vector<Visit>& visits = visits_.visits_;
  std::vector<std::uint32_t> begins(cells_ + 1, 0);
  for (const Visit& visit : visits) ++begins[visit.cell + 1];
  for (std::size_t cell = 0; cell < cells_; ++cell) begins[cell + 1] += begins[cell];
  std::vector<VisitId> at(visits.size());
  std::vector<std::uint32_t> next(begins.begin(), begins.end() - 1);
  for (VisitId id = 0; id < visits.size(); ++id) at[next[visits[id].cell]++] = id;
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    const auto first = at.begin() + begins[cell];
    const auto last = at.begin() + begins[cell + 1];
    std::sort(first, last, [&](VisitId a, VisitId b) {
      if (stays_[a].begin_s != stays_[b].begin_s) return stays_[a].begin_s < stays_[b].begin_s;
      return a < b;
    });
    for (auto visit = first; visit != last && visit + 1 != last; ++visit) {
      const VisitId earlier = visit[0];
      const VisitId later = visit[1];
      if (!(stays_[earlier].end_s <= stays_[later].begin_s) || visits[earlier].after == kNoVisit ||
          visits[later].before == kNoVisit) {
        return std::nullopt;
      }
      visits[earlier].after_here = later;
      visits[later].before_here = earlier;
    }
  }
  return std::move(visits_);
}

}  // namespace sipplab
