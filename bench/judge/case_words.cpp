#include "bench/judge/case_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/sweep/sweep_case.hpp"
#include "sipplab/options.hpp"

namespace sipplab::bench {
namespace {

/// A part of the name; the first two are always there.
using Part = std::string (*)(const db::CaseInfo&);
const Part kParts[] = {
    [](const db::CaseInfo& c) { return place_name(c.map_spec, c.environment); },
    [](const db::CaseInfo& c) { return fmt::format("{} robots", c.robots); },
    [](const db::CaseInfo& c) { return "ssi " + format_ssi(c.real("ssi_s")); },
    [](const db::CaseInfo& c) { return c.text("reschedule"); },
    [](const db::CaseInfo& c) { return c.text("initial_order"); },
    [](const db::CaseInfo& c) { return c.planner; },
    [](const db::CaseInfo& c) { return fmt::format("seed {}", std::get<std::int64_t>(c.option("seed"))); },
};
constexpr std::size_t kAlwaysThere = 2;

/// "at most 2 s", "no time limit".
std::string limit_words(const db::Value& limit, const char* unit, const char* none) {
  if (const auto* count = std::get_if<std::int64_t>(&limit)) {
    return *count == static_cast<std::int64_t>(db::kNoCountLimit)
               ? none
               : fmt::format("at most {} {}", *count, unit);
  }
  const auto* number = std::get_if<double>(&limit);
  return number == nullptr || std::isinf(*number) ? none : fmt::format("at most {} {}", *number, unit);
}

/// What is said of cases that would have one name otherwise, where they differ in it.
const Part kDetails[] = {
    [](const db::CaseInfo& c) { return limit_words(c.option("time_limit_s"), "s", "no time limit"); },
    [](const db::CaseInfo& c) {
      return limit_words(c.option("max_expansions"), "expansions", "any expansions");
    },
    [](const db::CaseInfo& c) { return limit_words(c.option("max_restarts"), "restarts", "any restarts"); },
    [](const db::CaseInfo& c) { return "instances " + c.instance_set; },
    [](const db::CaseInfo& c) { return fmt::format("radius {}", c.radius_cells); },
    [](const db::CaseInfo& c) { return fmt::format("speed {}", c.speed_cells_per_s); },
};

void tell_apart(const std::vector<db::CaseInfo>& cases, std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::size_t>> namesakes;
  for (std::size_t i = 0; i < names.size(); ++i) namesakes[names[i]].push_back(i);
  for (const auto& [name, alike] : namesakes) {
    for (const Part detail : kDetails) {
      const std::string first = detail(cases[alike.front()]);
      const bool differs =
          std::any_of(alike.begin(), alike.end(), [&](std::size_t i) { return detail(cases[i]) != first; });
      if (!differs) continue;
      for (const std::size_t i : alike) names[i] += ", " + detail(cases[i]);
    }
  }
}

}  // namespace

std::vector<std::string> case_words(const std::vector<db::CaseInfo>& cases) {
  std::vector<std::string> names(cases.size());
  for (std::size_t part = 0; part < std::size(kParts); ++part) {
    const bool varies =
        cases.size() == 1 || part < kAlwaysThere ||
        std::any_of(cases.begin(), cases.end(), [&cases, part](const db::CaseInfo& parameters) {
          return kParts[part](parameters) != kParts[part](cases.front());
        });
    if (!varies) continue;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      names[i] += (names[i].empty() ? "" : ", ") + kParts[part](cases[i]);
    }
  }
  tell_apart(cases, names);
  return names;
}

}  // namespace sipplab::bench
