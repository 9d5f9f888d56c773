// The published instances next to the project, if they are present.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "planner/solve/plan.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

namespace fs = std::filesystem;

/// $SIPPLAB_SHARED, or the folder "shared" next to the project.
fs::path shared_folder() {
  const char* const named = std::getenv("SIPPLAB_SHARED");
  return named ? fs::path(named) : fs::path(SIPPLAB_SOURCE_DIR) / ".." / "shared";
}

std::vector<fs::path> files_under(const fs::path& folder, const char* extension) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().extension() == extension) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Input<LoadedInstance> load(const fs::path& path) {
  InstanceFiles files;
  files.instance = path.string();
  return load_instance(files);
}

TEST(IoSharedData, EveryInstanceOfTheArchiveLoads) {
  const std::vector<fs::path> files = files_under(shared_folder() / "aamas2018", ".xml");
  if (files.empty()) GTEST_SKIP() << "no aamas2018 in " << shared_folder() << " (set SIPPLAB_SHARED)";
  for (const fs::path& path : files) {
    const Input<LoadedInstance> loaded = load(path);
    ASSERT_TRUE(loaded) << loaded.error().message();
    EXPECT_TRUE(loaded->warnings.empty()) << loaded->warnings.front();
    const bool is_warehouse = loaded->instance.map.width() == 35;
    EXPECT_EQ(loaded->instance.map.blocked_count(), is_warehouse ? 100u : 0u) << path;
    // The folder is named after the number of robots.
    EXPECT_EQ(std::to_string(loaded->instance.agents.size()), path.parent_path().filename().string());
  }
}

TEST(IoSharedData, EveryScenarioFindsItsMap) {
  const std::vector<fs::path> files = files_under(shared_folder() / "movingai", ".scen");
  if (files.empty()) GTEST_SKIP() << "no movingai in " << shared_folder() << " (set SIPPLAB_SHARED)";
  for (const fs::path& path : files) {
    const Input<LoadedInstance> loaded = load(path);
    EXPECT_TRUE(loaded) << loaded.error().message();
  }
}

TEST(IoSharedData, ExamplesLoadInOneFileAndInParts) {
  const fs::path folder = shared_folder() / "aa-sipp-m-examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << " (set SIPPLAB_SHARED)";
  const Input<LoadedInstance> whole = load(folder / "all_in_one_example.xml");
  ASSERT_TRUE(whole) << whole.error().message();
  InstanceFiles files;
  files.task = (folder / "task_example.xml").string();
  files.map = (folder / "map_example.xml").string();
  files.config = (folder / "config_example.xml").string();
  files.obstacles = (folder / "obstacles_example.xml").string();
  const Input<LoadedInstance> parts = load_instance(files);
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_EQ(whole->instance, parts->instance);
  EXPECT_EQ(whole->instance.agents.size(), 7u);
  EXPECT_EQ(whole->instance.obstacles.size(), 3u);
  EXPECT_TRUE(whole->warnings.empty() && parts->warnings.empty());
}

TEST(IoSharedData, PublishedLogsReadAsSolutions) {
  const fs::path folder = shared_folder() / "aa-sipp-m-examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << " (set SIPPLAB_SHARED)";
  const Input<LoadedInstance> loaded = load(folder / "all_in_one_example.xml");
  ASSERT_TRUE(loaded) << loaded.error().message();
  for (const char* name : {"all_in_one_example_log.xml", "task_example_log.xml"}) {
    const Input<SolutionDocument> document = load_solution((folder / name).string(), loaded->instance);
    ASSERT_TRUE(document) << document.error().message();
    // The log says so itself, rounded to 8 digits.
    EXPECT_NEAR(makespan_s(document->solution), *document->makespan_s, 1e-4);
    EXPECT_NEAR(flowtime_s(document->solution), *document->flowtime_s, 1e-3);
    for (AgentIndex i = 0; i < loaded->instance.agents.size(); ++i) {
      for (const TimedMotion& motion : document->solution.trajectories[i].motions) {
        if (motion.is_wait()) continue;
        const double expected_s =
            distance(motion.from, motion.to) / loaded->instance.agents[i].speed_cells_per_s;
        EXPECT_NEAR(motion.end_s - motion.begin_s, expected_s, 1e-9 * std::max(1.0, motion.end_s));
      }
    }
  }
}

/// The current state of the published planner turns where it should; when the logs were
/// made it mixed up headings of downward moves, so these do not keep their own rules.
TEST(IoSharedData, ExamplesPlanWithTurnsAndNoWorseThanTheirLogs) {
  const fs::path folder = shared_folder() / "aa-sipp-m-examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << " (set SIPPLAB_SHARED)";
  const Input<LoadedInstance> loaded = load(folder / "all_in_one_example.xml");
  ASSERT_TRUE(loaded) << loaded.error().message();
  const PlannerOptions options = loaded->options.applied_to({});
  EXPECT_TRUE(options.rules.turns);
  const PlanResult result = plan(loaded->instance, options);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  const ValidationReport report =
      validate(loaded->instance, result.solution, {options.ssi_s, result.order(), options.rules});
  EXPECT_TRUE(report.valid()) << report.violations.front().message;
  for (const char* name : {"all_in_one_example_log.xml", "task_example_log.xml"}) {
    const Input<SolutionDocument> log = load_solution((folder / name).string(), loaded->instance);
    ASSERT_TRUE(log) << log.error().message();
    EXPECT_LE(flowtime_s(result.solution), *log->flowtime_s);
    EXPECT_LE(makespan_s(result.solution), *log->makespan_s);
    const ValidationReport of_log = validate(loaded->instance, log->solution, {0, {}, options.rules});
    ASSERT_FALSE(of_log.valid());
    for (const Violation& violation : of_log.violations) {
      EXPECT_TRUE(violation.kind == ViolationKind::kHeading || violation.kind == ViolationKind::kStandingTime)
          << violation.message;
    }
    EXPECT_TRUE(validate(loaded->instance, log->solution).valid());
  }
}

}  // namespace
}  // namespace sipplab
