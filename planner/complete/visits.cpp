#include "planner/complete/visits.hpp"

namespace sipplab {

Visits::Visits(const std::vector<Configuration>& steps, std::size_t cells) {
  if (steps.empty()) return;
  std::vector<VisitId> last_at(cells, kNoVisit);
  std::vector<VisitId> last_of(steps.front().size(), kNoVisit);
  for (const Configuration& step : steps) {
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

}  // namespace sipplab
