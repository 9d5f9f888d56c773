// Maps from a short description: see generator.hpp.
#include <cmath>
#include <numeric>
#include <vector>

#include "planner/generator/stream.hpp"
#include "planner/io/text.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab {
namespace {

constexpr const char* kWelcome = "empty:WxH, random:WxH:DENSITY, warehouse or the path of a map";

GridMap random_map(const MapSpec& spec, std::uint64_t seed, std::uint64_t index) {
  GridMap map(spec.width, spec.height);
  const double wanted = spec.density * static_cast<double>(map.cell_count());
  const auto blocked = static_cast<std::size_t>(std::floor(wanted + 0.5));
  std::vector<std::uint32_t> cells(map.cell_count());
  std::iota(cells.begin(), cells.end(), 0u);
  Random random = instance_stream(seed, index, StreamUse::kMap);
  random.shuffle(cells);
  for (std::size_t i = 0; i < blocked; ++i) map.set_blocked(map.cell(cells[i]), true);
  return map;
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
  const std::string_view kind = text.substr(0, text.find(':'));
  if (kind == text || (kind != "empty" && kind != "random")) {
    if (text.empty()) return error("nothing");
    spec.kind = MapSpec::Kind::kFile;
    spec.path = std::string(text);
    return spec;
  }

  std::string_view size = text.substr(kind.size() + 1);
  if (kind == "random") {
    spec.kind = MapSpec::Kind::kRandom;
    const std::size_t colon = size.find(':');
    if (colon == std::string_view::npos) return error("no density");
    const auto density = parse_real(size.substr(colon + 1));
    if (!density || *density < 0 || *density >= 1) return error("density not within 0 <= density < 1");
    spec.density = *density;
    size = size.substr(0, colon);
  }
  const std::size_t cross = size.find('x');
  const auto width = parse_integer(size.substr(0, cross));
  const auto height = cross == std::string_view::npos ? std::nullopt : parse_integer(size.substr(cross + 1));
  if (!width || !height) return error("size " + in_quotes(size));
  if (const std::string size_error = GridMap::check_size(*width, *height); !size_error.empty()) {
    return Unexpected{size_error};
  }
  spec.width = static_cast<std::int32_t>(*width);
  spec.height = static_cast<std::int32_t>(*height);
  return spec;
}

Expected<GridMap, std::string> make_map(const MapSpec& spec, std::uint64_t seed, std::uint64_t index) {
  switch (spec.kind) {
    case MapSpec::Kind::kEmpty:
      return GridMap(spec.width, spec.height);
    case MapSpec::Kind::kRandom:
      return random_map(spec, seed, index);
    case MapSpec::Kind::kWarehouse:
      return warehouse_map();
    case MapSpec::Kind::kFile:
      break;
  }
  Input<GridMap> map = load_map(spec.path);
  if (!map) return Unexpected{map.error().message()};
  return std::move(*map);
}

GridMap warehouse_map() {
  constexpr std::int32_t kWidth = 35;
  constexpr std::int32_t kHeight = 21;
  GridMap map(kWidth, kHeight);
  for (const std::int32_t y : {2, 6, 10, 14, 18}) {
    for (const std::int32_t first_x : {7, 18}) {
      for (std::int32_t x = first_x; x < first_x + 10; ++x) map.set_blocked({x, y}, true);
    }
  }
  return map;
}

}  // namespace sipplab
