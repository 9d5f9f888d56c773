#include "bench/present/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "bench/present/numbers.hpp"
#include "db/statistics/statistics.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {
namespace {

constexpr std::size_t kDayLength = 10;

/// What tells one line from another, most general first: environment, planner, re-scheduling, order,
/// start-safe interval, run.
constexpr std::size_t kLineParts = 6;
constexpr std::size_t kSsiPart = 4;
constexpr std::size_t kRunPart = 5;
using LineWords = std::array<std::string, kLineParts>;

struct LineKey {
  std::string environment, planner, reschedule, order;
  double ssi_s = 0;
  std::size_t run = 0;

  friend bool operator<(const LineKey& a, const LineKey& b) {
    return std::tie(a.environment, a.planner, a.reschedule, a.order, a.ssi_s, a.run) <
           std::tie(b.environment, b.planner, b.reschedule, b.order, b.ssi_s, b.run);
  }
};

LineKey key_of(const db::CaseInfo& of, std::size_t run) {
  return {of.environment, of.planner, of.text("reschedule"), of.text("initial_order"), of.real("ssi_s"), run};
}

LineWords words_of(const PlotRequest& request, const LineKey& key) {
  const db::RunSummary& run = request.runs[key.run].report.run;
  const bool base = request.second_is_base && key.run == 1;
  return {key.environment,
          key.planner,
          key.reschedule,
          key.order,
          "ssi " + ssi_text(key.ssi_s),
          base                     ? "base"
          : request.second_is_base ? ""
                                   : "run " + run.uuid.substr(0, kRunDigits)};
}

bool admits(const db::CaseFilter& filter, const db::CaseInfo& of) {
  const auto agrees = [](const auto& wanted, const auto& value) { return !wanted || *wanted == value; };
  return agrees(filter.environment, of.environment) && agrees(filter.robots, of.robots) &&
         agrees(filter.map, of.map_spec) && agrees(filter.planner, of.planner) &&
         std::all_of(filter.options.begin(), filter.options.end(),
                     [&of](const auto& wanted) { return of.option(wanted.first) == wanted.second; });
}

std::string joined(const LineWords& words, const std::array<bool, kLineParts>& wanted) {
  std::string text;
  for (std::size_t part = 0; part < words.size(); ++part) {
    if (wanted[part] && !words[part].empty()) text += (text.empty() ? "" : ", ") + words[part];
  }
  return text;
}

/// The cells that the filter admits, by line.
using CellsByLine = std::map<LineKey, std::vector<const db::CellSummary*>>;

CellsByLine cells_by_line(const PlotRequest& request) {
  CellsByLine lines;
  for (std::size_t run = 0; run < request.runs.size(); ++run) {
    for (const db::CellSummary& cell : request.runs[run].report.cells) {
      if (admits(request.filter, cell.parameters)) lines[key_of(cell.parameters, run)].push_back(&cell);
    }
  }
  return lines;
}

std::string words_of_runs(const PlotRequest& request) {
  std::string text;
  for (const PlottedRun& plotted : request.runs)
    text += (text.empty() ? "" : ", ") + run_words(plotted.report.run);
  return text;
}

/// A chart of the lines that there are colours for, named by what tells them apart; the title says what they
/// share. `draw(line, key, cells)` fills in the points of each.
template <class Draw>
Chart chart_of_lines(const PlotRequest& request, const std::string& nothing, const Draw& draw) {
  CellsByLine lines = cells_by_line(request);
  const std::size_t most = kMostChartLines * (request.second_is_base ? 2 : 1);
  const std::string omission = lines.size() > most ? omission_note(lines.size()) : "";
  if (lines.size() > most)
    lines.erase(std::next(lines.begin(), static_cast<std::ptrdiff_t>(most)), lines.end());
  std::array<bool, kLineParts> varies{};
  std::optional<LineWords> first;
  for (const auto& [key, cells] : lines) {
    const LineWords words = words_of(request, key);
    if (!first) first = words;
    for (std::size_t part = 0; part < words.size(); ++part)
      varies[part] = varies[part] || words[part] != (*first)[part];
  }
  std::array<bool, kLineParts> same{};
  std::transform(varies.begin(), varies.end(), same.begin(), [](bool part) { return !part; });
  same[kRunPart] = false;  // the caption names the runs

  Chart chart;
  chart.title = first ? joined(*first, same) : "";
  if (chart.title.empty()) chart.title = nothing;
  chart.title += omission;
  chart.caption = words_of_runs(request);
  int colour = 0;
  const LineKey* before = nullptr;
  for (const auto& [key, cells] : lines) {
    ChartLine line;
    line.label = joined(words_of(request, key), varies);
    line.dashed = request.second_is_base && key.run == 1;
    const bool pair = line.dashed && before != nullptr && before->run == 0 && before->ssi_s == key.ssi_s;
    line.colour = before == nullptr ? 0 : pair ? colour : ++colour;
    before = &key;
    draw(line, key, cells);
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

/// Solved and all results at a number of robots. Cases that differ in what no line shows, such as seeds, are
/// one point.
struct Place {
  std::int64_t solved = 0;
  std::int64_t results = 0;
  std::vector<double> medians_s;
};

std::map<double, Place> places_of(const std::vector<const db::CellSummary*>& cells) {
  std::map<double, Place> places;
  for (const db::CellSummary* cell : cells) {
    Place& place = places[static_cast<double>(cell->parameters.robots)];
    place.solved += cell->solved;
    place.results += cell->results;
    if (cell->median_solved_time_s) place.medians_s.push_back(*cell->median_solved_time_s);
  }
  return places;
}

/// Least and most results of a point of all lines.
std::pair<std::int64_t, std::int64_t> result_range(const PlotRequest& request) {
  std::pair<std::int64_t, std::int64_t> range{std::numeric_limits<std::int64_t>::max(), 0};
  for (const auto& [key, cells] : cells_by_line(request)) {
    for (const auto& [robots, place] : places_of(cells)) {
      range = {std::min(range.first, place.results), std::max(range.second, place.results)};
    }
  }
  return range;
}

void add_count(Chart& chart, const PlotRequest& request, const std::string& more) {
  const auto [least, most] = result_range(request);
  if (most > 0) chart.caption += fmt::format("; n = {} results a point{}", range_words(least, most), more);
}

std::map<std::int64_t, const db::CellSummary*> admitted_cases(const PlotRequest& request, std::size_t run) {
  std::map<std::int64_t, const db::CellSummary*> cases;
  for (const db::CellSummary& cell : request.runs[run].report.cells) {
    if (admits(request.filter, cell.parameters)) cases[cell.case_id] = &cell;
  }
  return cases;
}

std::optional<double> value_of(const PlottedResult& result, Measure metric) {
  if (!result.solved) return std::nullopt;
  if (metric == Measure::kFlowtimes) return result.flowtime_s;
  if (metric == Measure::kMakespans) return result.makespan_s;
  return result.time_s;
}

std::string metric_words(Measure metric) {
  return metric == Measure::kRuntimes    ? "planning time"
         : metric == Measure::kFlowtimes ? "flowtime"
                                         : "makespan";
}

}  // namespace

std::string run_words(const db::RunSummary& run) {
  return fmt::format("run {} ({}{}{})", run.uuid.substr(0, kRunDigits), run.suite,
                     run.started_utc.empty() ? "" : ", " + run.started_utc.substr(0, kDayLength),
                     run.commit_hash ? ", " + run.commit_hash->substr(0, kHashLength) : "");
}

const char* in_one_unit(Chart& chart, bool of_x) {
  double greatest = 0;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) greatest = std::max(greatest, of_x ? point.x : point.y);
  }
  const auto [factor, unit] = greatest >= 1      ? std::pair{1.0, "s"}
                              : greatest >= 1e-3 ? std::pair{kMillisecondsPerSecond, "ms"}
                                                 : std::pair{1e6, "us"};
  for (ChartLine& line : chart.lines) {
    for (ChartPoint& point : line.points) (of_x ? point.x : point.y) *= factor;
  }
  return unit;
}

