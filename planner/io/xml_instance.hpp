// AA-SIPP(m)'s XML and the older one of the AAMAS 2018 archive, from memory.
#pragma once

#include <string>
#include <string_view>

#include "planner/io/instance_parts.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

/// Whatever parts <root> holds, in either dialect (the older one keeps <width> and
/// <startx> lists inside <map>). A written <log> is passed over. Unknown tags and
/// attributes become warnings, values that do not parse are errors. Agents are not
/// yet checked against a map.
Input<InstanceParts> parse_xml_instance(std::string_view text, const std::string& file_name);

}  // namespace sipplab
