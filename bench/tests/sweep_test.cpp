// What a sweep guarantees before anything is run or recorded: verdicts, names, the order
// of files, filters, and which cases a request means.
#include <gtest/gtest.h>
#include <linux/perf_event.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "bench/sweep/benchmark_flags.hpp"
#include "bench/sweep/case_outcome.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/sweep/instance_set.hpp"
#include "bench/sweep/instruction_count.hpp"
#include "bench/sweep/peak_memory.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/sweep/run_instance.hpp"
#include "bench/sweep/shard.hpp"
#include "bench/sweep/suites.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/generator.hpp"

namespace sipplab::bench {
namespace {

OptionValues values(std::string_view option, std::vector<std::string> texts) {
  return {find_option(option), std::move(texts)};
}

Instance small_instance() {
  GeneratorOptions options;
  options.agents = 6;
  return generate_instance(warehouse_map(), options).value();
}

TEST(Judged, ASolvedPlanIsRecordedWithItsFigures) {
  const Instance instance = small_instance();
  const PlannerOptions options;
  const PlanResult result = plan(instance, options);
  const db::ResultRow row = judged(instance, options, result);
  EXPECT_EQ(row.status, db::ResultStatus::kSolved);
  EXPECT_EQ(row.valid, true);
  EXPECT_EQ(row.makespan_s, makespan_s(result.solution));
  EXPECT_EQ(row.flowtime_s, flowtime_s(result.solution));
  EXPECT_TRUE(row.plan_hash.has_value());
  EXPECT_EQ(row.tries, result.tries());
}

TEST(Judged, APlanThatTheValidatorRejectsIsNeverSolved) {
  const Instance instance = small_instance();
  const PlannerOptions options;
  PlanResult result = plan(instance, options);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  const auto moving = std::find_if(result.solution.trajectories.begin(), result.solution.trajectories.end(),
                                   [](const Trajectory& trajectory) { return !trajectory.motions.empty(); });
  ASSERT_NE(moving, result.solution.trajectories.end());
  moving->motions.pop_back();  // never gets to its goal
  const db::ResultRow row = judged(instance, options, result);
  EXPECT_EQ(row.status, db::ResultStatus::kInvalid);
  EXPECT_EQ(row.valid, false);
  EXPECT_GT(row.violations, 0);
  EXPECT_FALSE(row.message.empty());
}

TEST(Judged, ALimitNamesItself) {
  PlannerOptions options;
  options.max_expansions = 1;
  const db::ResultRow row = run_instance(small_instance(), options);
  EXPECT_EQ(row.status, db::ResultStatus::kLimit);
  EXPECT_EQ(row.limit, "expansions");
  EXPECT_EQ(row.makespan_s, std::nullopt);
}

TEST(Judged, APlanOfTheFallbackNamesItsMaker) {
  PlannerOptions options;
  options.max_expansions = 1;
  options.ssi_s = 0;
  options.fallback = Fallback::kComplete;
  const db::ResultRow limited = run_instance(small_instance(), options);
  EXPECT_EQ(limited.made_by, "complete");
  EXPECT_EQ(limited.limit, "expansions");
  options.max_expansions = UINT64_MAX;
  options.method = Method::kComplete;
  const db::ResultRow solved = run_instance(small_instance(), options);
  EXPECT_EQ(solved.status, db::ResultStatus::kSolved);
  EXPECT_EQ(solved.made_by, "complete");
  EXPECT_EQ(solved.ssi_kept_s, 0);
}

/// Memory that nobody has touched. Not by malloc, which under a sanitizer keeps what is freed.
class FreshMemory {
 public:
  explicit FreshMemory(std::size_t bytes)
      : bytes_(bytes),
        begin_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    // Small pages, or one fault might bring hundreds of them.
    if (is_there()) madvise(begin_, bytes_, MADV_NOHUGEPAGE);
  }
  FreshMemory(const FreshMemory&) = delete;
  FreshMemory& operator=(const FreshMemory&) = delete;
  ~FreshMemory() {
    if (is_there()) munmap(begin_, bytes_);
  }

