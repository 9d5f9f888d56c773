// Counts of claims and events: kept in a file, also by processes that die.
#include "fuzz/support/claims.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "bench/campaigns/counts.hpp"

namespace sipplab::fuzz {
namespace {

/// A file that is removed at the end of a test.
class CountsFile {
 public:
  CountsFile() : path_((std::filesystem::temp_directory_path() / "sipplab-counts-XXXXXX").string()) {
    const int file = mkstemp(path_.data());
    if (file >= 0) close(file);
  }
  ~CountsFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs it in a child with counts going to the file; gives the child's status.
template <class Run>
int in_child(const CountsFile& file, const Run& run) {
  const pid_t child = fork();
  if (child == 0) {
    setenv(kCountsVariable, file.path().c_str(), 1);
    close(STDERR_FILENO);
    run();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

std::uint64_t count_of(const CountsFile& file, std::string_view name) {
  for (const Count& count : read_counts(file.path())) {
    if (count.name == name) return count.count;
  }
  return 0;
}

TEST(Claims, every_one_has_a_name_of_its_own) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kClaims; ++i) names.insert(name(static_cast<Claim>(i)));
  for (std::size_t i = 0; i < kEvents; ++i) names.insert(name(static_cast<Event>(i)));
  EXPECT_EQ(names.size(), kClaims + kEvents);
  EXPECT_EQ(names.count(""), 0U);
  for (const std::string_view name : names) EXPECT_LT(name.size(), CountRow{}.name.size()) << name;
  EXPECT_EQ(name(Claim::kTwinsAgree), "twins agree");
  EXPECT_EQ(name(Claim::kCompleteIsComplete), "complete is complete");
  EXPECT_EQ(name(Event::kComparisons), "comparisons");
}

TEST(Claims, several_processes_add_to_the_same_counts) {
  const CountsFile file;
  for (int i = 0; i < 3; ++i) {
    in_child(file, [] {
      count(Event::kInputs);
      count(Event::kSolved);
      count(Event::kInputs);
    });
  }
  EXPECT_EQ(count_of(file, "inputs"), 6U);
  EXPECT_EQ(count_of(file, "solved"), 3U);
  EXPECT_EQ(read_counts(file.path()).size(), 2U);
}

TEST(Claims, a_broken_claim_ends_the_process_and_its_counts_stay) {
  const CountsFile file;
  const int status = in_child(file, [] {
    count(Event::kInputs);
    require(Claim::kPlanIsValid, true, "");
    require(Claim::kPlanIsValid, false, "no");
    count(Event::kSolved);
  });
  EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(count_of(file, "plan is valid"), 2U);
  EXPECT_EQ(count_of(file, "solved"), 0U);
}

TEST(Claims, a_file_that_holds_no_counts_gives_none) {
  EXPECT_TRUE(read_counts("no/such/file").empty());
  const CountsFile empty;
  EXPECT_TRUE(read_counts(empty.path()).empty());
}

}  // namespace
}  // namespace sipplab::fuzz
