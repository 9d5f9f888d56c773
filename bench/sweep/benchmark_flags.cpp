#include "bench/sweep/benchmark_flags.hpp"

#include <benchmark/benchmark.h>
#include <regex.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string_view>

#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

const std::map<std::string_view, std::vector<std::string_view>> kChoices = {
    {"--benchmark_format", {"console", "json", "csv"}},
    {"--benchmark_out_format", {"console", "json", "csv"}},
    {"--benchmark_time_unit", {"ns", "us", "ms", "s"}},
};

std::optional<std::string> check_choice(std::string_view flag, std::string_view value) {
  const auto choices = kChoices.find(flag);
  if (choices == kChoices.end()) return std::nullopt;
  std::string names;
  for (const std::string_view choice : choices->second) {
    if (choice == value) return std::nullopt;
    names += (names.empty() ? "" : ", ") + std::string(choice);
  }
  return std::string(flag) + ": " + in_quotes(value) + ", expected one of " + names;
}

/// A flag without a value is true.
bool is_truthy(std::string_view value) {
  return value != "0" && value != "f" && value != "n" && value != "false" && value != "no" && value != "off";
}

/// Runs benchmark::Initialize and returns the arguments that it did not take; what
/// it says about them goes to `complaints` instead of stderr.
std::vector<std::string> hand_on(const std::vector<std::string>& flags, std::string& complaints) {
  std::vector<std::string> arguments = {"sipplab"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  // The library keeps pointers into its arguments.
  static std::vector<std::string> kept;
  kept = std::move(arguments);
  std::vector<char*> pointers;
  for (std::string& argument : kept) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(kept.size());
  std::ostringstream said;
  std::streambuf* const stderr_buffer = std::cerr.rdbuf(said.rdbuf());
  benchmark::Initialize(&count, pointers.data());
  std::cerr.rdbuf(stderr_buffer);
  complaints = said.str();
  return {pointers.begin() + 1, pointers.begin() + count};
}

}  // namespace

Expected<BenchmarkFlags, std::string> initialize_benchmark(const std::vector<std::string>& flags) {
  BenchmarkFlags known;
  for (const std::string& argument : flags) {
    const std::size_t equals = argument.find('=');
    const std::string flag = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (flag.compare(0, std::strlen("--benchmark_"), "--benchmark_") != 0) {
      return Unexpected{"unknown argument " + in_quotes(argument)};
    }
    if (flag == "--benchmark_min_warmup_time") {
      return Unexpected{flag + ": a sweep plans each instance once per repetition and has no warm-up"};
    }
    if (auto line = check_choice(flag, value)) return Unexpected{std::move(*line)};
    // The library ends the program with code 1 if it cannot write; nothing is cut here yet.
    if (flag == "--benchmark_out" && !std::ofstream(value, std::ios::app)) {
      return Unexpected{flag + ": " + in_quotes(value) + " cannot be written, expected a file"};
    }
    if (flag == "--benchmark_format") known.format = value;
    if (flag == "--benchmark_list_tests") known.list_tests = is_truthy(value);
    if (flag == "--benchmark_repetitions") {
      known.repetitions = parse_integer(value).value_or(0);
      if (known.repetitions < 1)
        return Unexpected{flag + ": " + in_quotes(value) + ", expected a number >= 1"};
    }
  }
  std::string complaints;
  const std::vector<std::string> left = hand_on(flags, complaints);
  known.filter = benchmark::GetBenchmarkFilter();
  if (left.empty()) return known;
  const std::string reason = complaints.empty() ? "unknown flag" : complaints;
  return Unexpected{in_quotes(left.front()) + ": " + reason};
}

Expected<std::vector<bool>, std::string> filter_matches(const std::string& filter,
                                                        const std::vector<std::string>& names) {
  std::string pattern = filter.empty() || filter == "all" ? "." : filter;
  const bool negated = pattern.front() == '-';
  if (negated) pattern.erase(0, 1);
  regex_t expression;
  if (const int code = regcomp(&expression, pattern.c_str(), REG_EXTENDED | REG_NOSUB); code != 0) {
    char reason[128] = "";
    regerror(code, &expression, reason, sizeof reason);
    return Unexpected{"--benchmark_filter: " + in_quotes(filter) + ": " + reason};
  }
  std::vector<bool> matches;
  for (const std::string& name : names) {
    matches.push_back((regexec(&expression, name.c_str(), 0, nullptr, 0) == 0) != negated);
  }
  regfree(&expression);
  return matches;
}

}  // namespace sipplab::bench