std::string range_words(std::int64_t least, std::int64_t most) {
  return least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
}

Chart success_chart(const PlotRequest& request) {
  Chart chart = chart_of_lines(request, "success", [](ChartLine& line, const LineKey&, const auto& cells) {
    for (const auto& [robots, place] : places_of(cells)) {
      if (place.results == 0) continue;
      const auto of = static_cast<double>(place.results);
      const auto held = static_cast<double>(place.solved);
      const auto interval = db::statistics::wilson_interval(held, of);
      line.points.push_back({robots, held / of, false, std::pair{interval.low, interval.high}});
    }
  });
  chart.x_label = "robots";
  chart.y_label = "share of instances solved";
  chart.y_min = 0;
  chart.y_max = 1;
  add_count(chart, request, ", bars: 95 % (Wilson)");
  label_points(chart, kMostNumbersOfRobots);
  return chart;
}

Chart runtime_chart(const PlotRequest& request) {
  Chart chart =
      chart_of_lines(request, "planning time", [](ChartLine& line, const LineKey&, const auto& cells) {
        for (const auto& [robots, place] : places_of(cells)) {
          if (place.medians_s.empty()) continue;
          double sum = 0;
          for (const double median : place.medians_s) sum += median;
          line.points.push_back({robots, sum / static_cast<double>(place.medians_s.size()),
                                 2 * place.solved < place.results, std::nullopt});
        }
      });
  chart.x_label = "robots";
  chart.y_label = fmt::format("median planning time [{}]", in_one_unit(chart));
  chart.log_y = true;
  // Points of the base's lines are hollow anyway.
  const std::string lines = request.second_is_base ? " on a full line" : "";
  add_count(chart, request, ", of those the solved; hollow" + lines + ": fewer than half are solved");
  label_points(chart, kMostNumbersOfRobots);
  return chart;
}

