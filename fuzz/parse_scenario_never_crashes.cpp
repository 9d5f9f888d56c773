// Claim: no bytes, taken as a MovingAI scenario, make the reader crash or take memory that
// they are not due; a refusal is one line, and a scenario that is accepted reads back equal.
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/movingai.hpp"
#include "planner/io/write_instance.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// A map is made to write the scenario again; larger ones would take most of the time.
constexpr std::int64_t kLargestSide = 64;

void check_read_back(const MovingaiScenario& scenario) {
  if (scenario.agents.empty()) return;
  const auto fits = [](std::int64_t side) { return side >= 1 && side <= kLargestSide; };
  if (!fits(scenario.map_width) || !fits(scenario.map_height)) return;
  Instance instance;
  instance.map =
      GridMap(static_cast<std::int32_t>(scenario.map_width), static_cast<std::int32_t>(scenario.map_height));
  instance.agents = scenario.agents;
  const auto again = parse_movingai_scen(write_movingai_scen(instance, scenario.map_name), "again.scen");
  fuzz::require(Claim::kReadsBackEqual,
                again && again->agents == scenario.agents && again->map_name == scenario.map_name &&
                    again->map_width == scenario.map_width && again->map_height == scenario.map_height,
                "a scenario reads back as another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const auto scenario = fuzz::read_checked(text, [&] { return parse_movingai_scen(text, "fuzz.scen"); });
  if (!scenario) return 0;
  fuzz::require(Claim::kReadsBackEqual, scenario->agents.size() == scenario->agent_lines.size(),
                "robots without a line");
  check_read_back(*scenario);
  return 0;
}
