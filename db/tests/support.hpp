// What the tests of db/ share: a folder that vanishes, and rows to write.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

#include "db/database.hpp"
#include "db/recorder.hpp"
#include "db/records.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Each test has a folder of its own, which is removed after it.
class DatabaseTest : public ::testing::Test {
 protected:
  DatabaseTest();
  ~DatabaseTest() override;
  DatabaseTest(const DatabaseTest&) = delete;
  DatabaseTest& operator=(const DatabaseTest&) = delete;

  std::filesystem::path folder;
  std::filesystem::path file;  ///< "test.db" in it; not there yet
};

/// The value, or a failed test and the end of the program: what follows would make
/// no sense without it.
template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().message;
    std::abort();
  }
  return std::move(*result);
}

RunInfo sample_run(const std::string& suite = "smoke");
CaseInfo sample_case(std::int64_t robots, double ssi_s = 5);
InstanceInfo sample_instance(int index);
/// A solved result whose numbers differ from instance to instance.
ResultRow sample_result(int index);
ResultRow failed_result();

/// Adds `count` solved results of sample instances to a case and commits it.
void record_case(RunRecorder& recorder, const CaseInfo& parameters, int count);

/// First column of the first row, on a connection of its own.
std::string ask(const std::filesystem::path& file, const std::string& sql);
void expect_sound(const std::filesystem::path& file);

std::string bytes_of(const std::filesystem::path& file);

}  // namespace sipplab::db::test