Chart cactus_chart(const PlotRequest& request) {
  Chart chart =
      chart_of_lines(request, "solved", [&](ChartLine& line, const LineKey& key, const auto& cells) {
        std::set<std::int64_t> cases;
        for (const db::CellSummary* cell : cells) cases.insert(cell->case_id);
        std::vector<double> times_s;
        std::int64_t results = 0;
        for (const PlottedResult& result : request.runs[key.run].results) {
          if (!cases.contains(result.case_id)) continue;
          ++results;
          if (result.solved) times_s.push_back(result.time_s);
        }
        std::sort(times_s.begin(), times_s.end());
        for (std::size_t i = 0; i < times_s.size(); ++i) {
          line.points.push_back({times_s[i], static_cast<double>(i + 1), false, std::nullopt});
        }
        line.label += fmt::format("{}{} of {}", line.label.empty() ? "" : ": ", times_s.size(), results);
        line.style = LineStyle::kSteps;
      });
  chart.x_label = fmt::format("planning time [{}]", in_one_unit(chart, true));
  chart.y_label = "results solved within it";
  chart.caption += "; in the legend: solved of all";
  chart.y_min = 0;
  chart.log_x = true;
  return chart;
}

Chart box_chart(const PlotRequest& request, Measure metric) {
  std::set<std::int64_t> robots;
  const CellsByLine all = cells_by_line(request);
  for (const auto& [key, cells] : all) {
    for (const db::CellSummary* cell : cells) robots.insert(cell->parameters.robots);
  }
  const auto lines = static_cast<double>(std::min(all.size(), kMostChartLines));
  constexpr double kShare = 0.8;  // of the distance of two numbers of robots
  std::size_t number = 0;
  Chart chart = chart_of_lines(
      request, metric_words(metric), [&](ChartLine& line, const LineKey& key, const auto& cells) {
        const double offset = (static_cast<double>(number++) - (lines - 1) / 2) * kShare / lines;
        std::map<std::int64_t, double> place_of_case;
        std::map<double, Place> counts;
        for (const db::CellSummary* cell : cells) {
          const auto index = std::distance(robots.begin(), robots.find(cell->parameters.robots));
          const double x = static_cast<double>(index) + offset;
          place_of_case[cell->case_id] = x;
          counts[x].solved += cell->solved;
          counts[x].results += cell->results;
        }
        for (const PlottedResult& result : request.runs[key.run].results) {
          const auto place = place_of_case.find(result.case_id);
          const auto value = value_of(result, metric);
          if (place == place_of_case.end() || !value) continue;
          const Place& count = counts[place->second];
          line.points.push_back({place->second, *value, 2 * count.solved < count.results, std::nullopt});
        }
        line.style = LineStyle::kBoxes;
      });
  chart.box_width = kShare * 0.85 / std::max(lines, 1.0);
  chart.x_label = "robots";
  chart.y_label =
      fmt::format("{} [{}]", metric_words(metric), metric == Measure::kRuntimes ? in_one_unit(chart) : "s");
  chart.log_y = metric == Measure::kRuntimes;
  double index = 0;
  for (const std::int64_t count : robots) chart.x_ticks.emplace_back(index++, std::to_string(count));
  add_count(
      chart, request,
      ", of those the solved; boxes: quartiles, with whiskers of up to 1.5 boxes, rings: beyond; fewer than "
      "five values are dots; hollow: fewer than half are solved");
  return chart;
}

