// Claim: no bytes, taken as a MovingAI map, make the reader crash or take memory that they
// are not due; a refusal is one line, and a map that is accepted reads back equal.
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/movingai.hpp"
#include "planner/io/write_instance.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sipplab;
  using fuzz::Claim;
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const auto map = fuzz::read_checked(text, [&] { return parse_movingai_map(text, "fuzz.map"); });
  if (!map) return 0;
  fuzz::require(Claim::kReadsBackEqual, GridMap::check_size(map->width(), map->height()).empty(),
                "a map of a size that is not allowed");
  const auto again = parse_movingai_map(write_movingai_map(*map), "again.map");
  fuzz::require(Claim::kReadsBackEqual, again && *again == *map, "a map reads back as another");
  return 0;
}
