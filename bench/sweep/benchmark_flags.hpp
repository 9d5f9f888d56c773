// Google Benchmark's own flags, checked before they are handed on: the library would
// answer some mistakes by ending the program with exit code 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sipplab/error.hpp"

namespace sipplab::bench {

/// What a sweep needs to know of the flags.
struct BenchmarkFlags {
  std::string format;  ///< "console", "json", "csv"; empty unless given
  std::string filter;  ///< empty or "all" for all
  bool list_tests = false;
  std::int64_t repetitions = 1;
};

/// Hands `--benchmark_*` flags to the library. Errors: one line for a flag that is
/// unknown, malformed or of no use to a sweep.
Expected<BenchmarkFlags, std::string> initialize_benchmark(const std::vector<std::string>& flags);

/// Whether each name matches Google Benchmark's filter syntax: an extended regular
/// expression, negated by a leading '-'. Errors: one line.
Expected<std::vector<bool>, std::string> filter_matches(const std::string& filter,
                                                        const std::vector<std::string>& names);

}  // namespace sipplab::bench