  bool is_there() const { return begin_ != MAP_FAILED; }
  /// Writes into each page; how many there are.
  std::int64_t touch() {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    for (std::size_t at = 0; at < bytes_; at += page) static_cast<volatile char*>(begin_)[at] = 1;
    return static_cast<std::int64_t>(bytes_ / page);
  }

 private:
  std::size_t bytes_;
  void* begin_;
};

TEST(PeakMemory, IsThatOfTheTimeSinceItBegan) {
  const PeakMemory whole;
  const std::optional<std::int64_t> at_first = whole.bytes();
  if (!at_first) return;  // not measured on this system
  constexpr std::int64_t kBytes = std::int64_t{64} << 20;
  // Less than half may be missing: a machine that is short of memory takes back, in the
  // meantime, what it can read again from the program's file (4 MiB were seen to go, of some ten).
  constexpr std::int64_t kSurelyCounted = kBytes / 2;
  {
    FreshMemory memory(kBytes);
    ASSERT_TRUE(memory.is_there());
    memory.touch();
  }
  const std::int64_t with_it = *whole.bytes();
  EXPECT_GE(with_it, *at_first + kSurelyCounted);
  const PeakMemory after;  // begins anew, for `whole` as well
  EXPECT_LE(*after.bytes(), with_it - kSurelyCounted);
}

TEST(PeakMemory, LeavesOutWhatWasThereBefore) {
  FreshMemory before(std::size_t{64} << 20);
  ASSERT_TRUE(before.is_there());
  before.touch();
  PeakMemory memory;
  memory.restart();
  if (!memory.bytes()) return;  // not measured on this system
  EXPECT_LT(*memory.bytes(), std::int64_t{32} << 20);
}

TEST(PerfCounter, CountsWhatIsDoneAfterItBegan) {
  // Page faults: a counter of the kernel's own, on every machine that permits any, and of
  // nothing that takes time.
  const PerfCounter faults(PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS);
  if (!faults.count()) return;  // forbidden on this system
  std::int64_t pages = 0;
  std::thread([&pages] {
    FreshMemory memory(std::size_t{16} << 20);
    if (memory.is_there()) pages = memory.touch();
  }).join();
  ASSERT_GT(pages, 0);
  EXPECT_GE(*faults.count(), pages);
  // It has hardly begun: what the machine took back of the program in the meantime is no such number.
  EXPECT_LT(*PerfCounter(PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS).count(), pages);
}

TEST(PerfCounter, NothingIsCountedWhereThereIsNoSuchCounter) {
  constexpr std::uint64_t kNoEvent = 0xffff;
  EXPECT_FALSE(PerfCounter(PERF_TYPE_SOFTWARE, kNoEvent).count());
}

TEST(MachineInfo, IsOfTheNameThatIsGiven) {
  constexpr const char* kVariable = "SIPPLAB_MACHINE";
  unsetenv(kVariable);
  const db::MachineInfo itself = machine_info();
  EXPECT_FALSE(itself.host.empty());
  setenv(kVariable, "", 1);
  EXPECT_EQ(db::fingerprint(machine_info()), db::fingerprint(itself)) << "no name";
  setenv(kVariable, "runner-large", 1);
  const db::MachineInfo named = machine_info();
  EXPECT_EQ(named.host, "runner-large");
  EXPECT_EQ(named.cpu_model, itself.cpu_model);
  EXPECT_EQ(named.kernel, itself.kernel);
  EXPECT_EQ(named.memory_bytes % (std::int64_t{1} << 30), 0) << "machines of a class differ by some pages";
  EXPECT_NEAR(static_cast<double>(named.memory_bytes), static_cast<double>(itself.memory_bytes), 1 << 29);
  unsetenv(kVariable);
}

TEST(PlannerLabel, SaysWhatDiffersFromTheDefaults) {
  SweepCase sweep_case;
  sweep_case.map_spec = "warehouse";
  EXPECT_EQ(planner_label(sweep_case), "sipplab");
  const std::string plain = case_name(sweep_case, false);
  sweep_case.options.weight = 1.05;
  sweep_case.options.fallback = Fallback::kComplete;
  EXPECT_EQ(planner_label(sweep_case), "sipplab weight:1.05 fallback:complete");
  EXPECT_EQ(case_name(sweep_case, false), plain + "/weight:1.05/fallback:complete");
  sweep_case.command = "other";
  EXPECT_EQ(planner_label(sweep_case), "cmd:other weight:1.05 fallback:complete") << "it is told them, too";
  EXPECT_EQ(case_name(sweep_case, true), plain + "/planner:cmd:other/weight:1.05/fallback:complete/seed:1");
  sweep_case.options = {};
  EXPECT_EQ(planner_label(sweep_case), "cmd:other");
}

TEST(CaseRow, KeepsEachOptionInItsColumn) {
  SweepCase sweep_case;
  for (const auto& [name, text] :
       {std::pair{"weight", "1.05"}, std::pair{"any-angle", "no"}, std::pair{"seed", "7"},
        std::pair{"improve", "300i"}, std::pair{"time-limit", "inf"}}) {
    ASSERT_TRUE(find_option(name)->set(sweep_case.options, text));
  }
  const db::CaseInfo row = case_row(sweep_case);
  EXPECT_EQ(row.real("weight"), 1.05);
  EXPECT_EQ(row.option("any_angle"), db::Value(std::int64_t{0}));
  EXPECT_EQ(row.text("improve"), "300i");
  EXPECT_EQ(row.option("max_restarts"), db::Value(std::int64_t{INT64_MAX})) << "no limit";
  EXPECT_EQ(options_of(row), sweep_case.options);
}

TEST(CaseOutcome, MeansOfPlansAreOverSolvedInstancesAlone) {
  CaseOutcome outcome;
  EXPECT_EQ(outcome.mean_makespan_s(), std::nullopt);
  db::ResultRow row;
  row.status = db::ResultStatus::kSolved;
  row.planning_time_ns = 1'000'000'000;
  row.makespan_s = 10;
  row.flowtime_s = 30;
  row.tries = 1;
  outcome.add(row);
  row.status = db::ResultStatus::kLimit;
  row.planning_time_ns = 3'000'000'000;
  row.makespan_s.reset();
  row.tries = 3;
  outcome.add(row);
  EXPECT_DOUBLE_EQ(outcome.success_rate(), 0.5);
  EXPECT_EQ(outcome.mean_makespan_s(), 10.0);
  EXPECT_DOUBLE_EQ(outcome.mean_planning_s(), 2);
  EXPECT_EQ(outcome.mean_solved_planning_s(), 1.0);
  EXPECT_DOUBLE_EQ(outcome.mean_tries(), 2);
  EXPECT_EQ(outcome.limited(), 1);
}

TEST(Filter, IsThatOfGoogleBenchmark) {
  const std::vector<std::string> names = {"plan/empty/agents:8", "plan/warehouse/agents:16"};
  EXPECT_EQ(filter_matches("", names).value(), (std::vector<bool>{true, true}));
  EXPECT_EQ(filter_matches("all", names).value(), (std::vector<bool>{true, true}));
  EXPECT_EQ(filter_matches("agents:(8|9)$", names).value(), (std::vector<bool>{true, false}));
  EXPECT_EQ(filter_matches("-empty", names).value(), (std::vector<bool>{false, true}));
  EXPECT_FALSE(filter_matches("(", names).has_value());
}

TEST(Expand, EveryCaseOfEverySuiteHasItsOwnName) {
  for (const Suite& suite : suites()) {
    SweepRequest request;
    request.suite = &suite;
    if (!suite.adversarial_cases) request.count = 1;
    const auto sweep = expand(request);
    ASSERT_TRUE(sweep.has_value()) << sweep.error();
    std::set<std::string> names;
    for (const NamedCase& named : sweep->cases) EXPECT_TRUE(names.insert(named.name).second) << named.name;
    EXPECT_GE(names.size(), 4u) << suite.name;
  }
}

TEST(Expand, ReplacedDimensionsTakeTheSuitesPlace) {
  SweepRequest request;
  request.suite = find_suite("density");
  request.map = "empty:8x8";
  request.robots = {2};
  request.values = {values("ssi", {"2.5", "inf"}), values("reschedule", {"none"}),
                    values("any-angle", {"no"}), values("connectedness", {"3"})};
  request.count = 2;
  const auto sweep = expand(request);
  ASSERT_TRUE(sweep.has_value()) << sweep.error();
  // Both blocks of the suite now mean the same, which is done once.
  ASSERT_EQ(sweep->cases.size(), 2u);
  EXPECT_EQ(sweep->cases[0].name,
            "plan/empty:8x8/agents:2/ssi:2.5/reschedule:none/order:shortest/any-angle:no/connectedness:3");
  EXPECT_EQ(sweep->cases[1].name,
            "plan/empty:8x8/agents:2/ssi:inf/reschedule:none/order:shortest/any-angle:no/connectedness:3");
  ASSERT_EQ(sweep->sets.size(), 1u);
  EXPECT_EQ(sweep->sets[0].instances.size(), 2u);
  EXPECT_EQ(case_row(sweep->cases[0].parameters).real("ssi_s"), 2.5);
}

TEST(Expand, EachWeightIsACaseOfItsOwnForEachNeighbourhood) {
  SweepRequest request;
  request.suite = find_suite("density");
  request.map = "empty:8x8";
  request.robots = {2};
  request.values = {values("ssi", {"5"}), values("reschedule", {"none"}), values("connectedness", {"2", "3"}),
                    values("weight", {"1", "1.5"})};
  request.count = 1;
  const auto sweep = expand(request);
  ASSERT_TRUE(sweep.has_value()) << sweep.error();
  std::vector<std::string> planners;
  for (const NamedCase& named : sweep->cases) planners.push_back(planner_label(named.parameters));
  EXPECT_EQ(planners, (std::vector<std::string>{"sipplab", "sipplab weight:1.5", "sipplab connectedness:3",
                                                "sipplab connectedness:3 weight:1.5"}));
  request.values.push_back(values("method", {"complete"}));
  const auto complete = expand(request);
  ASSERT_TRUE(complete.has_value()) << complete.error();
  EXPECT_EQ(complete->cases.size(), 1u);  // weights are nothing to it
}

TEST(Expand, RandomReschedulingOfThePaperIsRunWithTenSeeds) {
  SweepRequest request;
  request.suite = find_suite("paper");
  request.count = 1;
  request.map = "warehouse";
  request.robots = {16};
  request.values = {values("ssi", {"5"}), values("order", {"shortest"}),
                    values("reschedule", {"random", "deterministic"})};
  const auto sweep = expand(request);
  ASSERT_TRUE(sweep.has_value()) << sweep.error();
  std::set<std::uint64_t> seeds;
  for (const NamedCase& named : sweep->cases) {
    if (named.name.find("/seed:") != std::string::npos) seeds.insert(named.parameters.options.seed);
  }
  EXPECT_EQ(seeds.size(), 10u);
}

TEST(Expand, TheMixedSuiteTurnsRobotsOfManySizes) {
  SweepRequest request;
  request.suite = find_suite("mixed");
  request.count = 1;
  request.map = "empty:24x24";
  request.robots = {12};
  request.values = {values("ssi", {"5"}), values("reschedule", {"deterministic"})};
  const auto sweep = expand(request);
  ASSERT_TRUE(sweep.has_value()) << sweep.error();
  ASSERT_EQ(sweep->sets.size(), 1u);
  EXPECT_EQ(sweep->sets[0].environment, "empty-mixed");
  EXPECT_EQ(sweep->sets[0].instances[0].row.name,
            "empty:24x24 agents:12 seed:1 index:0 radius:0.3,0.5,0.9,1.4 speed:0.5,1,2 headings obstacles:2");
  ASSERT_EQ(sweep->cases.size(), 3u);
  EXPECT_EQ(case_row(sweep->cases[0].parameters).planner, "sipplab connectedness:3");
  EXPECT_EQ(case_row(sweep->cases[2].parameters).planner, "sipplab any-angle:no connectedness:3 turns:yes");
  const db::CaseInfo row = case_row(sweep->cases[1].parameters);
  EXPECT_EQ(row.planner, "sipplab connectedness:3 turns:yes");
  EXPECT_EQ(row.radius_cells, 0);
  EXPECT_EQ(row.speed_cells_per_s, 0);
  const db::ResultRow result =
      run_instance(sweep->sets[0].instances[0].instance, sweep->cases[1].parameters.options);
  EXPECT_EQ(result.status, db::ResultStatus::kSolved);
  EXPECT_EQ(result.valid, true);

  request.values.push_back(values("turns", {"no"}));
  const auto plain = expand(request);
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->cases.size(), 2u);  // two planners have become one
}

