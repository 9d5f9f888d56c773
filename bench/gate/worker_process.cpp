#include "bench/gate/worker_process.hpp"
#include "planner/core/try.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace sipplab::bench {
namespace {

/// The longest planning of a suite takes a fraction of a second; with sanitizers on, seconds.
constexpr int kAnswerTimeoutMs = 120'000;

/// What the dynamic linker and the C library need; everything else is left out, so that both
/// builds see the same environment, of the same size.
constexpr std::array<const char*, 5> kPassedOn = {"PATH", "HOME", "LD_LIBRARY_PATH", "ASAN_OPTIONS",
                                                  "UBSAN_OPTIONS"};

std::vector<std::string> environment(const std::vector<std::string>& extras) {
  std::vector<std::string> variables;
  for (const char* name : kPassedOn) {
    if (const char* value = std::getenv(name)) variables.push_back(fmt::format("{}={}", name, value));
  }
  variables.insert(variables.end(), extras.begin(), extras.end());
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

bool open_pipe(Pipe& pipe_ends) {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  pipe_ends = {ends[0], ends[1]};
  return true;
}

void close_if_open(int descriptor) {
  if (descriptor >= 0) close(descriptor);
}

/// In the new process, between fork and exec: system calls and nothing else.
[[noreturn]] void become(const char* program, char* const* arguments, char* const* variables, int in, int out,
                         std::optional<int> core) {
  if (core) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(*core), &set);
    sched_setaffinity(0, sizeof set, &set);  // if it is refused, times are noisier and still right
  }
  if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0) execve(program, arguments, variables);
  constexpr int kCannotExecute = 127;  // as shells do
  _exit(kCannotExecute);
}

}  // namespace

std::vector<int> allowed_cores() {
  std::vector<int> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) cores.push_back(core);
  }
  return cores;
}

Expected<std::string, std::string> find_program(const std::string& build) {
  std::error_code ignored;
  std::filesystem::path path(build);
  if (std::filesystem::is_directory(path, ignored)) path /= "sipplab";
  if (!std::filesystem::is_regular_file(path, ignored) || access(path.c_str(), X_OK) != 0) {
    return Unexpected{build + ": no program, expected a sipplab binary or a build folder that holds one"};
  }
  return std::filesystem::absolute(path, ignored).string();
}

Expected<WorkerProcess, std::string> WorkerProcess::start(const Start& start) {
  Pipe requests;
  Pipe answers;
  const bool piped = open_pipe(requests) && open_pipe(answers);
  // The same name for both builds: its length moves the stack.
  std::vector<std::string> words = {"sipplab", "gate", "--serve"};
  std::vector<std::string> variables = environment(start.extras);
  const std::vector<char*> arguments = pointers(words);
  const std::vector<char*> environment_pointers = pointers(variables);
  const pid_t process = piped ? fork() : -1;
  if (process == 0) {
    become(start.program.c_str(), arguments.data(), environment_pointers.data(), requests.read_end,
           answers.write_end, start.core);
  }
  const std::string reason = process < 0 ? std::strerror(errno) : "";
  close_if_open(requests.read_end);
  close_if_open(answers.write_end);
  if (process < 0) {
    close_if_open(requests.write_end);
    close_if_open(answers.read_end);
    return Unexpected{start.title + " build: cannot start a process: " + reason};
  }
  WorkerProcess worker(start.title, process, requests.write_end, answers.read_end);
  const Expected<nlohmann::json, std::string> line = worker.read_line();
  if (!line || !line->contains("sipplab_gate")) {
    return Unexpected{
        worker.complaint(start.program + " does not serve the gate, expected a sipplab that knows `gate`")};
  }
  Expected<WorkerGreeting, std::string> greeting = greeting_from_json(*line);
  if (!greeting) return Unexpected{worker.complaint(greeting.error())};
  worker.greeting_ = std::move(*greeting);
  return worker;
}

WorkerProcess::WorkerProcess(std::string title, pid_t process, int to, int from)
    : title_(std::move(title)), process_(process), to_(to), from_(from) {}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : title_(std::move(other.title_)),
      process_(std::exchange(other.process_, -1)),
      to_(std::exchange(other.to_, -1)),
      from_(std::exchange(other.from_, -1)),
      buffer_(std::move(other.buffer_)),
      greeting_(std::move(other.greeting_)) {}

WorkerProcess::~WorkerProcess() {
  close_if_open(to_);
  close_if_open(from_);
  if (process_ <= 0) return;
  kill(process_, SIGKILL);  // it holds nothing that would have to be saved
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Expected<std::string, std::string> WorkerProcess::load(const std::string& file) {
  const auto answer = SIPPLAB_TRY(ask({{"load", file}}));
  return answer.value("content_hash", "");
}

Expected<std::size_t, std::string> WorkerProcess::add_job(std::size_t instance, const PlannerOptions& options,
                                                          GateTask task) {
  nlohmann::json request = {{"instance", instance}, {"options", to_json(options)}};
  if (task != GateTask::kPlan) request["task"] = name(task);
  const auto answer = SIPPLAB_TRY(ask(request));
  return answer.value("job", std::size_t{0});
}

Expected<WorkerAnswer, std::string> WorkerProcess::plan(std::size_t job, Ask what) {
  const auto answer =
      SIPPLAB_TRY(ask({{"plan", job}, {"check", what == Ask::kVerdict}, {"memory", what == Ask::kPages}}));
  Expected<WorkerAnswer, std::string> read = answer_from_json(answer);
  if (!read) return Unexpected{complaint(read.error())};
  return read;
}

Expected<nlohmann::json, std::string> WorkerProcess::ask(const nlohmann::json& request) {
  const std::string line = request.dump() + "\n";
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = write(to_, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return Unexpected{complaint("its process ended")};
    done += static_cast<std::size_t>(written);
  }
  Expected<nlohmann::json, std::string> answer = read_line();
  if (answer && answer->contains("error")) {
    return Unexpected{complaint(answer->value("error", "an error without words"))};
  }
  return answer;
}

Expected<nlohmann::json, std::string> WorkerProcess::read_line() {
  std::size_t end = 0;
  while ((end = buffer_.find('\n')) == std::string::npos) {
    pollfd ready = {from_, POLLIN, 0};
    const int polled = poll(&ready, 1, kAnswerTimeoutMs);
    if (polled < 0 && errno == EINTR) continue;
    if (polled == 0) {
      return Unexpected{complaint(fmt::format("no answer within {} s", kAnswerTimeoutMs / 1000))};
    }
    std::array<char, 4096> bytes{};
    const ssize_t count = read(from_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Unexpected{complaint("its process ended")};
    buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  }
  nlohmann::json line = nlohmann::json::parse(buffer_.substr(0, end), nullptr, false);
  buffer_.erase(0, end + 1);
  if (!line.is_object()) return Unexpected{complaint("it says something else than JSON")};
  return line;
}

}  // namespace sipplab::bench
