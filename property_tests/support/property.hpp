// One property: checked by rapidcheck, summed up on stderr, and kept in a log that
// the history can take in (`sipplab property record`).
#pragma once

#include <rapidcheck.h>

#include <string>
#include <utility>

#include "planner/io/plan_case.hpp"

// Set for each program by property_tests/CMakeLists.txt.
#ifndef SIPPLAB_PROPERTY_ROOM
#define SIPPLAB_PROPERTY_ROOM ""
#define SIPPLAB_PROPERTY_CASES 1000
#endif

namespace sipplab {

/// Use property() below. Not a template, so that rapidcheck's machinery is compiled once.
/// `cases` are tried if RC_PARAMS names no number.
bool run_property(const std::string& room, int cases, const std::string& title,
                  const rc::detail::Property& property);

/// Checks a property with the parameters of RC_PARAMS and prints how it went: cases,
/// the share of each class, and for a failure the smallest counterexample with the
/// RC_PARAMS that lead to it. True when it held.
///
/// Where the environment variable SIPPLAB_PROPERTY_LOG names a file, one line is
/// appended to it; property_log.hpp says what is in it.
///
/// With "reproduce=..." in RC_PARAMS, only the counterexamples that it holds are tried:
/// nothing is drawn or logged, and properties that it does not name hold. A program that has
/// none of those that are named ends with kNoSuchProperty (bench/campaigns/replay.hpp).
template <class Testable>
bool property(const std::string& title, Testable&& testable, int cases = SIPPLAB_PROPERTY_CASES) {
  return run_property(SIPPLAB_PROPERTY_ROOM, cases, title,
                      rc::detail::toProperty(std::forward<Testable>(testable)));
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
