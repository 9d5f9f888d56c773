// Claim: no bytes, taken as XML of AA-SIPP(m) or of the archive (whole, or a task, map,
// config or obstacles alone), make the reader crash or take memory that they are not due;
// refusals and warnings are one line each, and an instance that is accepted is what the text
// says and reads back equal.
#include <array>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/text.hpp"
#include "planner/io/xml_instance.hpp"
#include "sipplab/instance_io.hpp"

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

/// The numbers in the texts of all elements of one name, in the sequence of the document.
std::vector<std::int64_t> numbers_in(pugi::xml_node node, const char* name) {
  std::vector<std::int64_t> numbers;
  for (const pugi::xml_node element : node.children(name)) {
    std::string text;
    for (const pugi::xml_node part : element.children())
      text += part.type() == pugi::node_comment ? "" : part.value();
    std::istringstream words(text);
    for (std::int64_t number = 0; words >> number;) numbers.push_back(number);
  }
  return numbers;
}

bool is_said_of_map(pugi::xml_node map, const GridMap& read) {
  const std::vector<std::int64_t> cells = numbers_in(map.child("grid"), "row");
  if (cells.size() != read.cell_count()) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (read.is_blocked(read.cell(i)) != (cells[i] != 0)) return false;
  }
  return true;
}

bool is_said_of_agents(pugi::xml_node root, const std::vector<Agent>& read) {
  const pugi::xml_node map = root.child("map");
  std::array<std::vector<std::int64_t>, 4> said = {numbers_in(map, "startx"), numbers_in(map, "starty"),
                                                   numbers_in(map, "finishx"), numbers_in(map, "finishy")};
  for (const pugi::xml_node agent : root.child("agents").children("agent")) {
    constexpr std::array<const char*, 4> kNames = {"start.x", "start.y", "goal.x", "goal.y"};
    for (std::size_t i = 0; i < said.size(); ++i) said[i].push_back(agent.attribute(kNames[i]).as_llong());
  }
  for (std::size_t i = 0; i < read.size(); ++i) {
    const std::array<std::int32_t, 4> is = {read[i].start.x, read[i].start.y, read[i].goal.x, read[i].goal.y};
    if (!is_valid_utf8(read[i].id)) return false;
    for (std::size_t k = 0; k < said.size(); ++k) {
      if (said[k].size() != read.size() || said[k][i] != is[k]) return false;
    }
  }
  return true;
}

/// The plainest reader: numbers as they stand in the document.
bool is_said_by(std::string_view text, const InstanceParts& parts) {
  if (text.find('\0') != std::string_view::npos) return false;
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node root = document.child("root");
  return (!parts.map || is_said_of_map(root.child("map"), parts.map->map)) &&
         (!parts.agents || is_said_of_agents(root, parts.agents->items));
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
  fuzz::require(Claim::kReadsWhatItSays, is_said_by(text, *parts), "an instance that the text does not say");
  const Instance instance = joined(*parts);
  const auto again = parse_xml_instance(write_instance_xml(instance), "again.xml");
  fuzz::require(Claim::kReadsBackEqual, again && again->warnings.empty() && joined(*again) == instance,
                "an instance reads back as another");
  return 0;
}
