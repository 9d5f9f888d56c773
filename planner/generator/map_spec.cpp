// Maps from a short description: see generator.hpp.
#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "planner/generator/maps.hpp"
#include "planner/generator/stream.hpp"
#include "planner/io/text.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab {
namespace {

constexpr const char* kWelcome =
    "empty:WxH, random:WxH:DENSITY, caves:WxH:DENSITY, rooms:WxH:GAP, maze:WxH:GAP, warehouse, "
    "shelves:COLUMNSxROWS:LENGTHxWIDTH:GAP or the path of a map";

/// What follows the size in a description.
enum class Last { kNothing, kDensity, kGap };

struct KindName {
  std::string_view name;
  MapSpec::Kind kind;
  Last last;
};
constexpr KindName kKinds[] = {
    {"empty", MapSpec::Kind::kEmpty, Last::kNothing}, {"random", MapSpec::Kind::kRandom, Last::kDensity},
    {"caves", MapSpec::Kind::kCaves, Last::kDensity}, {"rooms", MapSpec::Kind::kRooms, Last::kGap},
    {"maze", MapSpec::Kind::kMaze, Last::kGap},       {"shelves", MapSpec::Kind::kShelves, Last::kGap},
};

/// "32x16".
std::optional<std::pair<std::int64_t, std::int64_t>> parse_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = parse_integer(text.substr(0, cross));
  const auto height = parse_integer(text.substr(cross + 1));
  if (!width || !height) return std::nullopt;
  return std::pair{*width, *height};
}

/// What is wrong; nothing if all is well.
std::string parse_last(std::string_view text, Last last, MapSpec& spec) {
  if (last == Last::kDensity) {
    const auto density = parse_real(text);
    if (!density || *density < 0 || *density >= 1) return "density not within 0 <= density < 1";
    spec.density = *density;
  } else {
    const auto gap = parse_integer(text);
    if (!gap || *gap < 1 || *gap > GridMap::kMaxSide)
      return "gap not within 1 to " + std::to_string(GridMap::kMaxSide);
    spec.gap_cells = static_cast<std::int32_t>(*gap);
  }
  return "";
}

std::string parse_shelves(std::string_view numbers, std::string_view sizes, MapSpec& spec) {
  const auto number = parse_size(numbers);
  const auto size = parse_size(sizes);
  if (!number) return "size " + in_quotes(numbers);
  if (!size) return "size " + in_quotes(sizes);
  for (const std::int64_t count : {number->first, number->second, size->first, size->second}) {
    if (count < 1 || count > GridMap::kMaxSide)
      return "number not within 1 to " + std::to_string(GridMap::kMaxSide);
  }
  const auto cells = [](std::int64_t value) { return static_cast<std::int32_t>(value); };
  spec.shelves = {cells(number->first), cells(number->second), cells(size->first), cells(size->second)};
  return "";
}

}  // namespace

Expected<MapSpec, std::string> parse_map_spec(std::string_view text) {
  const auto error = [text](const std::string& what) {
    return Unexpected{"map " + in_quotes(text) + ": " + what + ", expected " + kWelcome};
  };
  MapSpec spec;
  if (text == "warehouse") {
    spec.kind = MapSpec::Kind::kWarehouse;
    return spec;
  }
  const std::size_t name_end = text.find(':');
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& known) {
    return known.name == text.substr(0, name_end);
  });
  if (name_end == std::string_view::npos || kind == std::end(kKinds)) {
    if (text.empty()) return error("nothing");
    spec.kind = MapSpec::Kind::kFile;
    spec.path = std::string(text);
    return spec;
  }

  spec.kind = kind->kind;
  std::string_view size = text.substr(name_end + 1);
  if (kind->last != Last::kNothing) {
    const std::size_t colon = size.rfind(':');
    if (colon == std::string_view::npos) return error(kind->last == Last::kGap ? "no gap" : "no density");
    const std::string what = parse_last(size.substr(colon + 1), kind->last, spec);
    if (!what.empty()) return error(what);
    size = size.substr(0, colon);
  }
  std::pair<std::int64_t, std::int64_t> sides;
  if (spec.kind == MapSpec::Kind::kShelves) {
    const std::size_t colon = size.find(':');
    if (colon == std::string_view::npos) return error("no size of shelves");
    const std::string what = parse_shelves(size.substr(0, colon), size.substr(colon + 1), spec);
    if (!what.empty()) return error(what);
    const Shelves& shelves = spec.shelves;
    const std::int64_t gap = spec.gap_cells;
    sides.first = 2 + 2 * (std::int64_t{shelves.columns} * shelves.length / 4) +
                  shelves.columns * (shelves.length + gap) - gap;
    sides.second = 2 + shelves.rows * (shelves.width + gap) + gap;
  } else {
    const auto parsed = parse_size(size);
    if (!parsed) return error("size " + in_quotes(size));
    sides = *parsed;
  }
  if (const std::string size_error = GridMap::check_size(sides.first, sides.second); !size_error.empty()) {
    return Unexpected{size_error};
  }
  spec.width = static_cast<std::int32_t>(sides.first);
  spec.height = static_cast<std::int32_t>(sides.second);
  return spec;
}

Expected<GridMap, std::string> make_map(const MapSpec& spec, std::uint64_t seed, std::uint64_t index) {
  const Random random = instance_stream(seed, index, StreamUse::kMap);
  switch (spec.kind) {
    case MapSpec::Kind::kEmpty:
      return GridMap(spec.width, spec.height);
    case MapSpec::Kind::kRandom:
      return random_map(spec, random);
    case MapSpec::Kind::kCaves:
      return caves_map(spec, random);
    case MapSpec::Kind::kRooms:
    case MapSpec::Kind::kMaze:
      return walled_map(spec, random);
    case MapSpec::Kind::kWarehouse:
      return warehouse_map();
    case MapSpec::Kind::kShelves:
      return shelves_map(spec);
    case MapSpec::Kind::kFile:
      break;
  }
  Input<GridMap> map = load_map(spec.path);
  if (!map) return Unexpected{map.error().message()};
  return std::move(*map);
}

}  // namespace sipplab
