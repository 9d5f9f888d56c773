#include "bench/sweep/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace sipplab::bench {
namespace {

/// A person sees no more, and a terminal over the network should not have to.
constexpr std::chrono::milliseconds kBetweenDraws{100};

std::string minutes(std::chrono::duration<double> time) {
  constexpr std::int64_t kSecondsPerMinute = 60;
  const auto seconds = static_cast<std::int64_t>(time.count() + 0.5);
  return fmt::format("{}:{:02}", seconds / kSecondsPerMinute, seconds % kSecondsPerMinute);
}

std::size_t terminal_width() {
  constexpr std::size_t kUsualWidth = 80;
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

}  // namespace

Progress::Progress(std::size_t cases, std::size_t instances, bool on_terminal)
    : cases_(cases), instances_(instances), on_terminal_(on_terminal) {}

void Progress::begin_case(const std::string& name, std::size_t instances) {
  ++case_number_;
  name_ = name;
  case_instances_ = instances;
  case_instances_done_ = 0;
  drawn_ = {};
  draw();
}

void Progress::finish_instance() {
  ++instances_done_;
  ++case_instances_done_;
  draw();
}

void Progress::finish_case(const std::string& result) {
  if (on_terminal_) return;
  std::fputs(fmt::format("[{}/{}] {}: {} ({})\n", case_number_, cases_, name_, result, times()).c_str(),
             stderr);
}

void Progress::clear() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

/// What is left is taken to go at the pace of what is done.
std::string Progress::times() const {
  const std::chrono::duration<double> elapsed = Clock::now() - begin_;
  std::string text = minutes(elapsed) + " elapsed";
  if (instances_done_ > 0) {
    const double left = static_cast<double>(instances_) - static_cast<double>(instances_done_);
    text += ", about " + minutes(elapsed * (left / static_cast<double>(instances_done_))) + " left";
  }
  return text;
}

void Progress::draw() {
  if (!on_terminal_ || Clock::now() - drawn_ < kBetweenDraws) return;
  drawn_ = Clock::now();
  std::string line = fmt::format("[{}/{}] {}: {}, instance {}/{}", case_number_, cases_, times(), name_,
                                 std::min(case_instances_done_ + 1, case_instances_), case_instances_);
  line.resize(std::min(line.size(), terminal_width() - 1));  // a line that wraps cannot be taken back
  std::fputs(("\r\033[K" + line).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace sipplab::bench
