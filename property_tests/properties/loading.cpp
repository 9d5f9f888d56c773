// From files to an instance: the first robots of a file, whatever its format; defaults and
// options that a file states or leaves open.
#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/io/movingai.hpp"
#include "planner/io/text_file.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/scratch_folder.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::loading_laws {
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

/// Files that vanish.
class Files {
 public:
  std::string write(const char* name, const std::string& text) const {
    const std::string path = (folder_.path() / name).string();
    RC_ASSERT(!write_file(path, text));
    return path;
  }

 private:
  ScratchFolder folder_;
};

void loads_the_first() {
  const Instance instance = plain_instance();
  const Files written;
  InstanceFiles whole;
  whole.instance = written.write("one", write_instance_xml(instance));
  InstanceFiles parts;
  parts.map = written.write("two", write_movingai_map(instance.map));
  parts.task = written.write("three", write_movingai_scen(instance, "two"));
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

/// An attribute, three times in four; its value then stands in `value`.
std::string any_attribute(const std::string& name, double& value) {
  if (*rc::gen::inRange(0, 4) == 0) return "";
  value = *rc::gen::inRange(1, 5) / 8.0;
  return " " + name + "=\"" + std::to_string(value) + "\"";
}

void defaults_hold_where_nothing_is_said() {
  Agent defaults;
  const auto attributes_of = [](Agent& agent) {
    return any_attribute("size", agent.radius_cells) + any_attribute("movespeed", agent.speed_cells_per_s) +
           any_attribute("rotationspeed", agent.rotation_speed) +
           any_attribute("start.heading", agent.start_heading_deg);
  };
  std::string text = "<root><agents><defaultparameters" + attributes_of(defaults) + "/>";
  Instance expected;
  const std::int32_t robots = *rc::gen::inRange(0, 5);
  expected.map = GridMap(5, 2);
  for (std::int32_t i = 0; i < robots; ++i) {
    Agent& agent = expected.agents.emplace_back(defaults);
    agent.start = {i, 0};
    agent.goal = {i, 1};
    const std::string column = std::to_string(i);
    text += "<agent start.x=\"" + column + "\" start.y=\"0\" goal.x=\"" + column + "\" goal.y=\"1\"" +
            attributes_of(agent) + "/>";
  }
  const Files written;
  InstanceFiles files;
  files.map = written.write("map", write_movingai_map(expected.map));
  files.task = written.write("task", text + "</agents></root>");
  const auto loaded = load_instance(files);
  if (!loaded) RC_FAIL(loaded.error().message());
  RC_ASSERT(content_hash(loaded->instance) == content_hash(expected));
}

/// A word of a file and what it means, or neither.
template <class Value>
std::string any_element(const std::string& name, Value& option,
                        std::initializer_list<std::pair<const char*, Value>> words) {
  if (*rc::gen::inRange(0, 4) == 0) return "";
  const std::vector<std::pair<const char*, Value>> all(words);
  const auto& [word, value] = all[*rc::gen::inRange<std::size_t>(0, all.size())];
  option = value;
  return "<" + name + ">" + word + "</" + name + ">";
}

void options_are_read_as_stated() {
  PlannerOptions before;
  before.ssi_s = 7;
  PlannerOptions expected = before;
  std::string text = "<root><algorithm>";
  text += any_element<bool>("allowanyangle", expected.any_angle, {{"true", true}, {"false", false}});
  text += any_element<int>("connectedness", expected.connectedness, {{"2", 2}, {"3", 3}, {"5", 5}});
  text += any_element<double>("weight", expected.weight, {{"1", 1.0}, {"1.25", 1.25}, {"100", 100.0}});
  text += any_element<Rescheduling>("rescheduling", expected.rescheduling,
                                    {{"no", Rescheduling::kNone},
                                     {"none", Rescheduling::kNone},
                                     {"rulebased", Rescheduling::kDeterministic},
                                     {"deterministic", Rescheduling::kDeterministic},
                                     {"random", Rescheduling::kRandom}});
  text += any_element<InitialOrder>("prioritization", expected.order,
                                    {{"fifo", InitialOrder::kFifo},
                                     {"shortest_first", InitialOrder::kShortestFirst},
                                     {"longest_first", InitialOrder::kLongestFirst},
                                     {"random", InitialOrder::kRandom}});
  text += any_element<double>("startsafeinterval", expected.ssi_s,
                              {{"0", 0.0}, {"2.5", 2.5}, {"0.125", 0.125}, {"infinity", kInfiniteSsi}});
  text +=
      any_element<double>("timelimit", expected.time_limit_s,
                          {{"0.5", 0.5}, {"300", 300.0}, {"-1", std::numeric_limits<double>::infinity()}});
  text += "</algorithm></root>";
  const Files written;
  InstanceFiles files;
  files.instance = written.write("instance", write_instance_xml(plain_instance()));
  files.config = written.write("config", text);
  files.allow_unreachable = true;
  const auto loaded = load_instance(files);
  if (!loaded) RC_FAIL(loaded.error().message());
  RC_ASSERT(loaded->options.applied_to(before) == expected);
}

const PropertyRoom room("loading", [] {
  bool passed = true;

  passed &= property("the first robots of a file are loaded, and no more than there are can be asked for",
                     loads_the_first);
  passed &= property("defaults hold for what a robot leaves open", defaults_hold_where_nothing_is_said);
  passed &= property("options are read as stated, and what is left open stays", options_are_read_as_stated);

  return passed;
});

}  // namespace
}  // namespace sipplab::loading_laws
