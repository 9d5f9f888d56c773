// Relations between plans that one might expect and that need not hold: prioritized
// planning is not complete, and any-angle SIPP is not optimal. Their rates are measured
// instead of asserted, so that drift shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/io/plan_case.hpp"
#include "planner/solve/plan.hpp"

namespace sipplab {

/// A case and its plan.
struct Planned {
  PlanCase plan_case;
  PlanResult result;

  bool solved() const { return result.status == PlanStatus::kSolved; }
};

Planned plan_of(PlanCase plan_case);

struct Relation {
  std::string title;  ///< a sentence
  /// Whether it holds for the case; nothing if it does not apply, or if a limit
  /// ended a plan first. Draws what it has to choose.
  std::optional<bool> (*holds)(const Planned& planned, Random& random);
};

const std::vector<Relation>& soft_relations();

}  // namespace sipplab