Chart improvement_chart(const PlotRequest& request) {
  constexpr int kTimes = 80;
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::int64_t most = 0;
  Chart chart =
      chart_of_lines(request, "improvement", [&](ChartLine& line, const LineKey& key, const auto& cells) {
        std::set<std::int64_t> cases;
        for (const db::CellSummary* cell : cells) cases.insert(cell->case_id);
        // Curves by instance: time and gap.
        std::map<std::pair<std::int64_t, std::string>, std::map<double, double>> curves;
        double last_s = 0;
        for (const PlottedStep& step : request.runs[key.run].steps) {
          if (!cases.contains(step.case_id)) continue;
          curves[{step.case_id, step.instance}][step.elapsed_s] = step.flowtime_gap;
          last_s = std::max(last_s, step.elapsed_s);
        }
        double first_s = 0;
        for (const auto& [instance, curve] : curves) first_s = std::max(first_s, curve.begin()->first);
        line.style = LineStyle::kSteps;
        if (curves.empty()) return;
        least = std::min(least, static_cast<std::int64_t>(curves.size()));
        most = std::max(most, static_cast<std::int64_t>(curves.size()));
        for (int i = 0; i <= kTimes; ++i) {
          const double at_s = i == 0 ? first_s : first_s * std::pow(last_s / first_s, 1.0 * i / kTimes);
          double sum = 0;
          for (const auto& [instance, curve] : curves)
            sum += std::prev(curve.upper_bound(at_s * (1 + 1e-12)))->second;
          line.points.push_back({at_s, 100 * sum / static_cast<double>(curves.size()), false, std::nullopt});
        }
      });
  chart.x_label = fmt::format("time since planning began [{}]", in_one_unit(chart, true));
  chart.y_label = "mean gap of flowtime to its bound [%]";
  chart.y_min = 0;
  chart.log_x = true;
  if (most > 0) {
    chart.caption +=
        fmt::format("; n = {} plans a line, from when all are there; a plan that is no longer improved stays",
                    range_words(least, most));
  }
  return chart;
}

namespace {

/// The sides of a scatter plot, and which part of a line's words they differ in.
struct Sides {
  std::vector<std::string> names;
  std::array<bool, kLineParts> differ{};
  std::optional<std::size_t> part;  ///< by whose words a line is on a side; none: by the filters
};

Expected<Sides, std::string> sides_of(const PlotRequest& request) {
  Sides sides;
  if (!request.sides.empty()) {
    sides.names = request.side_names;
    constexpr std::pair<const char*, std::size_t> kColumns[] = {
        {"reschedule", 2}, {"initial_order", 3}, {"ssi_s", kSsiPart}};
    for (const db::CaseFilter& side : request.sides) {
      sides.differ[0] = sides.differ[0] || side.environment;
      // Every other option is part of the planner's words.
      sides.differ[1] = sides.differ[1] || side.planner || !side.options.empty();
      for (const auto& [column, part] : kColumns) {
        sides.differ[part] = sides.differ[part] || side.options.contains(column);
      }
    }
    sides.differ[kRunPart] = true;
    return sides;
  }
  // The part of which there are two: runs first, then from the most general on.
  std::array<std::set<std::string>, kLineParts> values;
  for (const auto& [key, cells] : cells_by_line(request)) {
    const LineWords words = words_of(request, key);
    for (std::size_t part = 0; part < words.size(); ++part) values[part].insert(words[part]);
  }
  for (const std::size_t part : {kRunPart, std::size_t{1}, std::size_t{2}, std::size_t{3}, kSsiPart}) {
    if (values[part].size() != 2) continue;
    sides.names.assign(values[part].begin(), values[part].end());
    sides.differ[part] = true;
    if (part == kRunPart) sides.differ[1] = true;  // two runs of two planners
    sides.part = part;
    return sides;
  }
  return Unexpected{
      std::string("sipplab: no two sides to compare, expected two runs, or --side twice, such as "
                  "--side reschedule=none --side reschedule=random")};
}

}  // namespace

