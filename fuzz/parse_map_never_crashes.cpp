// Claim: no bytes, taken as a map, a scenario or an XML file, make a parser crash, and
// whatever is refused is refused in one line. A map that is accepted reads back equal.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "planner/io/movingai.hpp"
#include "planner/io/write_instance.hpp"
#include "planner/io/xml_instance.hpp"

namespace {

void require(bool condition, const char* claim) {
  if (condition) return;
  std::fprintf(stderr, "broken claim: %s\n", claim);
  std::abort();
}

void check_refusal(const sipplab::InputError& error) {
  const std::string line = error.message();
  require(!line.empty(), "a refusal says why");
  require(line.find('\n') == std::string::npos, "a refusal is one line");
  require(error.line >= 0, "a line number is not negative");
}

void check_map(const sipplab::GridMap& map) {
  require(sipplab::GridMap::check_size(map.width(), map.height()).empty(),
          "an accepted map has a legal size");
  const auto again = sipplab::parse_movingai_map(sipplab::write_movingai_map(map), "again.map");
  require(again.has_value() && *again == map, "an accepted map reads back equal");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto map = sipplab::parse_movingai_map(text, "fuzz.map")) {
    check_map(*map);
  } else {
    check_refusal(map.error());
  }
  if (const auto scenario = sipplab::parse_movingai_scen(text, "fuzz.scen"); !scenario) {
    check_refusal(scenario.error());
  }
  if (const auto parts = sipplab::parse_xml_instance(text, "fuzz.xml")) {
    if (parts->map) check_map(parts->map->map);
  } else {
    check_refusal(parts.error());
  }
  return 0;
}
