// Trends as text with sparklines, as JSON and as a chart.
#include "bench/present/trend_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "bench/present/numbers.hpp"
#include "bench/present/plots.hpp"
#include "db/aligned.hpp"

namespace sipplab::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::size_t kWideSparkline = 72;    // fits a terminal of 80 columns
constexpr std::size_t kNarrowSparkline = 32;  // beside the other columns of the overview
constexpr std::size_t kDateLength = 10;
constexpr std::size_t kSubjectLength = 48;
/// Labels on the x axis; more would run into each other.
constexpr std::size_t kChartLabels = 5;

std::vector<double> values_of(const db::TrendSeries& series) {
  std::vector<double> values;
  for (const db::TrendPoint& point : series.points) values.push_back(point.value);
  return values;
}

std::string shortened(const std::string& text, std::size_t length) {
  if (text.size() <= length) return text;
  std::size_t end = length;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // whole code points
  return text.substr(0, end) + "...";
}

std::string label_of(const db::TrendSeries& series) {
  return db::escaped(series.instances.empty() ? series.label : series.label + ", " + series.instances);
}

/// "case 7", "case 7, 10 instances", or its label if it is of no case.
std::string short_label(const db::TrendSeries& series) {
  if (series.case_id == 0) return db::escaped(series.label);
  return fmt::format("case {}{}{}", series.case_id, series.instances.empty() ? "" : ", ", series.instances);
}

/// "7 of 10": plannings that all versions solved. Empty if the metric is not of solved ones.
std::string solved_by_all(const db::TrendSeries& series) {
  return series.plannings == 0 ? "" : fmt::format("{} of {}", series.solved_by_all, series.plannings);
}

/// Changes of one version stand together: a commit that slows one case slows many.
std::string changes_text(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series,
                         bool contexts) {
  std::vector<std::pair<const db::TrendPoint*, std::string>> versions;
  for (const db::TrendSeries& one : series) {
    for (const db::TrendChange& change : one.changes) {
      const db::TrendPoint& point = one.points[change.position];
      auto found = std::find_if(versions.begin(), versions.end(), [&point](const auto& version) {
        return version.first->commit == point.commit && version.first->committed_utc == point.committed_utc &&
               version.first->dirty == point.dirty;
      });
      if (found == versions.end()) found = versions.insert(found, {&point, ""});
      found->second += "    ";
      if (series.size() > 1) {
        found->second += short_label(one) + ": ";
        if (contexts && !one.context.empty()) found->second += db::escaped(one.context) + ": ";
      }
      found->second += change_text(metric, change) + '\n';
    }
  }
  if (versions.empty()) return "no change of level found\n";
  std::stable_sort(versions.begin(), versions.end(), [](const auto& a, const auto& b) {
    return a.first->committed_utc < b.first->committed_utc;
  });
  std::string text = "changes of level:\n";
  for (const auto& [point, lines] : versions) {
    std::string heading =
        fmt::format("  {} {} {}", version_name(*point), point->committed_utc.substr(0, kDateLength),
                    db::escaped(shortened(point->subject, kSubjectLength)));
    heading.erase(heading.find_last_not_of(' ') + 1);
    text += heading + '\n' + lines;
  }
  return text;
}

/// Whether the series come from more than one machine and kind of build.
bool has_contexts(const std::vector<db::TrendSeries>& series) {
  return std::any_of(series.begin(), series.end(),
                     [&series](const db::TrendSeries& one) { return one.context != series.front().context; });
}

std::string one_series(const db::TrendMetric& metric, const db::TrendSeries& series, std::size_t rows) {
  const std::vector<double> values = values_of(series);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::string text = fmt::format("{}{}\n\n{}\n{} to {}, {} version{}\n\n", series_name(series),
                                 series.case_id > 0 ? fmt::format(" (case {})", series.case_id) : "",
                                 sparkline(values, kWideSparkline), with_unit(*low, metric.unit),
                                 with_unit(*high, metric.unit), values.size(), values.size() == 1 ? "" : "s");
  const bool of_solved = series.plannings > 0;
  if (of_solved && series.is_comparable()) {
    text.insert(text.size() - 2,
                fmt::format("; over the {} plannings that all solved", solved_by_all(series)));
  }
  const std::size_t begin = values.size() > rows ? values.size() - rows : 0;
  std::vector<std::vector<std::string>> table;
  for (std::size_t i = begin; i < series.points.size(); ++i) {
    const db::TrendPoint& point = series.points[i];
    const bool changes = std::any_of(series.changes.begin(), series.changes.end(),
                                     [i](const db::TrendChange& change) { return change.position == i; });
    table.push_back({version_name(point), point.committed_utc.substr(0, kDateLength),
                     with_unit(point.value, metric.unit), std::to_string(point.runs), changes ? "*" : "",
                     db::escaped(shortened(point.subject, kSubjectLength))});
    if (of_solved)
      table.back().insert(table.back().begin() + 3, short_number(point.solved_share.value_or(0)));
  }
  std::vector<std::string> heading = {"version", "date", std::string(metric.name), "runs", " ", "subject"};
  std::vector<bool> to_the_right = {false, false, true, true, false, false};
  if (of_solved) {
    heading.insert(heading.begin() + 3, "solved");
    to_the_right.insert(to_the_right.begin() + 3, true);
  }
  text += db::align(heading, table, to_the_right);
  if (begin > 0) text += fmt::format("({} older versions; --rows shows more)\n", begin);
  if (!series.is_comparable()) {
    text += "no planning is solved by all: each value is of other plannings, and no change is marked\n";
  }
  return text;
}

