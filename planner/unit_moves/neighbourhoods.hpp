// Which robots give up their routes, to be planned again: small sets of robots that are in each other's way.
// After Li, Chen, Harabor, Stuckey and Koenig, "Anytime Multi-Agent Path Finding via Large Neighborhood
// Search", IJCAI 2021. Nothing here takes time in proportion to the number of robots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/unit_moves/route_search.hpp"
#include "planner/unit_moves/timetable.hpp"

namespace sipplab {

enum class UnitRule : std::uint8_t {
  kBlocked,  ///< a late robot and those in its way, on its route and on a shorter one
  kPlace,    ///< robots at one place at about the same time
  kLate,     ///< late robots anywhere
};
inline constexpr std::size_t kUnitRules = 3;

class UnitNeighbourhoods {
 public:
  /// All must outlive this. REQUIRES: there are robots.
  UnitNeighbourhoods(const Timetable& plan, SharedDistances& distances);

  /// At least one and at most `most` robots, all different. REQUIRES: all have routes; most > 0.
  std::vector<RobotId> choose(UnitRule rule, std::size_t most, Random& random);

 private:
  Tick delay(RobotId robot) const { return plan_.arrival(robot) - distances_.least_arrival(robot); }
  RobotId late_robot(Random& random) const;
  void add(RobotId robot);
  bool is_full() const { return chosen_.size() >= most_; }

  void add_blockers(RobotId robot, Random& random);
  void add_on_shorter_way(RobotId robot, Random& random);
  void add_at(CellId cell, Tick begin, Tick end);
  void add_around(CellId cell, Tick time);

  const Timetable& plan_;
  SharedDistances& distances_;
  std::vector<RobotId> chosen_;
  std::size_t most_ = 0;
};

}  // namespace sipplab
