#include "db/tests/support.hpp"
#include "db/tests/plain_case.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace sipplab::db::test {

DatabaseTest::DatabaseTest() {
  std::string pattern = (std::filesystem::temp_directory_path() / "sipplab-db-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) std::abort();
  folder = pattern;
  file = folder / "test.db";
}

DatabaseTest::~DatabaseTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

RunInfo sample_run(const std::string& suite) {
  RunInfo info;
  info.suite = suite;
  info.branch = "main";
  info.command_line = "sipplab bench --suite " + suite;
  info.options = "count=50 seed=1";
  info.seed = 1;
  info.time_limit_s = 300;
  info.commit = CommitInfo{"0123456789abcdef0123456789abcdef01234567",
                           "2026-01-31T12:00:00Z",
                           "Close the interval",
                           "fedcba9876543210fedcba9876543210fedcba98",
                           42,
                           40};
  info.machine = MachineInfo{"host", "A CPU", 2, std::int64_t{8} << 30, "Linux 6.1"};
  info.build = BuildInfo{"gcc", "12.2.0", "-O3", "Release", false, "", "00ff00ff00ff00ff", false};
  return info;
}

CaseInfo sample_case(std::int64_t robots, double ssi_s) {
  CaseInfo parameters = plain_case();
  parameters.robots = robots;
  parameters.options["ssi_s"] = ssi_s;
  return parameters;
}

InstanceInfo sample_instance(int index) {
  return InstanceInfo{fmt::format("{:016x}", index + 1),
                      "00000000000000aa",
                      fmt::format("warehouse seed=1 index={}", index),
                      64,
                      35,
                      21,
                      100};
}

ResultRow sample_result(int index) {
  ResultRow row;
  row.status = ResultStatus::kSolved;
  row.planning_time_ns = 1'000'000 + index;
  row.makespan_s = 30 + 0.1 * index;
  row.flowtime_s = 1000 + 0.3 * index;
  row.tries = 2;
  row.expansions = 5000;
  row.generations = 20000;
  const auto offset = static_cast<std::uint64_t>(index);
  row.plan_hash = std::uint64_t{0xfedcba9876543210} + offset;
  row.valid = true;
  row.min_clearance_cells = 1e-12;
  row.progress = {{0, 500'000, *row.flowtime_s + 100, 35, 900, 25},
                  {200, 1'000'000 + index, *row.flowtime_s, *row.makespan_s, 900, 25}};
  return row;
}

ResultRow failed_result() {
  ResultRow row;
  row.status = ResultStatus::kFailed;
  row.planning_time_ns = 7;
  row.tries = 1;
  return row;
}

void record_case(RunRecorder& recorder, const CaseInfo& parameters, int count) {
  for (int i = 0; i < count; ++i) recorder.add(parameters, sample_instance(i), sample_result(i));
  must(recorder.commit());
}

std::string ask(const std::filesystem::path& file, const std::string& sql) {
  auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
  return must(connection.query_text(sql, "asking"));
}

void expect_sound(const std::filesystem::path& file) {
  EXPECT_EQ(ask(file, "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM pragma_foreign_key_check"), "0");
  EXPECT_EQ(ask(file,
                "SELECT count(*) FROM cell WHERE result_count <> "
                "(SELECT count(*) FROM result WHERE cell_id = cell.id)"),
            "0");
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{stream}, std::istreambuf_iterator<char>{}};
}

}  // namespace sipplab::db::test
