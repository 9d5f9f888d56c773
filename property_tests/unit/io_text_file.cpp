// Whole files in and out.
#include "planner/io/text_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace sipplab {
namespace {

class IoTextFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("sipplab_file_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) const { return (folder_ / name).string(); }
  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

  std::filesystem::path folder_;
};

TEST_F(IoTextFile, WhatIsWrittenIsRead) {
  const std::string text("one\0two\n", 8);
  EXPECT_FALSE(write_file(path("a"), text));
  const Input<std::string> again = read_file(path("a"));
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, text);
  EXPECT_FALSE(write_file(path("a"), ""));
  EXPECT_EQ(*read_file(path("a")), "");
  EXPECT_EQ(files(), 1);
}

TEST_F(IoTextFile, LargeFilesAreReadWhole) {
  const std::string text(1'000'003, 'x');
  EXPECT_FALSE(write_file(path("a"), text));
  EXPECT_EQ(*read_file(path("a")), text);
}

TEST_F(IoTextFile, AReplacedFileKeepsItsModeAndItsLinks) {
  EXPECT_FALSE(write_file(path("a"), "old"));
  ASSERT_EQ(::chmod(path("a").c_str(), 0600), 0);
  std::filesystem::create_symlink("a", folder_ / "link");
  EXPECT_FALSE(write_file(path("link"), "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_EQ(*read_file(path("a")), "new");
  struct stat status {};
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
}

TEST_F(IoTextFile, FailuresAreOneLineAndLeaveNothing) {
  EXPECT_EQ(write_file(path("no/such"), "x")->message(),
            path("no/such") + ": cannot be written: no such file or directory");
  EXPECT_EQ(write_file(folder_.string(), "x")->message(),
            folder_.string() + ": is a directory, expected a file");
  EXPECT_EQ(files(), 0);
}

TEST_F(IoTextFile, AFullDiskIsReportedAndItsDeviceStays) {
  struct stat status {};
  if (::stat("/dev/full", &status) != 0) GTEST_SKIP() << "this system has no /dev/full";
  const auto error = write_file("/dev/full", "x");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message(), "/dev/full: cannot be written: no space left on device");
  ASSERT_EQ(::stat("/dev/full", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
}

TEST_F(IoTextFile, AClosedFileIsNotReplaced) {
  if (::geteuid() == 0) GTEST_SKIP() << "permissions do not bind the superuser";
  EXPECT_FALSE(write_file(path("a"), "old"));
  ASSERT_EQ(::chmod(path("a").c_str(), 0400), 0);
  EXPECT_EQ(write_file(path("a"), "new")->message(), path("a") + ": cannot be written: permission denied");
  EXPECT_EQ(*read_file(path("a")), "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0), 0);
  EXPECT_EQ(read_file(path("a")).error().message(),
            path("a") + ": cannot be read: permission denied, expected a readable file");
}

TEST_F(IoTextFile, EndlessFilesAreRefused) {
  const Input<std::string> text = read_file("/dev/zero");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().what, "is too large");
}

}  // namespace
}  // namespace sipplab
