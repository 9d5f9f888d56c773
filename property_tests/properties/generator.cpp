// Generated instances: problems that can be posed, of which each is another.
#include "sipplab/generator.hpp"

#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <string>

#include "planner/instance/reachability.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab {
namespace {

GeneratorOptions any_options(std::size_t most_agents) {
  GeneratorOptions options;
  options.agents = *rc::gen::inRange<std::size_t>(0, most_agents + 1);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  options.index = *rc::gen::inRange<std::uint64_t>(0, 1000);
  options.radii_cells = {*rc::gen::element(0.5, 0.25, 0.4, 0.75, 1.0, 1.5)};
  if (*rc::gen::inRange(0, 3) == 0) options.radii_cells = {0.3, 0.5, 0.9, 1.4};
  options.speeds_cells_per_s = {*rc::gen::element(1.0, 0.5, 2.0), 1.0};
  options.rotation_speeds = {0.5, 2};
  options.headings = *rc::gen::arbitrary<bool>();
  options.obstacles = *rc::gen::inRange<std::size_t>(0, 3);
  return options;
}

MapSpec any_random_map() {
  MapSpec spec;
  spec.kind = MapSpec::Kind::kRandom;
  spec.width = *rc::gen::inRange(1, 20);
  spec.height = *rc::gen::inRange(1, 20);
  spec.density = *rc::gen::inRange(0, 80) / 100.0;
  return spec;
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("a generated instance keeps all rules, and every goal can be reached", [] {
    const GeneratorOptions options = any_options(12);
    const auto instance = generate_instance(any_random_map(), options);
    RC_PRE(static_cast<bool>(instance));
    RC_ASSERT(instance->agents.size() == options.agents);
    RC_ASSERT(!find_error(*instance));
    RC_ASSERT(!find_unreachable_goal(*instance));
    RC_CLASSIFY(options.radii_cells.back() > 0.5, "wider than a cell");
    RC_ASSERT(instance->obstacles.size() == options.obstacles);
    RC_CLASSIFY(options.radii_cells.size() > 1, "several sizes");
    RC_CLASSIFY(options.obstacles > 0, "moving obstacles");
  });

  passed &= property("no robot is at its goal already where two fit on the map", [] {
    GeneratorOptions options = any_options(16);
    options.radii_cells = {0.5};
    MapSpec spec;
    spec.width = *rc::gen::inRange(2, 6);
    spec.height = *rc::gen::inRange(2, 6);
    const auto instance = generate_instance(spec, options);
    RC_PRE(static_cast<bool>(instance));
    for (const Agent& agent : instance->agents) RC_ASSERT(agent.start != agent.goal);
  });

  passed &= property("the share of blocked cells is what was asked for, rounded", [] {
    const MapSpec spec = any_random_map();
    const auto map = make_map(spec, *rc::gen::arbitrary<std::uint64_t>(), 0);
    RC_ASSERT(static_cast<bool>(map));
    const double wanted = spec.density * static_cast<double>(map->cell_count());
    RC_ASSERT(std::abs(static_cast<double>(map->blocked_count()) - wanted) <= 0.5 + 1e-9);
  });

  passed &= property("the same seed and index give the same instance, another index another", [] {
    GeneratorOptions options = any_options(0);
    options.radii_cells = {0.5};
    options.agents = 20;
    MapSpec spec = any_random_map();
    spec.width = 30;
    spec.height = 30;
    spec.density = 0.2;
    const auto instance = generate_instance(spec, options);
    const auto again = generate_instance(spec, options);
    RC_ASSERT(instance && again && *instance == *again);
    std::set<std::string> hashes{content_hash(*instance)};
    constexpr std::uint64_t kOthers = 3;
    for (std::uint64_t i = 1; i <= kOthers; ++i) {
      GeneratorOptions other = options;
      other.index += i;
      hashes.insert(content_hash(*generate_instance(spec, other)));
    }
    RC_ASSERT(hashes.size() == kOthers + 1);
  });

  return passed ? 0 : 1;
}
