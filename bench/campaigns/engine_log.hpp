// What libFuzzer prints, as numbers.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "db/fuzz_runs.hpp"

namespace sipplab::bench {

struct EngineLog {
  std::vector<db::FuzzSnapshot> snapshots;  ///< thinned: each has at least a quarter more executions
  db::FuzzSnapshot last;
  std::int64_t corpus_bytes = 0;
  std::int64_t peak_memory_bytes = 0;
  std::int64_t slowest_input_s = 0;
};

/// Reads lines such as
///   #8192 pulse  cov: 559 ft: 1498 corp: 236/8671b lim: 80 exec/s: 4096 rss: 72Mb
///   #8192: cov: 559 ft: 1498 corp: 236 exec/s 4096 oom/timeout/crash: 0/0/0 time: 12s job: 3
/// the latter in fork mode, and the final statistics. Anything else is passed over.
EngineLog parse_engine_log(std::string_view text);

}  // namespace sipplab::bench
