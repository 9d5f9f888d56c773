// Cases and scenes for rapidcheck, with shrinking in the problem's own terms and
// counts of what was drawn.
#pragma once

#include <rapidcheck.h>

#include "property_tests/support/case_maker.hpp"
#include "property_tests/support/scene_maker.hpp"

namespace sipplab {

/// Cases of all families.
rc::Gen<PlanCase> any_case();
/// Cases of one family.
rc::Gen<PlanCase> any_case_of(CaseFamily family);
/// Cases of all families for robots with headings, delays and inflations.
rc::Gen<PlanCase> any_turning_case();

rc::Gen<Scene> any_scene();

/// Counts the case in rapidcheck's report by what is notable in it.
void classify_case(const PlanCase& plan_case);

}  // namespace sipplab
