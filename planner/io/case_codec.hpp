// Cases as text and back. A case looks like this:
//
//     ....
//     .@..
//     robot 0 0 to 3 1
//     robot 3 0 to 0 1 radius 0.25 speed 2
//     robot 1 0 to 1 1 heading 90 goal-heading 180 rotation 0.5
//     obstacle 2 0 radius 0.5 until 1.5 at 2 0 until 3 at 3 0
//     ssi 2.5
//     order fifo
//     any-angle no
//     max-expansions 1000
//
// First the map, a blocked cell is '@'; then lines in any order, '#' begins a
// comment. Options have the names that the table of options gives them. What is not said has its default. An
// obstacle stands at its first place, then moves (or waits) `until` a time to be `at` the next.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "planner/io/plan_case.hpp"
#include "planner/options/option_table.hpp"

namespace sipplab {

/// Bounds of a case. A fuzz input has to be planned in milliseconds, and a person
/// has to see what is going on.
inline constexpr std::size_t kMaxCaseSide = 48;
inline constexpr std::size_t kMaxCaseRobots = 64;
inline constexpr std::size_t kMaxCaseObstacles = 16;
inline constexpr std::size_t kMaxCaseMotions = 64;

/// The case that the text describes; nothing when it has a line that is not
/// understood or goes beyond the bounds. The instance need not keep the rules of
/// find_error. The wall-clock limit is infinite, so that plans can be repeated.
std::optional<PlanCase> decode_case(std::string_view text, OptionRows table = option_rows());

/// Text that decode_case reads back as the same case, except for what it leaves
/// out: ids and the wall-clock limit.
std::string encode_case(const PlanCase& plan_case, OptionRows table = option_rows());

}  // namespace sipplab
