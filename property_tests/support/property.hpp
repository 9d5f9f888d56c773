// One property: checked by rapidcheck, summed up on stderr, and kept in a log that
// the history can take in (`sipplab property record`).
#pragma once

#include <rapidcheck.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "planner/io/plan_case.hpp"

namespace sipplab {

// Cases of a property that does not say how many, if RC_PARAMS does not. property_tests/CMakeLists.txt sets
// the share.
inline constexpr int kCasesOfWorlds = 1000 / SIPPLAB_SHARE_OF_CASES;
/// Each opens files and migrates them, which takes 5 to 35 ms.
inline constexpr int kCasesOfHistories = 200 / SIPPLAB_SHARE_OF_CASES;

/// The properties of one file, run by `properties NAME`. Registers itself; `run` says whether all held.
class PropertyRoom {
 public:
  PropertyRoom(const char* name, bool (*run)()) : PropertyRoom(name, kCasesOfWorlds, run) {}
  PropertyRoom(const char* name, int cases, bool (*run)());
};

/// Runs the room that `arguments` name: 0 if all of it held, 1 if not, kNoSuchProperty
/// (bench/campaigns/replay.hpp) if there is no such room, 2 for anything but one name.
int run_room(std::span<const char* const> arguments);

/// Use property() below. Not a template, so that rapidcheck's machinery is compiled once.
bool run_property(const std::string& title, const std::function<void()>& testable, std::optional<int> cases);

/// Checks a property with the parameters of RC_PARAMS and prints how it went: cases,
/// the share of each class, and for a failure the smallest counterexample with the
/// RC_PARAMS that lead to it. True when it held.
///
/// Where the environment variable SIPPLAB_PROPERTY_LOG names a file, one line is
/// appended to it; property_log.hpp says what is in it.
///
/// With "reproduce=..." in RC_PARAMS, only the counterexamples that it holds are tried:
/// nothing is drawn or logged, and properties that it does not name hold. A room that has
/// none of those named ends with kNoSuchProperty (bench/campaigns/replay.hpp).
///
/// `cases` are tried if RC_PARAMS names no number; those of the room if it is empty. With
/// SIPPLAB_ONE_CASE_OF=N in the environment one of N of these is tried, and at least one.
template <class Testable>
bool property(const std::string& title, Testable testable, std::optional<int> cases = std::nullopt) {
  static_assert(std::is_void_v<std::invoke_result_t<Testable&>>,
                "a property asserts; what it returns is lost");
  return run_property(title, std::move(testable), cases);
}

/// What `make` draws, at full size from the first case on: a hundred cases say as much as the last hundred of
/// a thousand.
template <class Make>
auto at_full_size(Make&& make) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::exec(std::forward<Make>(make)));
}

/// Says which case this property plans, if that is not the case that it drew: the
/// log then holds this one.
void note_case(const PlanCase& plan_case);

}  // namespace sipplab
