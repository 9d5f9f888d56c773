// Claim: whatever map and robots are asked for, the generator makes an instance that keeps
// the rules and whose goals can be reached, the same one each time, or says in one line why
// not. An input is a line such as "random:9x7:0.3 agents 5 seed 7 index 0 radius 0.5".
#include <sstream>
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/instance/reachability.hpp"
#include "sipplab/generator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Cells and robots of an instance: a thousand of them a second are made.
constexpr std::int64_t kMostCells = 1024;
constexpr std::size_t kMostAgents = 64;

void require_one_line(const std::string& line) {
  fuzz::count(fuzz::Event::kRefused);
  fuzz::require(Claim::kRefusalIsOneLine, !line.empty() && line.find('\n') == std::string::npos,
                "a refusal that is not one line");
}

GeneratorOptions read_options(std::istringstream& words) {
  GeneratorOptions options;
  for (std::string word; words >> word;) {
    if (word == "agents") words >> options.agents;
    if (word == "seed") words >> options.seed;
    if (word == "index") words >> options.index;
    if (word == "radius") words >> options.radii_cells.front();
    if (word == "speed") words >> options.speeds_cells_per_s.front();
    if (word == "or-radius") words >> options.radii_cells.emplace_back();
    if (word == "or-speed") words >> options.speeds_cells_per_s.emplace_back();
    if (word == "headings") options.headings = true;
    if (word == "obstacles") words >> options.obstacles;
  }
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  std::istringstream words{std::string(fuzz::text_of(data, size))};
  std::string wanted;
  words >> wanted;
  const auto spec = parse_map_spec(wanted);
  if (!spec) {
    require_one_line(spec.error());
    return 0;
  }
  const GeneratorOptions options = read_options(words);
  if (spec->kind == MapSpec::Kind::kFile) return -1;
  if (std::int64_t{spec->width} * spec->height > kMostCells || options.agents > kMostAgents) return -1;
  if (options.obstacles > kMostAgents) return -1;
  const auto instance = generate_instance(*spec, options);
  if (!instance) {
    require_one_line(instance.error());
    return 0;
  }
  fuzz::count(fuzz::Event::kAccepted);
  fuzz::require(Claim::kResultIsWhole, instance->agents.size() == options.agents, "robots are missing");
  fuzz::require(Claim::kResultIsWhole, !find_error(*instance), "a generated instance breaks a rule");
  fuzz::require(Claim::kResultIsWhole, !find_unreachable_goal(*instance), "a goal cannot be reached");
  const auto again = generate_instance(*spec, options);
  fuzz::require(Claim::kSameInputSamePlan, again && *again == *instance, "the same seed, another instance");
  return 0;
}