TEST(GenerateSet, AnInstanceDoesNotDependOnTheCount) {
  const auto few = generate_set("random:12x12:0.1", 5, 2, 9);
  const auto many = generate_set("random:12x12:0.1", 5, 4, 9);
  ASSERT_TRUE(few.has_value() && many.has_value());
  EXPECT_EQ(few->instances[1].row.content_hash, many->instances[1].row.content_hash);
  EXPECT_NE(many->instances[1].row.content_hash, many->instances[2].row.content_hash);
  EXPECT_EQ(few->environment, "random");
  EXPECT_FALSE(generate_set("empty:2x2", 5, 1, 1).has_value());
}

ExpandedSweep small_sweep() {
  SweepRequest request;
  request.suite = find_suite("density");
  request.map = "empty:12x12";
  request.robots = {2, 4, 12};
  request.values = {values("ssi", {"5"}), values("reschedule", {"none"})};
  request.count = 10;
  return expand(request).value();
}

using Dealt = std::set<std::tuple<std::string, std::int64_t, std::int64_t>>;

TEST(Shards, EachPlanningLiesInOneOfThem) {
  const ExpandedSweep all = small_sweep();
  for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{60}}) {
    Dealt dealt;
    std::size_t plannings = 0;
    for (std::size_t index = 0; index < count; ++index) {
      ExpandedSweep part = all;
      deal(part, 2, {index, count}, 1, {1, 1, 1});
      for (const NamedCase& named : part.cases) {
        for (const Planning& planning : named.plannings) {
          dealt.emplace(named.name, planning.position, planning.repetition);
          ++plannings;
        }
      }
    }
    EXPECT_EQ(plannings, 60u) << count;
    EXPECT_EQ(dealt.size(), 60u) << count;
  }
}

