// Where the level of a metric changed, and how that is drawn.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/present/trend_text.hpp"
#include "db/statistics/change_points.hpp"
#include "db/statistics/statistics.hpp"
#include "db/trends.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::trend_changes_laws {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return (values[values.size() / 2] + values[(values.size() - 1) / 2]) / 2;
}

/// Series as they come, with steps in some of them.
std::vector<TrendSeries> any_series() {
  std::vector<TrendSeries> series;
  for (auto left = any_whole(1, 3); left > 0; --left) {
    TrendSeries one;
    one.case_id = left;
    one.label = "case";
    double level = static_cast<double>(any_whole(12, 40));
    for (auto steps = any_whole(1, 3); steps > 0; --steps) {
      for (auto points = any_whole(2, 7); points > 0; --points) {
        TrendPoint point;
        point.commit = commit_number(1).hash;
        point.ancestor_count = static_cast<std::int64_t>(one.points.size());
        point.value = (level + static_cast<double>(any_whole(0, 1)) / 4) / 40;
        one.points.push_back(point);
      }
      level += static_cast<double>(any_whole(-1, 3)) * 2;
    }
    series.push_back(std::move(one));
  }
  return series;
}

void changes_are_certain_and_large_enough() {
  std::vector<TrendSeries> series = any_series();
  const TrendMetric& metric = *find_trend_metric(any_flag()   ? "success"
                                                 : any_flag() ? "runtime"
                                                              : "flowtime");
  ChangeRules rules;
  if (any_flag()) rules.min_effect = static_cast<double>(any_whole(0, 4)) / 16;
  rules.false_discovery_rate = static_cast<double>(any_whole(1, 4)) / 40;
  const double least = rules.min_effect.value_or(metric.min_effect);
  // All tests of all series are judged together.
  std::vector<std::pair<std::size_t, statistics::Division>> tests;
  std::vector<double> p_values;
  for (std::size_t i = 0; i < series.size(); ++i) {
    std::vector<double> values;
    for (const TrendPoint& point : series[i].points) values.push_back(point.value);
    for (const auto& division : statistics::divide(values, rules.search)) {
      tests.emplace_back(i, division);
      p_values.push_back(division.p_value);
    }
  }
  const std::vector<bool> stands = statistics::benjamini_hochberg(p_values, rules.false_discovery_rate);
  mark_changes(series, metric, rules);
  std::size_t marked = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    std::vector<std::pair<std::size_t, double>> kept;
    for (std::size_t k = 0; k < tests.size(); ++k) {
      if (tests[k].first == i && stands[k] && tests[k].second.accepted)
        kept.emplace_back(tests[k].second.position, tests[k].second.p_value);
    }
    const auto effect = [&](std::size_t k) {
      const std::size_t begin = k == 0 ? 0 : kept[k - 1].first;
      const std::size_t end = k + 1 == kept.size() ? series[i].points.size() : kept[k + 1].first;
      std::vector<double> before;
      std::vector<double> after;
      for (std::size_t at = begin; at < end; ++at)
        (at < kept[k].first ? before : after).push_back(series[i].points[at].value);
      TrendChange change;
      change.before = median_of(before);
      change.after = median_of(after);
      return change;
    };
    const auto size = [&](std::size_t k) {
      const TrendChange change = effect(k);
      if (metric.rate) return std::abs(change.after - change.before);
      if (change.before == change.after) return 0.0;
      return change.before == 0 ? std::numeric_limits<double>::infinity()
                                : std::abs(change.after / change.before - 1);
    };
    for (;;) {  // the smallest goes first
      std::optional<std::size_t> smallest;
      for (std::size_t k = 0; k < kept.size(); ++k) {
        if (size(k) < least && (!smallest || size(k) < size(*smallest))) smallest = k;
      }
      if (!smallest) break;
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(*smallest));
    }
    RC_ASSERT(series[i].changes.size() == kept.size());
    marked += kept.size();
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const TrendChange& change = series[i].changes[k];
      RC_ASSERT(change.position == kept[k].first);
      RC_ASSERT(change.p_value == kept[k].second);
      RC_ASSERT(change.before == effect(k).before);
      RC_ASSERT(change.after == effect(k).after);
    }
  }
  RC_CLASSIFY(marked > 0, "with changes");
  RC_CLASSIFY(marked < tests.size(), "some dropped");

  // What is printed of it as JSON.
  const auto json = bench::trend_json(metric, series);
  RC_ASSERT(json.at("metric") == metric.name);
  RC_ASSERT(json.at("unit") == metric.unit);
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto& said = json.at("series")[i];
    RC_ASSERT(said.at("case_id") == series[i].case_id);
    for (std::size_t k = 0; k < series[i].points.size(); ++k)
      RC_ASSERT(said.at("points")[k].at("value") == series[i].points[k].value);
    RC_ASSERT(said.at("changes").size() == series[i].changes.size());
    for (std::size_t k = 0; k < series[i].changes.size(); ++k) {
      const TrendChange& change = series[i].changes[k];
      const auto& words = said.at("changes")[k];
      RC_ASSERT(words.at("position") == change.position);
      RC_ASSERT(words.at("before") == change.before);
      RC_ASSERT(words.at("after") == change.after);
      const bool better =
          metric.higher_is_better ? change.after > change.before : change.after < change.before;
      RC_ASSERT(words.at("better") == better);
      const std::string text = bench::change_text(metric, change);
      RC_ASSERT(text.find(better ? ", better)" : ", worse)") != std::string::npos);
      if (change.after == change.before) continue;
      const bool rises = text.find("(+") != std::string::npos || text.find("from 0") != std::string::npos;
      RC_ASSERT(rises == (change.after > change.before));
    }
  }
}

/// A line of blocks: one for each value where there is room, else of as many neighbours for each; higher for
/// more.
void sparklines_rise_with_values() {
  std::vector<double> values;
  for (auto left = any_whole(0, 20); left > 0; --left)
    values.push_back(static_cast<double>(any_whole(-8, 8)));
  const auto width = static_cast<std::size_t>(any_whole(1, 24));
  const std::string line = bench::sparkline(values, width);
  constexpr std::size_t kBytes = 3;  // of each block in UTF-8
  RC_ASSERT(line.size() == kBytes * std::min(width, values.size()));
  if (values.size() > width) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = 0; j < values.size(); ++j) {
      const int order = line.compare(kBytes * i, kBytes, line, kBytes * j, kBytes);
      if (values[i] < values[j]) RC_ASSERT(order <= 0);
      if (values[i] == values[j]) RC_ASSERT(order == 0);
    }
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.empty() || *low == *high) return;
  RC_ASSERT(line.substr(kBytes * static_cast<std::size_t>(low - values.begin()), kBytes) == "▁");
  RC_ASSERT(line.substr(kBytes * static_cast<std::size_t>(high - values.begin()), kBytes) == "█");
}
const PropertyRoom room("trend_changes", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("changes of level are certain among all series, and large enough",
                     changes_are_certain_and_large_enough);
  passed &= property("a sparkline rises with its values", sparklines_rise_with_values);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::trend_changes_laws
