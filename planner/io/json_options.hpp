// A planner option as a value of JSON: a number, a truth value, a text, or "inf".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/options/option_table.hpp"

namespace sipplab {

/// Text of a JSON value that option_from_json() takes back.
std::string option_to_json(const Option& option, const PlannerOptions& options);

/// False, and nothing is changed, if the value is no value of this option.
bool option_from_json(const Option& option, const nlohmann::json& value, PlannerOptions& options);

}  // namespace sipplab
