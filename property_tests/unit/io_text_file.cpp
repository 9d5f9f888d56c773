// Whole files in and out.
#include "planner/io/text_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <functional>

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

TEST_F(IoTextFile, TextBeginsBehindItsByteOrderMark) {
  EXPECT_FALSE(write_file(path("a"), "\xef\xbb\xbfversion 1\n"));
  EXPECT_EQ(*read_text(path("a")), "version 1\n");
  EXPECT_EQ(read_file(path("a"))->size(), 13u);
  EXPECT_FALSE(write_file(path("a"), "\xef\xbb"));
  EXPECT_EQ(*read_text(path("a")), "\xef\xbb");
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

TEST_F(IoTextFile, PipesAreWrittenDirectlyAndStayPipes) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_FALSE(write_file(path("pipe"), "text"));
  std::array<char, 8> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 4);
  EXPECT_STREQ(got.data(), "text");
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "pipe"));
}

// A limit on the size of files stands for a full disk: the write fails half-way.
TEST_F(IoTextFile, WhatIsNotWrittenWholeIsNotWrittenAtAll) {
  EXPECT_FALSE(write_file(path("a"), "old"));
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit tight { 4096, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const auto error = write_file(path("a"), std::string(10'000, 'x'));
  const auto new_error = write_file(path("b"), std::string(10'000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_TRUE(error && new_error);
  EXPECT_EQ(error->message(), path("a") + ": cannot be written: file too large");
  EXPECT_EQ(*read_file(path("a")), "old");
  EXPECT_EQ(files(), 1);
}

/// The result of `check` in a process of its own that is not the superuser's:
/// permissions bind it, and no mistake of write_file can replace a device.
bool holds_unprivileged(const std::function<bool()>& check) {
  constexpr uid_t kNobody = 65534;
  const pid_t child = ::fork();
  if (child == 0) {
    const bool unprivileged = ::geteuid() != 0 || (::setgid(kNobody) == 0 && ::setuid(kNobody) == 0);
    ::_exit(unprivileged && check() ? 0 : 1);
  }
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_F(IoTextFile, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  EXPECT_TRUE(holds_unprivileged([] {
    const auto error = write_file("/dev/full", "x");
    return error && error->message() == "/dev/full: cannot be written: no space left on device";
  }));
}

TEST_F(IoTextFile, PermissionsAreRespectedAndReported) {
  EXPECT_FALSE(write_file(path("a"), "old"));
  // Anybody may rename files here, so the file's own mode decides.
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  ASSERT_EQ(::chmod(path("a").c_str(), 0444), 0);
  EXPECT_TRUE(holds_unprivileged([&] {
    const auto error = write_file(path("a"), "new");
    return error && error->message() == path("a") + ": cannot be written: permission denied";
  }));
  EXPECT_EQ(*read_file(path("a")), "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0), 0);
  EXPECT_TRUE(holds_unprivileged([&] {
    const Input<std::string> text = read_file(path("a"));
    return !text && text.error().message() ==
                        path("a") + ": cannot be read: permission denied, expected a readable file";
  }));
}

TEST_F(IoTextFile, EndlessFilesAreRefused) {
  const Input<std::string> text = read_file("/dev/zero");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().what, "is too large");
}

}  // namespace
}  // namespace sipplab
