#include "bench/judge/case_words.hpp"

#include <fmt/format.h>

#include <algorithm>

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
  return names;
}

}  // namespace sipplab::bench
