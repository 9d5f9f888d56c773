// Parts of a sweep, for several machines or one after the other, and what is left of one that was stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/sweep/expand.hpp"
#include "db/recorder.hpp"

namespace sipplab::bench {

/// Part `index` of `count`. All parts together are the sweep, each planning once.
struct Shard {
  std::size_t index = 0;  ///< counted from 0
  std::size_t count = 1;
};

/// "2/8" is the second of eight. None for anything else.
std::optional<Shard> parse_shard(const std::string& text);

/// What one planning of a case is expected to take, where nothing is known of it: by its robots alone, and
/// the same on every machine.
double expected_seconds(const SweepCase& sweep_case);

/// The plannings of a sweep: each instance of each case, `repetitions` times.
std::size_t planning_count(const ExpandedSweep& sweep, std::int64_t repetitions);

/// Gives each case all of its plannings.
void deal_all(ExpandedSweep& sweep, std::int64_t repetitions);

/// Gives each case those of its plannings that lie in the shard, and leaves out cases of which none does.
/// Instances and repetitions of a case are dealt out like any others: in an order shuffled by `seed`, the
/// longest first, each to the shard that has the least to do. `seconds`: expected of a planning of each case.
/// If there are many more instances than shards, all plannings of an instance lie in one shard, where what
/// they share (distances, lower bounds) is computed once. Within a shard cases and plannings stay in shuffled
/// order, so that one that is cut off favours no case.
void deal(ExpandedSweep& sweep, std::int64_t repetitions, const Shard& shard, std::uint64_t seed,
          const std::vector<double>& seconds);

/// Plannings that are to be done.
std::size_t count_left(const ExpandedSweep& sweep);

/// Takes what a run holds out of what is to be done, and adds it to the outcomes.
void leave_out(ExpandedSweep& sweep, const std::vector<db::RecordedCase>& recorded);

}  // namespace sipplab::bench
