// What another planner is called after, and how its memory is seen.
#include "bench/sweep/command_planner.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "bench/process_tree.hpp"
#include "bench/temporary_folder.hpp"

namespace sipplab::bench {
namespace {

std::string name_of(const std::string& command) {
  const auto spec = parse_command_planner("cmd:" + command, "");
  return spec ? spec->name : "refused: " + spec.error();
}

TEST(CommandPlanner, IsCalledAfterItsProgramWhateverStartsIt) {
  EXPECT_EQ(name_of("pl1 settings.cfg {scen}"), "pl1");
  EXPECT_EQ(name_of("pl2 settings.cfg {scen}"), "pl2");
  EXPECT_EQ(name_of("env X=1 Y=a/b p {scen}"), "p");
  EXPECT_EQ(name_of("X=1 p {scen}"), "p");
  EXPECT_EQ(name_of("env -u HOME -i p {scen}"), "p");
  EXPECT_EQ(name_of("nice -n 5 p {scen}"), "p");
  EXPECT_EQ(name_of("timeout -k 1 5 nice p {scen}"), "p");
  EXPECT_EQ(name_of("/usr/bin/env -S timeout 5 p {scen}"), "p");
  EXPECT_EQ(name_of("taskset -c 0 p {scen}"), "p");
  EXPECT_EQ(name_of("stdbuf -oL p {scen}"), "p");
  EXPECT_EQ(name_of("cd /tmp && ./p {scen}"), "p");
  EXPECT_EQ(name_of("cd /tmp; ulimit -s unlimited && exec ./p {scen}"), "p");
  EXPECT_EQ(name_of("p=1 {scen}"), "{scen}");
}

TEST(CommandPlanner, IsCalledAfterTheScriptThatAnInterpreterRuns) {
  EXPECT_EQ(name_of("python3 -u p {scen}"), "p");
  EXPECT_EQ(name_of("python3.11 -m package.run {scen}"), "package.run");
  EXPECT_EQ(name_of("java -jar planner.jar {scen}"), "planner.jar");
  EXPECT_EQ(name_of("python3 -c 'print(1)' {scen}"), "python3");
  // Of two words the one that is a file: -W takes a word.
  const auto folder = TemporaryFolder::make();  // of its own: tests run side by side
  ASSERT_TRUE(folder.has_value());
  const std::filesystem::path script = folder->path() / "planner.py";
  std::ofstream(script) << "\n";
  EXPECT_EQ(name_of("python3 -W ignore " + script.string() + " {scen}"), "planner.py");
}

TEST(CommandPlanner, AProgramThatIsNotThereIsRefused) {
  EXPECT_NE(name_of("nice ./nowhere/p {scen}").find("./nowhere/p: no such file"), std::string::npos);
}

TEST(ResidentBytes, AreThoseThatWereTouchedOfAllDescendants) {
  constexpr std::size_t kTouched = std::size_t{64} << 20;
  constexpr std::uint64_t kNoLimit = UINT64_MAX;
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    if (fork() == 0) {  // a grandchild holds it, and the address space of a hundred times as much
      void* const memory = mmap(nullptr, 100 * kTouched, PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
      for (std::size_t i = 0; memory != MAP_FAILED && i < kTouched; i += 4096)
        static_cast<char*>(memory)[i] = 1;
      if (write(ready[1], "x", 1) != 1) _exit(1);
      for (;;) pause();
    }
    for (;;) pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  const std::uint64_t seen = resident_bytes(child, kNoLimit);
  const std::uint64_t shared_once = resident_bytes(child, 0);
  kill(-child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(ready[0]);
  close(ready[1]);
  EXPECT_GE(seen, kTouched);
  EXPECT_LT(seen, 50 * kTouched);
  EXPECT_GE(shared_once, kTouched * 9 / 10);
  EXPECT_LE(shared_once, seen);
}

}  // namespace
}  // namespace sipplab::bench
