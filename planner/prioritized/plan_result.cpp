#include "sipplab/prioritized_planner.hpp"

namespace sipplab {

std::string_view name(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kFailed:
      return "failed";
    case PlanStatus::kLimit:
      return "limit";
  }
  return "unknown";
}

}  // namespace sipplab
