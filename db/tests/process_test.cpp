// Many processes on one file: killed ones, and ones that write at the same time.
#include <fmt/core.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "db/identity.hpp"
#include "db/queries.hpp"
#include "db/tests/support.hpp"
#include "planner/core/random.hpp"

namespace sipplab::db {
namespace {

using namespace std::chrono_literals;
using test::ask;
using test::must;
using test::sample_case;
using test::sample_run;

/// Runs `body` in a child process, whose exit code is what it returns.
template <class Body>
pid_t start(Body body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  return child;
}

int exit_code(pid_t child) {
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

/// SIPPLAB_TEST_KILLS=200 and SIPPLAB_TEST_SECONDS=60 make these tests as long as one likes.
int from_environment(const char* name, int usual) {
  const char* text = std::getenv(name);
  return text == nullptr ? usual : std::atoi(text);
}

class Processes : public test::DatabaseTest {};

/// Kills and collects a child, whatever way the test ends.
class KillAtEnd {
 public:
  explicit KillAtEnd(pid_t child) : child_(child) {}
  KillAtEnd(const KillAtEnd&) = delete;
  KillAtEnd& operator=(const KillAtEnd&) = delete;
  ~KillAtEnd() { now(); }

  void now() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = 0;
  }

 private:
  pid_t child_;
};

/// Records cases of `results` each, starting with `first`; reports each finished case
/// as one byte through the pipe.
int record_without_end(RunRecorder& recorder, std::int64_t first, int results, int pipe_end) {
  for (std::int64_t robots = first;; ++robots) {
    const CaseInfo parameters = sample_case(robots);
    for (int i = 0; i < results; ++i) {
      recorder.add(parameters, test::sample_instance(i), test::sample_result(i));
    }
    if (!recorder.commit()) return 1;
    if (write(pipe_end, "c", 1) != 1) return 1;
  }
}

TEST_F(Processes, a_killed_sweep_keeps_what_was_committed_and_is_resumed) {
  const int kills = from_environment("SIPPLAB_TEST_KILLS", 50 / SIPPLAB_SHARE_OF_CASES);
  constexpr int kResults = 40;
  Random random{1};
  std::int64_t finished = 0;
  const std::string uuid = must(RunRecorder::begin(must(Database::open(file)), sample_run())).run_uuid();
  // The run began in this process, which is alive and so would be left alone.
  ask(file, "UPDATE run SET writer = 'gone' RETURNING 1");
  for (int kill_number = 0; kill_number < kills; ++kill_number) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    const pid_t child = start([&] {
      close(ends[0]);
      auto database = Database::open(file);
      if (!database) return 1;
      auto recorder = RunRecorder::resume(std::move(*database), uuid, sample_run());
      if (!recorder) return 1;
      return record_without_end(*recorder, finished, kResults, ends[1]);
    });
    close(ends[1]);
    // Some are killed while they open the file, most in the middle of writing.
    std::int64_t reported = 0;
    char byte = 0;
    const auto enough = static_cast<std::int64_t>(random.below(4));
    while (reported < enough && read(ends[0], &byte, 1) == 1) ++reported;
    std::this_thread::sleep_for(std::chrono::microseconds{random.below(3'000)});
    kill(child, SIGKILL);
    while (read(ends[0], &byte, 1) == 1) ++reported;
    close(ends[0]);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";

    // One case may be committed and not reported yet.
    const std::int64_t cells = std::stoll(ask(file, "SELECT count(*) FROM cell"));
    EXPECT_GE(cells, finished + reported);
    EXPECT_LE(cells, finished + reported + 1);
    EXPECT_EQ(ask(file, "SELECT count(*) FROM result"), std::to_string(cells * kResults));
    EXPECT_EQ(ask(file, "SELECT ifnull(max(robots), -1) FROM case_"), std::to_string(cells - 1));
    test::expect_sound(file);
    finished = cells;
  }
  EXPECT_GT(finished, 0) << "no case was finished before a kill: nothing was tested";
  auto database = must(Database::open(file));
  const auto resumable = must(find_earlier_run(database, sample_run()));
  ASSERT_TRUE(resumable);
  EXPECT_EQ(resumable->uuid, uuid);
  EXPECT_EQ(resumable->status, RunStatus::kRunning);
}

TEST_F(Processes, eight_writers_and_two_readers_never_see_a_lock) {
  constexpr int kWriters = 8;
  const std::chrono::seconds time{from_environment("SIPPLAB_TEST_SECONDS", 2)};
  std::vector<pid_t> children;
  const auto end = std::chrono::steady_clock::now() + time;
  for (int writer = 0; writer < kWriters; ++writer) {
    // Each opens the file itself: eight at once make the fresh schema, too.
    children.push_back(start([&] {
      auto database = Database::open(file);
      if (!database) return 1;
      auto recorder = RunRecorder::begin(std::move(*database), sample_run());
      if (!recorder) return 2;
      // One case at least, however busy the machine is.
      for (std::int64_t robots = 0; robots == 0 || std::chrono::steady_clock::now() < end; ++robots) {
        for (int i = 0; i < 20; ++i) {
          recorder->add(sample_case(robots), test::sample_instance(i), test::sample_result(i));
        }
        if (!recorder->commit()) return 3;
      }
      return recorder->finish(RunStatus::kFinished) ? 0 : 4;
    }));
  }
  while (!std::filesystem::exists(file) || std::filesystem::file_size(file) == 0)
    std::this_thread::sleep_for(1ms);
  for (int reader = 0; reader < 2; ++reader) {
    children.push_back(start([&] {
      while (std::chrono::steady_clock::now() < end) {
        auto table = run_sql(file, "SELECT count(*), sum(results) FROM v_runs");
        // The file is there before its schema is.
        if (!table && table.error().kind != ErrorKind::kNotADatabase) return 5;
      }
      return 0;
    }));
  }
  for (const pid_t child : children) EXPECT_EQ(exit_code(child), 0);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_runs WHERE status = 'finished' AND cases > 0"), "8");
  test::expect_sound(file);
}

TEST_F(Processes, a_fresh_file_is_made_by_eight_processes_at_once) {
  constexpr int kRounds = 25 / SIPPLAB_SHARE_OF_CASES;
  for (int round = 0; round < kRounds; ++round) {
    const auto fresh = folder / fmt::format("{}.db", round);
    std::array<int, 2> gate{};
    ASSERT_EQ(pipe(gate.data()), 0);
    std::vector<pid_t> children;
    for (int i = 0; i < 8; ++i) {
      children.push_back(start([&] {
        close(gate[1]);
        char byte = 0;
        // Returns when the parent closes its end: for all at the same time.
        if (read(gate[0], &byte, 1) != 0) return 1;
        return Database::open(fresh) ? 0 : 2;
      }));
    }
    close(gate[0]);
    close(gate[1]);
    for (const pid_t child : children) EXPECT_EQ(exit_code(child), 0);
    test::expect_sound(fresh);
  }
}

TEST_F(Processes, a_live_run_is_not_resumed_by_another_process) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = start([&] {
    auto recorder = RunRecorder::begin(must(Database::open(file)), sample_run());
    if (!recorder || write(ends[1], "b", 1) != 1) return 1;
    pause();
    return 0;
  });
  KillAtEnd writer{child};
  char byte = 0;
  ASSERT_EQ(read(ends[0], &byte, 1), 1);
  auto database = must(Database::open(file));
  EXPECT_TRUE(must(find_earlier_run(database, sample_run()))->being_written);
  const std::string uuid = ask(file, "SELECT uuid FROM run");
  const auto refused = RunRecorder::resume(must(Database::open(file)), uuid, sample_run());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("is being written"), std::string::npos);

  writer.now();
  EXPECT_FALSE(must(find_earlier_run(database, sample_run()))->being_written);
  EXPECT_TRUE(RunRecorder::resume(must(Database::open(file)), uuid, sample_run()));
  close(ends[0]);
  close(ends[1]);
}

TEST(Identity, processes_and_uuids) {
  EXPECT_TRUE(is_alive(this_process()));
  EXPECT_FALSE(is_alive(""));
  EXPECT_FALSE(is_alive("no-such-boot 1 1"));
  std::string restarted = this_process();
  restarted.back() = restarted.back() == '1' ? '2' : '1';
  EXPECT_FALSE(is_alive(restarted)) << "the same number at another time is another process";

  // One that has ended and was not waited for, as in a container whose first process collects none.
  std::array<int, 2> channel{};
  ASSERT_EQ(pipe(channel.data()), 0);
  const pid_t child = start([&channel] {
    const std::string process = this_process();
    return write(channel[1], process.data(), process.size()) > 0 ? 0 : 1;
  });
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  std::array<char, 256> process{};
  const ssize_t length = read(channel[0], process.data(), process.size());
  ASSERT_GT(length, 0);
  EXPECT_FALSE(is_alive(std::string_view{process.data(), static_cast<std::size_t>(length)}));
  EXPECT_EQ(exit_code(child), 0);
  close(channel[0]);
  close(channel[1]);

  const std::string uuid = new_uuid();
  EXPECT_EQ(uuid.size(), 36U);
  EXPECT_EQ(uuid[14], '4');
  EXPECT_NE(uuid, new_uuid());
  EXPECT_EQ(utc_now().size(), std::string{"2026-01-31T12:00:00.123Z"}.size());
}

}  // namespace
}  // namespace sipplab::db
