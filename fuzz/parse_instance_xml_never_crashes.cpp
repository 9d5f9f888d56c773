// Claim: no bytes, taken as XML of AA-SIPP(m) or of the archive (whole, or a task, map,
// config or obstacles alone), make the reader crash or take memory that they are not due;
// refusals and warnings are one line each, and an instance that is accepted reads back equal.
#include <string>
#include <utility>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/write_instance.hpp"
#include "planner/io/xml_instance.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// What a map-less file holds is written with this map, to be read back.
Instance joined(const InstanceParts& parts) {
  Instance instance;
  if (parts.map) instance.map = parts.map->map;
  if (parts.agents) instance.agents = parts.agents->items;
  if (parts.obstacles) instance.obstacles = parts.obstacles->items;
  return instance;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const auto parts = fuzz::read_checked(text, [&] { return parse_xml_instance(text, "fuzz.xml"); });
  if (!parts) return 0;
  for (const std::string& warning : parts->warnings) fuzz::check_warning(warning);
  if (parts->agents) {
    fuzz::require(Claim::kReadsBackEqual, parts->agents->items.size() == parts->agents->lines.size(),
                  "robots without a line");
  }
  const Instance instance = joined(*parts);
  const auto again = parse_xml_instance(write_instance_xml(instance), "again.xml");
  fuzz::require(Claim::kReadsBackEqual, again && again->warnings.empty() && joined(*again) == instance,
                "an instance reads back as another");
  return 0;
}
