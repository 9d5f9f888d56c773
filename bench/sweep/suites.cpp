#include "bench/sweep/suites.hpp"

#include <algorithm>
#include <utility>

#include "planner/core/assert.hpp"

namespace sipplab::bench {
namespace {

constexpr const char* kEmpty = "empty:32x32";
constexpr const char* kWarehouse = "warehouse";

/// "ssi 0,5 reschedule none": options by name, each with its values.
std::vector<OptionValues> over(std::string_view words) {
  std::vector<OptionValues> dimensions;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    const std::string_view word = words.substr(0, end);
    words.remove_prefix(std::min(end + 1, words.size()));
    if (const Option* option = find_option(word)) {
      dimensions.push_back({option, {}});
      continue;
    }
    std::string value;
    for (const char c : std::string(word) + ',') {
      if (c != ',') {
        value += c;
        continue;
      }
      PLANNER_ASSERT(!dimensions.empty() && takes(*dimensions.back().option, value));
      dimensions.back().texts.push_back(std::exchange(value, {}));
    }
  }
  return dimensions;
}

/// "connectedness 3 turns yes": the defaults otherwise.
PlannerOptions planner(std::string_view words) {
  PlannerOptions options;
  for (const auto& [option, texts] : over(words)) option->set(options, texts.front());
  return options;
}

/// Seconds: ten times what the restarts of the suites below take, so that on any
/// machine it is they that strike.
constexpr double kGenerousLimitS = 20;

/// Seconds: what the hardest cells of the quick reproduction may cost each.
constexpr double kQuickLimitS = 10;

/// Any-angle over 8 neighbours: what the authors ran.
constexpr const char* kPaperPlanner = "connectedness 3";

Suite smoke() {
  Suite suite;
  suite.name = "smoke";
  suite.purpose = "every kind of case once, in a few seconds";
  suite.instances = 3;
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = 10;
  suite.blocks = {
      {kEmpty, {8, 64}, over("reschedule none,deterministic,random ssi 0,5")},
      {kWarehouse, {16, 64}, over("reschedule none,deterministic,random ssi 0,5")},
      {kWarehouse,
       {32},
       over("order fifo,longest,random reschedule deterministic ssi 2.5,inf"),
       {planner(""), planner("any-angle no"), planner("any-angle no connectedness 3"),
        planner("any-angle no connectedness 5")}},
  };
  return suite;
}

/// What `sipplab gate` times: densities from sparse to crowded on both maps, each instance
/// in a few milliseconds, so that a second holds dozens of plannings of each build.
Suite gate() {
  Suite suite;
  suite.name = "gate";
  suite.purpose = "what `sipplab gate` times: short plannings at four densities";
  suite.instances = 5;
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = 30;
  suite.blocks = {
      {kEmpty, {32, 64}, over("reschedule deterministic ssi 5")},
      {kWarehouse, {32, 48}, over("reschedule deterministic ssi 5")},
  };
  return suite;
}

Suite density() {
  Suite suite;
  suite.name = "density";
  suite.purpose = "rising numbers of robots on both maps of the paper, under five minutes";
  suite.instances = 10;
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = 30;  // deterministic re-scheduling seldom needs more at these densities
  suite.blocks = {
      {kEmpty, {16, 64, 128, 192, 256}, over("reschedule none,deterministic,random ssi 0,3,5")},
      {kWarehouse, {16, 32, 64, 96, 128}, over("reschedule none,deterministic,random ssi 0,3,5")},
  };
  return suite;
}

/// Robots of four sizes and three speeds, with and without turning, and two obstacles that
/// cross the map, at densities from sparse to crowded for bodies wider than a cell.
Suite mixed() {
  Suite suite;
  suite.name = "mixed";
  suite.purpose = "robots of sizes 0.3 to 1.4 and speeds 0.5 to 2, with and without turning";
  suite.instances = 10;
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = 30;
  SuiteBlock open{kEmpty, {8, 16, 32, 48}, over("reschedule none,deterministic ssi 0,5")};
  open.planners = {planner("connectedness 3"), planner("connectedness 3 turns yes"),
                   planner("any-angle no connectedness 3 turns yes")};
  open.bodies = {{0.3, 0.5, 0.9, 1.4}, {0.5, 1, 2}, true, 2};
  SuiteBlock shelves{kWarehouse, {8, 16, 24}, open.dimensions};
  shelves.planners = open.planners;
  shelves.bodies = open.bodies;
  suite.blocks = {open, shelves};
  return suite;
}

/// [AY18], section 5: Figure 1 (empty map, start-safe intervals, no re-scheduling) and
/// Table 1 (warehouse, deterministic and random re-scheduling, the latter ten times),
/// and the longest-first alternative of the text.
Suite paper() {
  Suite suite;
  suite.name = "paper";
  suite.purpose = "every cell of the paper's Figure 1 and Table 1; takes hours";
  suite.instances = 100;
  suite.time_limit_s = kDefaultTimeLimitS;
  SuiteBlock figure{kEmpty,
                    {8, 16, 32, 48, 64, 96, 128, 160, 192, 256, 320},
                    over("reschedule none ssi 0,1,3,5,7,9,inf"),
                    {planner(kPaperPlanner)}};
  SuiteBlock table{kWarehouse,
                   {16, 32, 64, 96, 128, 160, 192},
                   over("reschedule deterministic,random ssi 5"),
                   {planner(kPaperPlanner)}};
  table.random_seeds = 10;
  SuiteBlock longest = table;
  longest.dimensions = over("order longest reschedule random ssi 5");
  suite.blocks = {figure, table, longest};
  return suite;
}

/// The cells that the paper's sentences speak of, on few instances.
Suite paper_quick() {
  Suite suite = paper();
  suite.name = "paper-quick";
  suite.purpose = "the paper's decisive cells on forty instances each, in some minutes";
  suite.instances = 40;
  suite.time_limit_s = kQuickLimitS;
  suite.blocks[0].robots = {32, 64, 128, 192};
  suite.blocks[0].dimensions = over("reschedule none ssi 0,3,5,9,inf");
  for (SuiteBlock* block : {&suite.blocks[1], &suite.blocks[2]}) {
    block->robots = {32, 64, 96, 128};
    block->random_seeds = 2;
  }
  return suite;
}

/// Tries of an adversarial case: as many as performance fuzzing allowed.
constexpr std::uint64_t kAdversarialRestarts = 100;

Suite adversarial() {
  Suite suite;
  suite.name = "adversarial";
  suite.purpose = "small cases that performance fuzzing found hard for their size";
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = kAdversarialRestarts;
  suite.adversarial_cases = true;
  return suite;
}

/// Seconds: the first plan of a crowded map comes within one, of the largest within a minute.
constexpr double kDenseLimitS = 60;

/// Densities at which prioritized planning has stopped.
Suite dense() {
  Suite suite;
  suite.name = "dense";
  suite.purpose = "crowded maps, up to 950 robots on 1024 cells, by the complete planner";
  suite.instances = 20;
  suite.time_limit_s = kDenseLimitS;
  const std::vector<PlannerOptions> complete = {planner("method complete")};
  suite.blocks = {{kWarehouse, {128, 160, 192, 224, 256}, over("ssi 5"), complete},
                  {kEmpty, {320, 512, 800, 950}, over("ssi 5"), complete}};
  return suite;
}

/// What goes beyond the paper: dense cells of both maps, all methods in turn, then improvement.
/// Counted in iterations: the same plans on every machine, and a curve over time beside them.
Suite anytime() {
  Suite suite;
  suite.name = "anytime";
  suite.purpose = "plans from all methods, improved: curves of flowtime and makespan over time";
  suite.instances = 10;
  suite.time_limit_s = kDefaultTimeLimitS;
  // 2000 iterations are some seconds for each instance, and the greater part of what half a minute gains.
  const std::vector<PlannerOptions> best = {planner("connectedness 3 best yes improve 2000i")};
  suite.blocks = {{kWarehouse, {96, 128, 160, 192}, over("reschedule deterministic ssi 5"), best},
                  {kEmpty, {128, 192, 256}, over("reschedule deterministic ssi 5"), best}};
  return suite;
}

/// Seconds: far more than any of its instances takes on a machine of today.
constexpr double kScaleLimitS = 3600;

/// One robot for every sixteen cells, from hundreds to more than ten thousand: how time and
/// memory grow where the density does not.
Suite scale() {
  Suite suite;
  suite.name = "scale";
  suite.purpose = "256 to 16384 robots on maps that grow with them; the largest takes many minutes";
  suite.instances = 1;
  suite.time_limit_s = kScaleLimitS;
  const std::vector<OptionValues> by_rule = over("reschedule deterministic ssi 5");
  suite.blocks = {
      {"empty:64x64", {256}, by_rule},     {"empty:91x90", {512}, by_rule},
      {"empty:128x128", {1024}, by_rule},  {"empty:181x181", {2048}, by_rule},
      {"empty:256x256", {4096}, by_rule},  {"empty:362x362", {8192}, by_rule},
      {"empty:512x512", {16384}, by_rule},
  };
  return suite;
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {smoke(),       gate(),        density(), mixed(),   paper(),
                                         paper_quick(), adversarial(), dense(),   anytime(), scale()};
  return all;
}

const Suite* find_suite(std::string_view name) {
  for (const Suite& suite : suites()) {
    if (suite.name == name) return &suite;
  }
  return nullptr;
}

}  // namespace sipplab::bench
