#include "bench/gate/error_rates.hpp"

#include <algorithm>
#include <cmath>

#include "bench/judge/evidence.hpp"
#include "planner/core/random.hpp"

namespace sipplab::bench {
namespace {

/// Pairs after each other that are drawn together: half of a first look.
constexpr std::size_t kBlock = 7;
/// Comparisons for each rate: it is known within half a point.
constexpr std::size_t kComparisons = 2000;
constexpr std::uint64_t kSeed = 1;

struct DrawnPair {
  std::size_t pair = 0;
  double sign = 1;  ///< -1: base and head changed places
};

std::vector<DrawnPair> draw(Random& random, std::size_t count, std::size_t measured) {
  std::vector<DrawnPair> drawn;
  while (drawn.size() < count) {
    const auto first = static_cast<std::size_t>(random.below(measured));
    const double sign = random.one_in(2) ? 1 : -1;
    for (std::size_t i = 0; i < kBlock && drawn.size() < count; ++i) {
      drawn.push_back({(first + i) % measured, sign});
    }
  }
  return drawn;
}

std::vector<double> log_ratios(const MeasuredRow& row, const std::vector<DrawnPair>& drawn, double planted) {
  std::vector<double> values;
  for (const DrawnPair& pair : drawn) values.push_back(pair.sign * row.pairs[pair.pair] + planted);
  return values;
}

Verdict drawn_verdict(const std::vector<MeasuredRow>& rows, const Planted& planted,
                      const GateRequest& request, Random& random) {
  const auto planted_in = [&planted](std::size_t i) {
    return planted.row.value_or(i) == i ? planted.slowdown : 0;
  };
  const std::size_t measured = rows.front().pairs.size();
  const std::vector<DrawnPair> first = draw(random, request.pairs, measured);
  const std::vector<DrawnPair> fresh = draw(random, request.fresh_pairs, measured);
  const double tolerance = std::log1p(request.tolerance);
  std::vector<Difference> differences;
  std::vector<Difference*> family;
  differences.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Difference& row = differences.emplace_back(rows[i].row);
    row.pairs = log_ratios(rows[i], first, planted_in(i));
    evaluate(row);
    family.push_back(&row);
  }
  judge_times(family);
  Verdict worst = Verdict::kSame;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Difference& row = differences[i];
    if (needs_second_look(row, tolerance)) row.fresh_pairs = log_ratios(rows[i], fresh, planted_in(i));
    second_look(row, tolerance);
    worst = std::max(worst, *row.verdict);
  }
  return worst;
}

}  // namespace

ErrorRate error_rate(const std::vector<MeasuredRow>& rows, const Planted& planted, const GateRequest& request,
                     std::size_t comparisons) {
  Random random(kSeed);
  ErrorRate rate{planted, comparisons, 0, 0};
  for (std::size_t i = 0; i < comparisons; ++i) {
    const Verdict verdict = drawn_verdict(rows, planted, request, random);
    rate.regressed += verdict == Verdict::kRegressed ? 1U : 0U;
    rate.inconclusive += verdict == Verdict::kInconclusive ? 1U : 0U;
  }
  return rate;
}

std::vector<ErrorRate> error_rates(const GateRequest& request, const GateCases& cases,
                                   const std::vector<db::GateNoise>& noise, const GateResult& result) {
  std::vector<MeasuredRow> rows;
  for (const Difference& row : result.judgement.differences) {
    if (row.metric != &kProcessTime) continue;
    MeasuredRow measured{row, calibrated(row, cases, noise).pairs};
    measured.row.fresh_pairs.clear();
    rows.push_back(std::move(measured));
  }
  const auto fewest = std::min_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.pairs.size() < b.pairs.size(); });
  if (fewest == rows.end() || fewest->pairs.empty()) return {};
  // The newest pairs of all rows are from the same processes, if some calibrations had fewer rows.
  const std::size_t common = fewest->pairs.size();
  for (MeasuredRow& row : rows)
    row.pairs.erase(row.pairs.begin(), row.pairs.end() - static_cast<std::ptrdiff_t>(common));
  const auto noisiest = std::max_element(rows.begin() + 1, rows.end(), [](const auto& a, const auto& b) {
    return a.row.detectable < b.row.detectable;
  });
  const double everywhere = rows.front().row.detectable;
  std::vector<Planted> planted = {{0, {}}};
  if (std::isfinite(everywhere)) planted.push_back({everywhere, {}});
  if (noisiest != rows.end() && std::isfinite(noisiest->row.detectable)) {
    planted.push_back({noisiest->row.detectable, static_cast<std::size_t>(noisiest - rows.begin())});
  }
  std::vector<ErrorRate> rates;
  for (const Planted& fault : planted) rates.push_back(error_rate(rows, fault, request, kComparisons));
  return rates;
}

}  // namespace sipplab::bench
