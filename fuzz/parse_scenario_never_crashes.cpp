// Claim: no bytes, taken as a MovingAI scenario, make the reader crash or take memory that
// they are not due; a refusal is one line, and a scenario that is accepted is what the text
// says and reads back equal.
#include <sstream>
#include <string>
#include <vector>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/io/movingai.hpp"
#include "sipplab/instance_io.hpp"

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

/// The plainest reader: below the first line, each row ends with the sizes of the map, start,
/// goal and a length.
bool is_said_by(const std::string& text, const MovingaiScenario& scenario) {
  constexpr std::size_t kWordsAtLeast = 8;  // a bucket, numbers; a map's name can be invisible
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  std::size_t robots = 0;
  for (int number = 2; std::getline(lines, line); ++number) {
    std::istringstream row(line);
    std::vector<std::string> words;
    for (std::string word; row >> word;) words.push_back(word);
    if (words.empty()) continue;
    if (words.size() < kWordsAtLeast || robots == scenario.agents.size()) return false;
    const auto said = [&words](std::size_t from_end) { return std::stol(words[words.size() - from_end]); };
    const Agent& agent = scenario.agents[robots];
    if (said(7) != scenario.map_width || said(6) != scenario.map_height || said(5) != agent.start.x ||
        said(4) != agent.start.y || said(3) != agent.goal.x || said(2) != agent.goal.y ||
        scenario.agent_lines[robots] != number) {
      return false;
    }
    ++robots;
  }
  return robots == scenario.agents.size();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const auto scenario = fuzz::read_checked(text, [&] { return parse_movingai_scen(text, "fuzz.scen"); });
  if (!scenario) return 0;
  fuzz::require(Claim::kReadsBackEqual, scenario->agents.size() == scenario->agent_lines.size(),
                "robots without a line");
  fuzz::require(Claim::kReadsWhatItSays, is_said_by(std::string(text), *scenario),
                "a scenario that the text does not say");
  check_read_back(*scenario);
  return 0;
}
