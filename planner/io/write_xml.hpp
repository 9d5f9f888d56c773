// Pieces of AA-SIPP(m)'s XML that instances and solutions have in common.
#pragma once

#include <string>
#include <string_view>

#include "planner/instance/instance.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// The text with everything escaped that would not survive reading.
void append_escaped(std::string& out, std::string_view text);

/// ` name="value"`, escaped.
void append_attribute(std::string& out, std::string_view name, std::string_view value);
void append_attribute(std::string& out, std::string_view name, double value);
void append_attribute(std::string& out, std::string_view name, std::int64_t value);

/// <agents>, <map> and, where there are any, <dynamicobstacles>, one tab deep.
void append_instance_xml(std::string& out, const Instance& instance);

/// One <section> a motion, each with its duration and with begin and end, exact.
void append_sections(std::string& out, const Trajectory& trajectory, std::string_view indent);

}  // namespace sipplab
