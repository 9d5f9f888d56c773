#include "bench/judge/change.hpp"

#include <fmt/format.h>

namespace sipplab::bench {
namespace {

std::string plan_text(const db::ResultRow& row) {
  return fmt::format("plan {:016x}, flowtime {:.2f}", row.plan_hash.value_or(0), row.flowtime_s.value_or(0));
}

std::string work_text(const db::ResultRow& row) {
  return fmt::format("{} tries, {} expansions, {} generations", row.tries, row.expansions, row.generations);
}

std::string validity_text(const db::ResultRow& row) {
  if (row.status == db::ResultStatus::kInvalid) return row.message.empty() ? "invalid" : row.message;
  return std::string(db::name(row.status));
}

}  // namespace

std::string_view name(ChangeKind kind) {
  constexpr std::string_view kNames[] = {"status", "validity", "plan", "work", "repetition"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_cut_short(const db::ResultRow& row) { return row.limit == "time"; }

std::optional<Change> change(const db::ResultRow& base, const db::ResultRow& head) {
  const bool base_invalid = base.status == db::ResultStatus::kInvalid;
  const bool head_invalid = head.status == db::ResultStatus::kInvalid;
  if (base_invalid != head_invalid) {
    return Change{ChangeKind::kValidity, validity_text(base), validity_text(head)};
  }
  if (base.status != head.status) {
    return Change{ChangeKind::kStatus, std::string(db::name(base.status)),
                  std::string(db::name(head.status))};
  }
  if (is_cut_short(base) || is_cut_short(head)) return std::nullopt;
  if (base.plan_hash != head.plan_hash) {
    return Change{ChangeKind::kPlan, plan_text(base), plan_text(head)};
  }
  if (base.tries != head.tries || base.expansions != head.expansions ||
      base.generations != head.generations) {
    return Change{ChangeKind::kWork, work_text(base), work_text(head)};
  }
  return std::nullopt;
}

}  // namespace sipplab::bench
