#include "bench/sweep/suites.hpp"

namespace sipplab::bench {
namespace {

constexpr const char* kEmpty = "empty:32x32";
constexpr const char* kWarehouse = "warehouse";

constexpr Rescheduling kNone = Rescheduling::kNone;
constexpr Rescheduling kDeterministic = Rescheduling::kDeterministic;
constexpr Rescheduling kRandom = Rescheduling::kRandom;

/// Seconds: ten times what the restarts of the suites below take, so that on any
/// machine it is they that strike.
constexpr double kGenerousLimitS = 20;

/// Seconds: what the hardest cells of the quick reproduction may cost each.
constexpr double kQuickLimitS = 10;

/// Any-angle over 8 neighbours: what the authors ran.
constexpr PlannerMode kPaperPlanner{true, 3, {}};

Suite smoke() {
  Suite suite;
  suite.name = "smoke";
  suite.purpose = "every kind of case once, in a few seconds";
  suite.instances = 3;
  suite.time_limit_s = kGenerousLimitS;
  suite.max_restarts = 10;
  suite.blocks = {
      {kEmpty, {8, 64}, {0, 5}, {kNone, kDeterministic, kRandom}},
      {kWarehouse, {16, 64}, {0, 5}, {kNone, kDeterministic, kRandom}},
      {kWarehouse,
       {32},
       {2.5, kInfiniteSsi},
       {kDeterministic},
       {InitialOrder::kFifo, InitialOrder::kLongestFirst, InitialOrder::kRandom},
       {{true, 2, {}}, {false, 2, {}}, {false, 3, {}}, {false, 5, {}}}},
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
      {kEmpty, {32, 64}, {5}, {kDeterministic}},
      {kWarehouse, {32, 48}, {5}, {kDeterministic}},
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
      {kEmpty, {16, 64, 128, 192, 256}, {0, 3, 5}, {kNone, kDeterministic, kRandom}},
      {kWarehouse, {16, 32, 64, 96, 128}, {0, 3, 5}, {kNone, kDeterministic, kRandom}},
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
  SuiteBlock open{kEmpty, {8, 16, 32, 48}, {0, 5}, {kNone, kDeterministic}};
  MotionRules turning;
  turning.turns = true;
  open.planners = {{true, 3, {}}, {true, 3, turning}, {false, 3, turning}};
  open.bodies = {{0.3, 0.5, 0.9, 1.4}, {0.5, 1, 2}, true, 2};
  SuiteBlock shelves{kWarehouse, {8, 16, 24}, {0, 5}, {kNone, kDeterministic}};
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
  SuiteBlock figure{
      kEmpty, {8, 16, 32, 48, 64, 96, 128, 160, 192, 256, 320}, {0, 1, 3, 5, 7, 9, kInfiniteSsi}, {kNone}};
  figure.planners = {kPaperPlanner};
  SuiteBlock table{kWarehouse, {16, 32, 64, 96, 128, 160, 192}, {5}, {kDeterministic, kRandom}};
  table.planners = {kPaperPlanner};
  table.random_seeds = 10;
  SuiteBlock longest = table;
  longest.reschedules = {kRandom};
  longest.orders = {InitialOrder::kLongestFirst};
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
  suite.blocks[0].ssi_s = {0, 3, 5, 9, kInfiniteSsi};
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
  constexpr PlannerMode kComplete{false, 2, {}, Method::kComplete};
  Suite suite;
  suite.name = "dense";
  suite.purpose = "crowded maps, up to 950 robots on 1024 cells, by the complete planner";
  suite.instances = 20;
  suite.time_limit_s = kDenseLimitS;
  SuiteBlock warehouse{kWarehouse, {128, 160, 192, 224, 256}, {5}, {kNone}};
  warehouse.planners = {kComplete};
  SuiteBlock empty{kEmpty, {320, 512, 800, 950}, {5}, {kNone}};
  empty.planners = {kComplete};
  suite.blocks = {warehouse, empty};
  return suite;
}

/// Iterations of the anytime suite: some seconds for each instance, and the greater part of
/// what half a minute gains.
constexpr std::uint64_t kAnytimeIterations = 2000;

/// What goes beyond the paper: dense cells of both maps, all methods in turn, then improvement.
/// Counted in iterations: the same plans on every machine, and a curve over time beside them.
Suite anytime() {
  Suite suite;
  suite.name = "anytime";
  suite.purpose = "plans from all methods, improved: curves of flowtime and makespan over time";
  suite.instances = 10;
  suite.time_limit_s = kDefaultTimeLimitS;
  SuiteBlock warehouse{kWarehouse, {96, 128, 160, 192}, {5}, {kDeterministic}};
  warehouse.planners = {kPaperPlanner};
  warehouse.refinement.best = true;
  warehouse.refinement.improve = ImproveBudget{};
  warehouse.refinement.improve->iterations = kAnytimeIterations;
  SuiteBlock empty = warehouse;
  empty.map = kEmpty;
  empty.robots = {128, 192, 256};
  suite.blocks = {warehouse, empty};
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
  suite.blocks = {
      {"empty:64x64", {256}, {5}, {kDeterministic}},     {"empty:91x90", {512}, {5}, {kDeterministic}},
      {"empty:128x128", {1024}, {5}, {kDeterministic}},  {"empty:181x181", {2048}, {5}, {kDeterministic}},
      {"empty:256x256", {4096}, {5}, {kDeterministic}},  {"empty:362x362", {8192}, {5}, {kDeterministic}},
      {"empty:512x512", {16384}, {5}, {kDeterministic}},
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