Expected<Chart, std::string> scatter_chart(const PlotRequest& request, Measure metric) {
  const Sides sides = SIPPLAB_TRY(sides_of(request));
  struct Pair {
    std::array<std::optional<double>, 2> values;
    std::array<bool, 2> there{};
    std::string environment;
  };
  std::array<bool, kLineParts> shared{};
  std::transform(sides.differ.begin(), sides.differ.end(), shared.begin(),
                 [](bool differs) { return !differs; });
  std::map<std::string, Pair> pairs;
  std::array<std::set<std::string>, 2> planners;
  for (std::size_t run = 0; run < request.runs.size(); ++run) {
    const auto cases = admitted_cases(request, run);
    for (const PlottedResult& result : request.runs[run].results) {
      const auto found = cases.find(result.case_id);
      if (found == cases.end()) continue;
      const db::CaseInfo& of = found->second->parameters;
      const LineWords words = words_of(request, key_of(of, run));
      for (std::size_t side = 0; side < 2; ++side) {
        const bool is_here =
            sides.part ? words[*sides.part] == sides.names[side] : admits(request.sides[side], of);
        if (!is_here) continue;
        planners[side].insert(words[1]);
        Pair& pair = pairs[joined(words, shared) + '/' + result.instance];
        pair.environment = words[0];
        pair.there[side] = true;
        pair.values[side] = value_of(result, metric);
      }
    }
  }
  Chart chart;
  const auto is_drawn = [](const Pair& pair) {
    return pair.there[0] && pair.there[1] && (pair.values[0] || pair.values[1]);
  };
  double greatest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, pair] : pairs) {
    if (!is_drawn(pair)) continue;
    for (const auto& value : pair.values) {
      greatest = std::max(greatest, value.value_or(0));
      if (value.value_or(0) > 0) least = std::min(least, *value);
    }
  }
  // What is unsolved stands apart: a sixth of the axis at least.
  constexpr double kFurther = 0.2;
  const double beyond_share = std::max(3.0, std::pow(greatest / least, kFurther));
  const bool timed = metric == Measure::kRuntimes;
  const double factor = !timed ? 1 : greatest >= 1 ? 1 : kMillisecondsPerSecond;
  const double beyond = beyond_share * greatest * factor;
  std::map<std::string, ChartLine> lines;
  std::array<int, 3> counts{};  // both, the first alone, the second alone
  for (const auto& [name, pair] : pairs) {
    if (!is_drawn(pair)) continue;
    ++counts[pair.values[0] && pair.values[1] ? 0 : pair.values[0] ? 1 : 2];
    if (!(pair.values[0] && pair.values[1])) chart.unsolved = beyond;
    lines[pair.environment].points.push_back({pair.values[0] ? *pair.values[0] * factor : beyond,
                                              pair.values[1] ? *pair.values[1] * factor : beyond, false,
                                              std::nullopt});
  }
  for (auto& [environment, line] : lines) {
    line.label = lines.size() > 1 ? environment : "";
    line.colour = static_cast<int>(chart.lines.size());
    line.style = LineStyle::kPoints;
    chart.lines.push_back(std::move(line));
  }
  const std::string unit = timed && factor != 1 ? "ms" : "s";
  chart.title = metric_words(metric) + ", instance by instance";
  chart.caption =
      fmt::format("{}; n = {}: {} solved by both, {} by the first alone, {} by the second alone",
                  words_of_runs(request), counts[0] + counts[1] + counts[2], counts[0], counts[1], counts[2]);
  // Two runs of two planners are told apart by these.
  const bool named = sides.part == kRunPart && planners[0].size() == 1 && planners[1].size() == 1 &&
                     planners[0] != planners[1];
  const auto axis = [&](std::size_t side) {
    return fmt::format("{}{} [{}]", named ? *planners[side].begin() + ", " : "", sides.names[side], unit);
  };
  chart.x_label = axis(0);
  chart.y_label = axis(1);
  chart.log_x = chart.log_y = true;
  chart.diagonal = true;
  constexpr int kSquare = 460;
  chart.width = chart.height = kSquare;
  return chart;
}

}  // namespace sipplab::bench
