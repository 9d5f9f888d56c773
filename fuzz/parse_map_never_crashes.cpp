// Claim: no bytes, taken as a MovingAI map, make the reader crash or take memory that they
// are not due; a refusal is one line, and a map that is accepted is what the text shows and
// reads back equal.
#include <sstream>
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/movingai.hpp"
#include "sipplab/instance_io.hpp"

namespace {

/// The plainest reader: what stands below the line "map", character by character.
bool is_shown_by(const std::string& text, const sipplab::GridMap& map) {
  std::istringstream lines(text);
  std::string word;
  while (word != "map" && lines >> word) {
  }
  std::string row;
  std::getline(lines, row);  // the rest of the line "map"
  for (std::int32_t y = 0; y < map.height(); ++y) {
    if (!(lines >> row) || row.size() != static_cast<std::size_t>(map.width())) return false;
    for (std::int32_t x = 0; x < map.width(); ++x) {
      const char shown = row[static_cast<std::size_t>(x)];
      if (map.is_blocked({x, y}) == (shown == '.' || shown == 'G' || shown == 'S' || shown == 'E'))
        return false;
    }
  }
  return !(lines >> word);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sipplab;
  using fuzz::Claim;
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const auto map = fuzz::read_checked(text, [&] { return parse_movingai_map(text, "fuzz.map"); });
  if (!map) return 0;
  fuzz::require(Claim::kReadsBackEqual, GridMap::check_size(map->width(), map->height()).empty(),
                "a map of a size that is not allowed");
  fuzz::require(Claim::kReadsWhatItSays, is_shown_by(std::string(text), *map),
                "a map that the text does not show");
  const auto again = parse_movingai_map(write_movingai_map(*map), "again.map");
  fuzz::require(Claim::kReadsBackEqual, again && *again == *map, "a map reads back as another");
  return 0;
}