std::string overview(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series,
                     bool contexts) {
  std::vector<std::string> heading = {"case", "parameters", "versions", "first",
                                      "last", "changes",    "history"};
  std::vector<bool> to_the_right = {true, false, true, true, true, true, false};
  const bool of_solved = series.front().plannings > 0;
  if (of_solved) {
    heading.insert(heading.begin() + 3, "solved by all");
    to_the_right.insert(to_the_right.begin() + 3, true);
  }
  std::vector<std::vector<std::string>> table;
  bool comparable = true;
  for (const db::TrendSeries& one : series) {
    table.push_back({one.case_id > 0 ? std::to_string(one.case_id) : "-",
                     contexts ? series_name(one) : label_of(one), std::to_string(one.points.size()),
                     with_unit(one.points.front().value, metric.unit),
                     with_unit(one.points.back().value, metric.unit), std::to_string(one.changes.size()),
                     sparkline(values_of(one), kNarrowSparkline)});
    if (of_solved) table.back().insert(table.back().begin() + 3, solved_by_all(one));
    comparable = comparable && one.is_comparable();
  }
  const std::string note =
      comparable ? ""
                 : "0 of them solved by all: each value is of other plannings, and no change is marked\n";
  return db::align(heading, table, to_the_right) + note;
}

Json json_number(double value) {
  // JSON has no infinity; the word is the one that tables show.
  return std::isinf(value) ? Json(short_number(value)) : Json(value);
}

/// Tells versions apart, and puts them in the order of history.
auto version_key(const db::TrendPoint& point) {
  // A commit was first measured at another time in another series; other builds have no better name.
  const bool is_commit = !point.commit.empty() && !point.dirty;
  return std::tuple(point.ancestor_count, point.committed_utc, point.commit, point.dirty,
                    is_commit ? std::string() : point.started_utc);
}

using Places = std::map<decltype(version_key(db::TrendPoint())), std::size_t>;

/// The versions of all series and their places on the x axis.
Places places_of(const std::vector<db::TrendSeries>& series) {
  Places places;
  for (const db::TrendSeries& one : series) {
    for (const db::TrendPoint& point : one.points) places.emplace(version_key(point), 0);
  }
  std::size_t place = 0;
  for (auto& entry : places) entry.second = place++;
  return places;
}

}  // namespace

std::string series_name(const db::TrendSeries& series) {
  return series.context.empty() ? label_of(series) : label_of(series) + "; " + db::escaped(series.context);
}

std::string version_name(const db::TrendPoint& point) {
  if (point.commit.empty()) return "no commit";
  return point.commit.substr(0, kHashLength) + (point.dirty ? "+" : "");
}

std::string sparkline(const std::vector<double>& values, std::size_t width) {
  if (values.empty()) return "";
  std::vector<double> columns;
  const std::size_t count = std::min(width, values.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * values.size() / count;
    const std::size_t end = (i + 1) * values.size() / count;
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += values[k];
    columns.push_back(sum / static_cast<double>(end - begin));
  }
  const auto [low, high] = std::minmax_element(columns.begin(), columns.end());
  const double span = *high - *low;
  std::string text;
  for (const double column : columns) {
    const double share = span > 0 ? (column - *low) / span : 0.5;
    text += kBlocks[std::min(kBlocks.size() - 1, static_cast<std::size_t>(share * kBlocks.size()))];
  }
  return text;
}

std::string change_text(const db::TrendMetric& metric, const db::TrendChange& change) {
  const bool better = (change.after > change.before) == metric.higher_is_better;
  return fmt::format("{} -> {} ({}, {})", with_unit(change.before, metric.unit),
                     with_unit(change.after, metric.unit),
                     signed_share(db::effect_of(change, metric), metric.rate), better ? "better" : "worse");
}

