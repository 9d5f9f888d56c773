// Pieces of AA-SIPP(m)'s XML that instances and solutions have in common, as elements of pugixml.
#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "planner/options/option_table.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// Attributes. Real numbers are written in the shortest text that reads back as the same value.
void add_attribute(pugi::xml_node node, const char* name, const std::string& value);
void add_attribute(pugi::xml_node node, const char* name, double value);

/// A child that holds a text.
void add_text(pugi::xml_node parent, const char* name, const std::string& text);

/// Children of <root>: <agents>; <map>; <dynamicobstacles>, if there are any; all three.
void add_agents(pugi::xml_node root, const Instance& instance);
void add_map(pugi::xml_node root, const GridMap& map);
void add_obstacles(pugi::xml_node root, const Instance& instance);
void add_instance(pugi::xml_node root, const Instance& instance);

/// <algorithm>.
void add_options(pugi::xml_node root, const PlannerOptions& options, OptionRows rows = option_rows());

/// One <section> a motion, each with its duration and with begin and end, exact; with the
/// headings at both ends if that at the beginning is given.
void add_sections(pugi::xml_node parent, const Trajectory& trajectory,
                  std::optional<double> start_heading_deg = std::nullopt);

/// The text of a file, one element a line.
std::string file_text(const pugi::xml_document& document);

}  // namespace sipplab
