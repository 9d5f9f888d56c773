// <algorithm> and <options> of AA-SIPP(m)'s XML.
#pragma once

#include <optional>

#include "planner/io/instance_parts.hpp"
#include "planner/io/xml_reader.hpp"

namespace sipplab {

/// What the two elements under <root> state; nothing if neither is there. Errors
/// go to the reader.
std::optional<OptionsPart> read_options(XmlReader& reader, OptionRows rows = option_rows());

}  // namespace sipplab
