#include "bench/sweep/shard.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "planner/core/number.hpp"
#include "planner/core/random.hpp"

namespace sipplab::bench {
namespace {

/// A planning of a sweep, by its case.
struct Dealt {
  std::size_t in_case;
  Planning planning;
};

std::vector<Dealt> all_plannings(const ExpandedSweep& sweep, std::int64_t repetitions) {
  std::vector<Dealt> all;
  all.reserve(planning_count(sweep, repetitions));
  for (std::size_t in_case = 0; in_case < sweep.cases.size(); ++in_case) {
    const std::size_t instances = sweep.sets[sweep.cases[in_case].parameters.set].instances.size();
    for (std::int64_t repetition = 0; repetition < repetitions; ++repetition) {
      for (std::size_t position = 0; position < instances; ++position) {
        all.push_back({in_case, {static_cast<std::int64_t>(position), repetition}});
      }
    }
  }
  return all;
}

/// What lies in one shard, by places in the shuffled order.
struct Piece {
  double seconds = 0;
  std::vector<std::size_t> plannings;
};

/// Whole instances are pieces if none takes more than a quarter of a shard's average: then loads differ by at
/// most that quarter.
constexpr double kInstancesPerShard = 4;

/// In the order of their first plannings.
std::vector<Piece> pieces_of(const ExpandedSweep& sweep, const std::vector<Dealt>& all,
                             const std::vector<double>& seconds, std::size_t shards) {
  std::vector<Piece> instances;
  std::vector<Piece> plannings;
  std::map<std::pair<std::size_t, std::int64_t>, std::size_t>
      place;  // of an instance: its set, and where in it
  double total = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double one = seconds[all[i].in_case];
    const std::pair key(sweep.cases[all[i].in_case].parameters.set, all[i].planning.position);
    const auto [found, is_new] = place.emplace(key, instances.size());
    if (is_new) instances.emplace_back();
    instances[found->second].seconds += one;
    instances[found->second].plannings.push_back(i);
    plannings.push_back({one, {i}});
    total += one;
  }
  const bool small = std::all_of(instances.begin(), instances.end(), [&](const Piece& instance) {
    return instance.seconds * kInstancesPerShard * static_cast<double>(shards) <= total;
  });
  return small && total > 0 ? instances : plannings;
}

}  // namespace

std::optional<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto index = parse_number<std::uint32_t>(std::string_view(text).substr(0, slash));
  const auto count = parse_number<std::uint32_t>(std::string_view(text).substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count) return std::nullopt;
  return Shard{*index - 1, *count};
}

double expected_seconds(const SweepCase& sweep_case) {
  // 32 robots take about 2 ms, and robots have to avoid each other; reading and checking takes something,
  // too.
  constexpr double kSecondsPerPair = 2e-6;
  constexpr double kLeastSeconds = 1e-4;
  const auto robots = static_cast<double>(sweep_case.robots);
  return kLeastSeconds + kSecondsPerPair * robots * robots;
}

std::size_t planning_count(const ExpandedSweep& sweep, std::int64_t repetitions) {
  std::size_t count = 0;
  for (const NamedCase& named : sweep.cases) count += sweep.sets[named.parameters.set].instances.size();
  return count * static_cast<std::size_t>(repetitions);
}

void deal_all(ExpandedSweep& sweep, std::int64_t repetitions) {
  for (const Dealt& one : all_plannings(sweep, repetitions)) {
    sweep.cases[one.in_case].plannings.push_back(one.planning);
  }
}

void deal(ExpandedSweep& sweep, std::int64_t repetitions, const Shard& shard, std::uint64_t seed,
          const std::vector<double>& seconds) {
  std::vector<Dealt> all = all_plannings(sweep, repetitions);
  Random(seed).shuffle(all);
  std::vector<Piece> pieces = pieces_of(sweep, all, seconds, shard.count);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.seconds > b.seconds; });
  // By seconds, then by the number of plannings, which is what counts among the shortest.
  using Load = std::tuple<double, std::size_t, std::size_t>;
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::size_t i = 0; i < shard.count; ++i) loads.emplace(0.0, 0, i);
  std::vector<std::size_t> mine;
  for (const Piece& piece : pieces) {
    const auto [load, plannings, index] = loads.top();
    loads.pop();
    loads.emplace(load + piece.seconds, plannings + piece.plannings.size(), index);
    if (index == shard.index) mine.insert(mine.end(), piece.plannings.begin(), piece.plannings.end());
  }
  std::sort(mine.begin(), mine.end());
  std::vector<NamedCase> kept;
  std::map<std::size_t, std::size_t> place;  // of a case in `kept`
  for (const std::size_t planning : mine) {
    const auto [found, is_new] = place.emplace(all[planning].in_case, kept.size());
    if (is_new) kept.push_back(sweep.cases[all[planning].in_case]);
    kept[found->second].plannings.push_back(all[planning].planning);
  }
  sweep.cases = std::move(kept);
}

std::size_t count_left(const ExpandedSweep& sweep) {
  std::size_t left = 0;
  for (const NamedCase& named : sweep.cases) left += named.plannings.size();
  return left;
}

void leave_out(ExpandedSweep& sweep, const std::vector<db::RecordedCase>& recorded) {
  for (NamedCase& named : sweep.cases) {
    const db::CaseInfo row = case_row(named.parameters);
    const auto found = std::find_if(recorded.begin(), recorded.end(),
                                    [&row](const auto& one) { return one.parameters == row; });
    if (found == recorded.end()) continue;
    std::set<Planning> wanted(named.plannings.begin(), named.plannings.end());
    for (const db::ResultRow& result : found->rows) {
      if (wanted.erase({result.position, result.repetition}) > 0) named.outcome.add(result);
    }
    std::erase_if(named.plannings, [&wanted](const auto& planning) { return !wanted.contains(planning); });
  }
}

}  // namespace sipplab::bench