TEST(Shards, TakeAboutTheSameTime) {
  const std::vector<double> seconds = {1, 2, 30};
  std::vector<double> loads;
  for (std::size_t index = 0; index < 5; ++index) {
    ExpandedSweep part = small_sweep();
    deal(part, 1, {index, 5}, 1, seconds);
    double load = 0;
    for (const NamedCase& named : part.cases) {
      const double each = named.parameters.robots == 12 ? 30 : named.parameters.robots == 4 ? 2 : 1;
      load += each * static_cast<double>(named.plannings.size());
    }
    loads.push_back(load);
  }
  // 330 s in all; the last to be dealt out are the shortest.
  EXPECT_LE(*std::max_element(loads.begin(), loads.end()) - *std::min_element(loads.begin(), loads.end()), 1);
}

TEST(Shards, AreDealtOutInAnOrderThatTheSeedShuffles) {
  const auto first = [](std::uint64_t seed) {
    ExpandedSweep part = small_sweep();
    deal(part, 1, {0, 3}, seed, {1, 1, 1});
    std::vector<std::int64_t> positions;
    for (const NamedCase& named : part.cases) {
      for (const Planning& planning : named.plannings) positions.push_back(planning.position);
    }
    return positions;
  };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
  std::vector<std::int64_t> sorted = first(1);
  std::sort(sorted.begin(), sorted.end());
  EXPECT_NE(first(1), sorted);
}

}  // namespace
}  // namespace sipplab::bench
