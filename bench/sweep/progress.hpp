// How far a sweep is, on stderr: one live line on a terminal, a plain line for each
// finished case elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace sipplab::bench {

class Progress {
 public:
  /// Counts of the whole sweep; an instance counts once per repetition.
  Progress(std::size_t cases, std::size_t instances, bool on_terminal);

  void begin_case(const std::string& name, std::size_t instances);
  void finish_instance();
  /// `result` says what came out: "success 0.90".
  void finish_case(const std::string& result);
  /// Removes the live line, so that other output can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string times() const;
  void draw();

  std::size_t cases_;
  std::size_t instances_;
  bool on_terminal_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_{};
  std::size_t case_number_ = 0;
  std::size_t instances_done_ = 0;
  std::string name_;
  std::size_t case_instances_ = 0;
  std::size_t case_instances_done_ = 0;
};

}  // namespace sipplab::bench
