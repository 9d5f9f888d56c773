// The exact tier: the same instance, options and seed must give the same status, plan and
// counts of work, whatever the machine. A difference is a change of behaviour.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "db/records.hpp"

namespace sipplab::bench {

enum class ChangeKind {
  kStatus,      ///< solved by one, not by the other
  kValidity,    ///< a plan that the validator rejected, in one of them
  kPlan,        ///< another plan
  kWork,        ///< the same plan, found with other expansions, generations or tries
  kRepetition,  ///< a build that differs from itself when it plans again
};
/// "status", "validity", "plan", "work", "repetition".
std::string_view name(ChangeKind kind);

struct Change {
  ChangeKind kind = ChangeKind::kPlan;
  std::string base;  ///< "solved, flowtime 286.12"
  std::string head;
};

/// Whether a wall-clock limit ended the planning, or its improvement (limit "time"): the same build may give
/// another plan and other work then.
bool is_cut_short(const db::ResultRow& row);

/// What differs; a plan that differs says nothing about its work. None if all is alike.
/// Results that the clock cut short are compared in status alone.
std::optional<Change> change(const db::ResultRow& base, const db::ResultRow& head);

}  // namespace sipplab::bench