std::string trend_text(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series,
                       std::size_t rows) {
  std::string text = fmt::format("{}: {}\n", metric.name, metric.meaning);
  const bool contexts = has_contexts(series);
  if (series.size() == 1) {
    text += one_series(metric, series.front(), rows);
  } else {
    if (!contexts && !series.front().context.empty()) text += db::escaped(series.front().context) + '\n';
    text += overview(metric, series, contexts);
  }
  return text + '\n' + changes_text(metric, series, contexts);
}

Json trend_json(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series) {
  Json document;
  document["metric"] = std::string(metric.name);
  document["meaning"] = std::string(metric.meaning);
  document["unit"] = std::string(metric.unit);
  document["higher_is_better"] = metric.higher_is_better;
  document["series"] = Json::array();
  for (const db::TrendSeries& one : series) {
    Json entry;
    entry["case_id"] = one.case_id > 0 ? Json(one.case_id) : Json(nullptr);
    entry["label"] = one.label;
    entry["instances"] = one.instances;
    entry["context"] = one.context;
    if (one.plannings > 0) {
      entry["plannings"] = one.plannings;
      entry["solved_by_all"] = one.solved_by_all;
    }
    entry["points"] = Json::array();
    for (const db::TrendPoint& point : one.points) {
      entry["points"].push_back({{"commit", point.commit.empty() ? Json(nullptr) : Json(point.commit)},
                                 {"dirty", point.dirty},
                                 {"subject", point.subject},
                                 {"committed_utc", point.committed_utc},
                                 {"started_utc", point.started_utc},
                                 {"runs", point.runs},
                                 {"value", json_number(point.value)}});
      if (point.solved_share) entry["points"].back()["solved_share"] = *point.solved_share;
    }
    entry["changes"] = Json::array();
    for (const db::TrendChange& change : one.changes) {
      const db::TrendPoint& point = one.points[change.position];
      entry["changes"].push_back({{"position", change.position},
                                  {"commit", point.commit.empty() ? Json(nullptr) : Json(point.commit)},
                                  {"before", change.before},
                                  {"after", change.after},
                                  {"effect", json_number(db::effect_of(change, metric))},
                                  {"better", (change.after > change.before) == metric.higher_is_better},
                                  {"p_value", change.p_value}});
    }
    document["series"].push_back(std::move(entry));
  }
  return document;
}

Chart trend_chart(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series) {
  Chart chart;
  chart.title = fmt::format("{}: {}", metric.name, metric.meaning);
  chart.x_label = "versions, in order of history";
  chart.y_label =
      metric.unit.empty() ? std::string(metric.name) : fmt::format("{} [{}]", metric.name, metric.unit);
  if (series.size() == 1) chart.title = fmt::format("{}, {}", metric.name, label_of(series.front()));
  if (std::any_of(series.begin(), series.end(),
                  [](const db::TrendSeries& one) { return !one.is_comparable(); })) {
    chart.title += " (not comparable: no planning is solved by all)";
  }
  chart.title += omission_note(series.size());
  chart.caption = "a point: median of the runs of one commit; dotted: the level changed";
  const std::vector<db::TrendSeries> drawn(
      series.begin(), series.begin() + static_cast<std::ptrdiff_t>(std::min(series.size(), kMostChartLines)));
  const Places places = places_of(drawn);
  const auto x_of = [&places](const db::TrendPoint& point) {
    return static_cast<double>(places.at(version_key(point)));
  };
  for (const db::TrendSeries& one : drawn) {
    ChartLine line;
    line.colour = static_cast<int>(chart.lines.size());
    if (drawn.size() > 1)
      line.label = one.case_id == 0 ? one.label : fmt::format("case {}: {}", one.case_id, label_of(one));
    for (const db::TrendPoint& point : one.points)
      line.points.push_back({x_of(point), point.value, false, std::nullopt});
    for (const db::TrendChange& change : one.changes) {
      const db::TrendPoint& point = one.points[change.position];
      // Between the points: the level is another from this one on.
      const std::string effect =
          version_name(point) + " " + signed_share(db::effect_of(change, metric), metric.rate);
      line.marks.push_back({x_of(point) - 0.5, drawn.size() > 1 ? "" : effect});
    }
    chart.lines.push_back(std::move(line));
  }
  if (metric.unit == "s") chart.y_label = fmt::format("{} [{}]", metric.name, in_one_unit(chart));
  std::vector<std::string> names(places.size());
  for (const db::TrendSeries& one : drawn) {
    for (const db::TrendPoint& point : one.points) names[places.at(version_key(point))] = version_name(point);
  }
  const std::size_t labels = std::min(kChartLabels, names.size());
  for (std::size_t k = 0; k < labels; ++k) {
    const std::size_t at = labels == 1 ? 0 : k * (names.size() - 1) / (labels - 1);
    chart.x_ticks.emplace_back(static_cast<double>(at), names[at]);
  }
  return chart;
}

}  // namespace sipplab::bench
