// From files to an instance: the first robots of a file, whatever its format.
#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "planner/io/load_instance.hpp"
#include "planner/io/movingai.hpp"
#include "planner/io/text_file.hpp"
#include "planner/io/write_instance.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/scratch_folder.hpp"

namespace sipplab {
namespace {

/// What MovingAI's formats can say, too.
Instance plain_instance() {
  Instance instance = (*any_case()).instance;
  instance.obstacles.clear();
  for (Agent& agent : instance.agents) {
    agent.radius_cells = kDefaultRadiusCells;
    agent.speed_cells_per_s = kDefaultSpeedCellsPerS;
  }
  RC_PRE(!find_error(instance));
  return instance;
}

void loads_the_first() {
  const Instance instance = plain_instance();
  const ScratchFolder folder;
  const auto file = [&folder](const char* name, const std::string& text) {
    const std::string path = (folder.path() / name).string();
    RC_ASSERT(!write_file(path, text));
    return path;
  };
  InstanceFiles whole;
  whole.instance = file("one", write_instance_xml(instance));
  InstanceFiles parts;
  parts.map = file("two", write_movingai_map(instance.map));
  parts.task = file("three", write_movingai_scen(instance, "two"));
  const std::size_t robots = instance.agents.size();
  const std::size_t wanted = *rc::gen::inRange<std::size_t>(0, robots + 3);
  Instance expected = instance;
  expected.agents.resize(std::min(wanted, robots));
  for (InstanceFiles files : {whole, parts}) {
    files.allow_unreachable = true;
    files.agents = wanted;
    const auto loaded = load_instance(files);
    RC_ASSERT(loaded.has_value() == (wanted <= robots));
    if (!loaded) continue;
    RC_ASSERT(content_hash(loaded->instance) == content_hash(expected));
    for (std::size_t i = 0; i < expected.agents.size(); ++i) {
      RC_ASSERT(loaded->instance.agents[i].start == instance.agents[i].start);
      RC_ASSERT(loaded->instance.agents[i].goal == instance.agents[i].goal);
    }
  }
  RC_CLASSIFY(wanted < robots, "fewer than there are");
  RC_CLASSIFY(wanted > robots, "more than there are");
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  return property("the first robots of a file are loaded, and no more than there are can be asked for",
                  loads_the_first)
             ? 0
             : 1;
}
