// What is read and never written: the older XML dialect, other words for blocked and
// free. Each text is written here from the instance that it has to give.
#include <rapidcheck.h>

#include <cstdint>
#include <string>

#include "planner/io/movingai.hpp"
#include "planner/io/xml_instance.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::older_formats_laws {
namespace {

/// A map of its own, robots of default size anywhere: readers do not judge places.
Instance any_plain_instance() {
  Instance instance;
  instance.map = GridMap(*rc::gen::inRange(1, 12), *rc::gen::inRange(1, 12));
  for (std::size_t i = 0; i < instance.map.cell_count(); ++i) {
    instance.map.set_blocked(instance.map.cell(i), *rc::gen::inRange(0, 3) == 0);
  }
  const int robots = *rc::gen::inRange(0, 6);
  for (int i = 0; i < robots; ++i) {
    Agent& agent = instance.agents.emplace_back();
    agent.id = std::to_string(i);
    const auto cell = [&] {
      return Cell{*rc::gen::inRange(0, instance.map.width()), *rc::gen::inRange(0, instance.map.height())};
    };
    agent.start = cell();
    agent.goal = cell();
  }
  return instance;
}

std::string element(const std::string& tag, std::int64_t value) {
  return "<" + tag + ">" + std::to_string(value) + "</" + tag + ">\n";
}

/// Sizes and robots inside <map>, coordinates in elements of their own.
std::string older_xml(const Instance& instance) {
  std::string text = "<?xml version=\"1.0\" ?>\n<root>\n<map>\n";
  text += element("width", instance.map.width()) + element("height", instance.map.height());
  text += element("agents", static_cast<std::int64_t>(instance.agents.size()));
  for (const Agent& agent : instance.agents) {
    text += element("startx", agent.start.x) + element("starty", agent.start.y) +
            element("finishx", agent.goal.x) + element("finishy", agent.goal.y);
  }
  text += "<grid>\n";
  for (std::int32_t y = 0; y < instance.map.height(); ++y) {
    text += "<row>";
    for (std::int32_t x = 0; x < instance.map.width(); ++x) {
      // Any integer but 0 is blocked.
      text += instance.map.is_blocked({x, y}) ? *rc::gen::element<std::string>("1 ", "2 ", "255 ", "-1 ")
                                              : std::string("0 ");
    }
    text += "</row>\n";
  }
  return text + "</grid>\n</map>\n</root>\n";
}

std::string octile_map(const GridMap& map) {
  std::string text = "type octile\nheight " + std::to_string(map.height()) + "\nwidth " +
                     std::to_string(map.width()) + "\nmap\n";
  for (std::int32_t y = 0; y < map.height(); ++y) {
    for (std::int32_t x = 0; x < map.width(); ++x) {
      text += map.is_blocked({x, y}) ? *rc::gen::element('@', 'O', 'T', 'W', '#')
                                     : *rc::gen::element('.', 'G', 'S', 'E');
    }
    text += '\n';
  }
  return text;
}

const PropertyRoom room("older_formats", [] {
  bool passed = true;

  passed &= property("the older XML dialect gives the map and the robots that it describes", [] {
    const Instance instance = any_plain_instance();
    const std::string text = older_xml(instance);
    const auto parts = parse_xml_instance(text, "older.xml");
    if (!parts) RC_LOG() << parts.error().message() << '\n' << text;
    RC_ASSERT(static_cast<bool>(parts));
    RC_ASSERT(parts->map && parts->map->map == instance.map);
    RC_ASSERT(parts->agents && parts->agents->items == instance.agents);
  });

  passed &= property("every letter of a MovingAI map means what the benchmark set says", [] {
    const GridMap map = any_plain_instance().map;
    const std::string text = octile_map(map);
    const auto read = parse_movingai_map(text, "letters.map");
    RC_ASSERT(static_cast<bool>(read));
    RC_ASSERT(*read == map);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::older_formats_laws
