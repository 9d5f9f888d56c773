#include "bench/sweep/suites.hpp"

#include <algorithm>
#include <utility>

#include "sipplab/error.hpp"

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
/// machine the restarts strike first.
constexpr double kGenerousLimitS = 20;
/// Seconds: what the hardest cells of the quick reproduction may cost each.
constexpr double kQuickLimitS = 10;
/// Seconds: the first plan of a crowded map comes within one, of the largest within a minute.
constexpr double kDenseLimitS = 60;
/// Seconds: the iterations of suite crowd end before, but for the largest map.
constexpr double kCrowdLimitS = 60;
/// Seconds: far more than any instance of suite scale takes on a machine of today.
constexpr double kScaleLimitS = 3600;
/// Tries of an adversarial case: as many as performance fuzzing allowed.
constexpr std::uint64_t kAdversarialRestarts = 100;

std::vector<Suite> make_suites() {
  const char* const rules = "reschedule none,deterministic,random ssi 0,5";
  const char* const by_rule = "reschedule deterministic ssi 5";
  // Any-angle over 8 neighbours: what the authors of [AY18] ran.
  const std::vector<PlannerOptions> paper = {planner("connectedness 3")};
  const std::vector<PlannerOptions> complete = {planner("method complete")};
  // 2000 iterations are some seconds for each instance, and the greater part of what half a minute gains.
  const std::vector<PlannerOptions> best = {planner("connectedness 3 best yes improve 2000i")};
  // As many are a few seconds for 1,000 robots.
  const std::vector<PlannerOptions> crowd = {planner("best yes improve 2000i")};
  const std::vector<PlannerOptions> turning = {planner("connectedness 3"),
                                               planner("connectedness 3 turns yes"),
                                               planner("any-angle no connectedness 3 turns yes")};
  const Bodies mixed = {{0.3, 0.5, 0.9, 1.4}, {0.5, 1, 2}, true, 2};
  return {
      {.name = "smoke",
       .purpose = "every kind of case once, in a few seconds",
       .instances = 3,
       .time_limit_s = kGenerousLimitS,
       .max_restarts = 10,
       .blocks = {{kEmpty, {8, 64}, over(rules)},
                  {kWarehouse, {16, 64}, over(rules)},
                  {kWarehouse,
                   {32},
                   over("order fifo,longest,random reschedule deterministic ssi 2.5,inf"),
                   {planner(""), planner("any-angle no"), planner("any-angle no connectedness 3"),
                    planner("any-angle no connectedness 5")}}}},
      // Densities from sparse to crowded on both maps, each instance in a few milliseconds, so that a second
      // holds dozens of plannings of each build.
      {.name = "gate",
       .purpose = "what `sipplab gate` times: short plannings at four densities",
       .instances = 5,
       .time_limit_s = kGenerousLimitS,
       .max_restarts = 30,
       .blocks = {{kEmpty, {32, 64}, over(by_rule)}, {kWarehouse, {32, 48}, over(by_rule)}}},
      // Where prioritized planning begins to fail, a tenth of a second and less for each.
      {.name = "gate-crowded",
       .purpose = "what `sipplab gate` also times: 96 to 192 robots, ejection, improvement",
       .instances = 2,
       .time_limit_s = kGenerousLimitS,
       .max_restarts = 30,
       .blocks = {{kEmpty, {128, 192}, over("reschedule deterministic,ejection ssi 5")},
                  {kWarehouse, {96}, over("reschedule deterministic,ejection ssi 5")},
                  {kWarehouse, {48}, over(by_rule), {planner("improve 50i")}}}},
      {.name = "density",
       .purpose = "rising numbers of robots on both maps of the paper, under five minutes",
       .instances = 10,
       .time_limit_s = kGenerousLimitS,
       .max_restarts = 30,  // deterministic re-scheduling seldom needs more at these densities
       .blocks = {{kEmpty, {16, 64, 128, 192, 256}, over("reschedule none,deterministic,random ssi 0,3,5")},
                  {kWarehouse,
                   {16, 32, 64, 96, 128},
                   over("reschedule none,deterministic,random ssi 0,3,5")}}},
      // With two obstacles that cross the map, at densities from sparse to crowded for bodies wider than a
      // cell.
      {.name = "mixed",
       .purpose = "robots of sizes 0.3 to 1.4 and speeds 0.5 to 2, with and without turning",
       .instances = 10,
       .time_limit_s = kGenerousLimitS,
       .max_restarts = 30,
       .blocks =
           {{kEmpty, {8, 16, 32, 48}, over("reschedule none,deterministic ssi 0,5"), turning, 1, mixed},
            {kWarehouse, {8, 16, 24}, over("reschedule none,deterministic ssi 0,5"), turning, 1, mixed}}},
      // [AY18], section 5: Figure 1 (empty map, start-safe intervals, no re-scheduling), Table 1 (warehouse,
      // deterministic and random re-scheduling, the latter ten times), and the longest-first alternative of
      // the text.
      {.name = "paper",
       .purpose = "every cell of the paper's Figure 1 and Table 1; takes hours",
       .instances = 100,
       .blocks = {{kEmpty,
                   {8, 16, 32, 48, 64, 96, 128, 160, 192, 256, 320},
                   over("reschedule none ssi 0,1,3,5,7,9,inf"),
                   paper},
                  {kWarehouse,
                   {16, 32, 64, 96, 128, 160, 192},
                   over("reschedule deterministic,random ssi 5"),
                   paper,
                   10},
                  {kWarehouse,
                   {16, 32, 64, 96, 128, 160, 192},
                   over("order longest reschedule random ssi 5"),
                   paper,
                   10}}},
      // The cells that the paper's sentences speak of.
      {.name = "paper-quick",
       .purpose = "the paper's decisive cells on forty instances each, in some minutes",
       .instances = 40,
       .time_limit_s = kQuickLimitS,
       .blocks = {{kEmpty, {32, 64, 128, 192}, over("reschedule none ssi 0,3,5,9,inf"), paper},
                  {kWarehouse, {32, 64, 96, 128}, over("reschedule deterministic,random ssi 5"), paper, 2},
                  {kWarehouse, {32, 64, 96, 128}, over("order longest reschedule random ssi 5"), paper, 2}}},
      {.name = "adversarial",
       .purpose = "small cases that performance fuzzing found hard for their size",
       .time_limit_s = kGenerousLimitS,
       .max_restarts = kAdversarialRestarts,
       .adversarial_cases = true},
      // Densities at which prioritized planning has stopped.
      {.name = "dense",
       .purpose = "crowded maps, up to 950 robots on 1024 cells, by LaCAM",
       .instances = 20,
       .time_limit_s = kDenseLimitS,
       .blocks = {{kWarehouse, {128, 160, 192, 224, 256}, over("ssi 5"), complete},
                  {kEmpty, {320, 512, 800, 950}, over("ssi 5"), complete}}},
      // What goes beyond the paper: dense cells of both maps, all methods in turn, then improvement. Counted
      // in iterations: the same plans on every machine, and a curve over time beside them.
      {.name = "anytime",
       .purpose = "plans from all methods, improved: curves of flowtime and makespan over time",
       .instances = 10,
       .blocks = {{kWarehouse, {96, 128, 160, 192}, over(by_rule), best},
                  {kEmpty, {128, 192, 256}, over(by_rule), best}}},
      // Where a plan is easy to have and a short one is not. The maps are like MovingAI's random-32-32-20,
      // room-32-32-4, maze-32-32-4, den312d, empty-32-32, warehouse-10-20-10-2-1 and warehouse-20-40-10-2-2.
      // Counted in iterations: see above. The largest: --benchmark_filter=-agents:10000 leaves it out.
      {.name = "crowd",
       .purpose =
           "--best for 192 to 1,000 robots on seven kinds of maps, minutes; and for 10,000, more of them",
       .instances = 3,
       .time_limit_s = kCrowdLimitS,
       .blocks = {{kWarehouse, {192, 224, 256}, over("ssi 5"), crowd},
                  {"random:32x32:0.2", {200, 400}, over("ssi 5"), crowd},
                  {"rooms:32x32:3", {200, 300}, over("ssi 5"), crowd},
                  {"maze:32x32:4", {200, 300}, over("ssi 5"), crowd},
                  {"caves:65x81:0.5", {200, 400, 800}, over("ssi 5"), crowd},
                  {kEmpty, {200, 400, 800}, over("ssi 5"), crowd},
                  {"shelves:10x20:10x2:1", {200, 400, 1000}, over("ssi 5"), crowd},
                  {"shelves:20x40:10x2:2", {10000}, over("ssi 5"), crowd}},
       .fitting_maps = true},
      // For other planners: one setting, so that each plans every instance once.
      {.name = "solvers",
       .purpose = "rising numbers of robots on both maps of the paper, for planners side by side",
       .instances = 5,
       .time_limit_s = 10,
       .blocks = {{kEmpty, {16, 64, 128, 192}, over("reschedule deterministic ssi 5")},
                  {kWarehouse, {16, 32, 64, 96, 128, 192}, over("reschedule deterministic ssi 5")}}},
      // One robot for every sixteen cells: how time and memory grow while the density does not.
      {.name = "scale",
       .purpose = "256 to 16384 robots on maps that grow with them; the largest takes many minutes",
       .time_limit_s = kScaleLimitS,
       .blocks = {{"empty:64x64", {256}, over(by_rule)},
                  {"empty:91x90", {512}, over(by_rule)},
                  {"empty:128x128", {1024}, over(by_rule)},
                  {"empty:181x181", {2048}, over(by_rule)},
                  {"empty:256x256", {4096}, over(by_rule)},
                  {"empty:362x362", {8192}, over(by_rule)},
                  {"empty:512x512", {16384}, over(by_rule)}},
       .fitting_maps = true},
  };
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = make_suites();
  return all;
}

const Suite* find_suite(std::string_view name) {
  for (const Suite& suite : suites()) {
    if (suite.name == name) return &suite;
  }
  return nullptr;
}

}  // namespace sipplab::bench
