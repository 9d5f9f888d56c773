// Pieces of AA-SIPP(m)'s XML that instances and solutions have in common.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "planner/instance/instance.hpp"
#include "planner/prioritized/options.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// The text with everything escaped that would not survive reading.
void append_escaped(std::string& out, std::string_view text);

/// ` name="value"`, escaped.
void append_attribute(std::string& out, std::string_view name, std::string_view value);
void append_attribute(std::string& out, std::string_view name, double value);
void append_attribute(std::string& out, std::string_view name, std::int64_t value);

/// Each one tab deep: <agents>; <map>; <dynamicobstacles>, where there are any; all three.
void append_agents_xml(std::string& out, const Instance& instance);
void append_map_xml(std::string& out, const GridMap& map);
void append_obstacles_xml(std::string& out, const Instance& instance);
void append_instance_xml(std::string& out, const Instance& instance);

/// <algorithm>, one tab deep. Limits but that of time have no place there.
void append_options_xml(std::string& out, const PlannerOptions& options);

/// One <section> a motion, each with its duration and with begin and end, exact; with the
/// headings at both ends where that at the beginning is given.
void append_sections(std::string& out, const Trajectory& trajectory, std::string_view indent,
                     std::optional<double> start_heading_deg = std::nullopt);

}  // namespace sipplab
