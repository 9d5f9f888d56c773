// The report as one HTML page.
#include "bench/present/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "bench/judge/report.hpp"
#include "bench/present/html_table.hpp"
#include "bench/present/named_row.hpp"
#include "bench/present/numbers.hpp"
#include "bench/present/template.hpp"
#include "bench/present/trend_text.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

constexpr std::size_t kShortUuid = 8;
constexpr std::size_t kMinuteLength = 16;  // "2026-01-31T12:00"
constexpr std::size_t kMostFlips = 200;

std::string minute(const std::string& utc) {
  std::string text = utc.substr(0, kMinuteLength);
  const std::size_t t = text.find('T');
  if (t != std::string::npos) text[t] = ' ';
  return text;
}

class Page {
 public:
  explicit Page(const ReportData& data) : data_(data) {}

  Expected<std::string, std::string> write(const std::vector<DensityChart>& charts) {
    const db::RunSummary& run = data_.run.run;
    const std::string uuid = run.uuid.substr(0, kShortUuid);
    return with_pictures(filled_page("report", "sipplab: run " + uuid,
                                     {{"suite", xml_escaped(run.suite)},
                                      {"run", uuid},
                                      {"facts", part([&] { facts(); })},
                                      {"density", part([&] { density(charts); })},
                                      {"base", part([&] { against_base(); })},
                                      {"flips", part([&] { flips(); })},
                                      {"trends", part([&] { trends(); })},
                                      {"properties", part([&] { properties(); })},
                                      {"fuzzing", part([&] { fuzzing(); })}}),
                         charts_);
  }

 private:
  /// What it writes.
  template <class Write>
  std::string part(const Write& write) {
    text_.clear();
    write();
    return std::move(text_);
  }
  void draw(Chart chart) {
    text_ += picture_place(charts_.size());
    charts_.push_back(std::move(chart));
  }
  void note(const std::string& words) {
    text_ += fmt::format("<p class=\"note\">{}</p>\n", xml_escaped(words));
  }
  void fact(const std::string& name, const std::string& value) {
    if (!value.empty()) text_ += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, xml_escaped(value));
  }

  static std::string version(const db::RunSummary& run) {
    if (!run.commit_hash) return "no commit";
    return fmt::format("{}{} {}", run.commit_hash->substr(0, kHashLength),
                       run.dirty ? "+ (uncommitted changes)" : "", run.commit_subject.value_or(""));
  }

  void facts() {
    const db::RunSummary& run = data_.run.run;
    fact("run", run.uuid + ", " + run.status);
    fact("started", minute(run.started_utc) + " UTC");
    fact("commit", version(run));
    fact("branch", run.branch);
    fact("build", run.compiler + ", " + run.build_type);
    fact("machine", run.host + ", " + run.cpu_model);
    fact("command", run.command_line);
    fact("results", fmt::format("{} in {} cases, {} solved, {} invalid", run.results, run.cases, run.solved,
                                run.invalid));
    if (run.excluded_reason) fact("excluded", *run.excluded_reason);
    if (data_.base) {
      fact("base", fmt::format("{}, {} UTC, {}", data_.base->run.uuid.substr(0, kShortUuid),
                               minute(data_.base->run.started_utc), version(data_.base->run)));
    }
  }

  void density(const std::vector<DensityChart>& charts) {
    if (charts.empty()) note("This run has no finished case.");
    if (data_.base && !data_.against_base.cells.empty()) note("Dashed: the base.");
    text_ += "<div class=\"charts\">\n";
    for (const DensityChart& density : charts) draw(density.chart);
    text_ += "</div>\n";
  }

  static std::string shown(const db::Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
    if (const auto* real = std::get_if<double>(&value)) return short_number(*real);
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    return "-";
  }
  /// The colour of a column of the comparison, by the verdict on its metric there.
  static std::string colour(const Judgement& judgement, const std::string& column,
                            std::optional<std::size_t> cell) {
    const std::pair<std::string_view, const Metric*> columns[] = {{"lost", &kSuccess},
                                                                  {"gained", &kSuccess},
                                                                  {kFlowtime.name, &kFlowtime},
                                                                  {kMakespan.name, &kMakespan},
                                                                  {kExpansions.name, &kExpansions}};
    for (const auto& [name, metric] : columns) {
      const Difference* row = name == column ? judgement.find(*metric, cell) : nullptr;
      if (row != nullptr && row->verdict == Verdict::kRegressed) return "bad";
      if (row != nullptr && row->verdict == Verdict::kImproved) return "good";
    }
    return "";
  }

  void against_base() {
    if (!data_.base) return note("No earlier run of this suite: nothing to compare with.");
    if (data_.against_base.cells.empty()) return note("The two runs have no instance of a case in common.");
    const Judgement& judgement = data_.against_base;
    note(fmt::format("{}: {}.", name(judgement.all.verdict), judgement.all.reason));
    note(
        "Coloured: what is worse or better for certain, by more than its floor. Time: median of single "
        "plannings that did not run in "
        "turn, on "
        "one machine only; no test judges it. sipplab compare tells more; sipplab gate decides about times.");
    const std::vector<TextRow> table = behaviour_table(judgement);
    const std::string kinds = "t" + std::string(table.front().size() - 1, 'n');
    std::vector<std::vector<HtmlCell>> rows;
    for (std::size_t i = 1; i < table.size(); ++i) {
      std::optional<std::size_t> cell;
      if (i <= judgement.cells.size()) cell = i - 1;
      std::vector<HtmlCell>& cells = rows.emplace_back();
      for (std::size_t column = 0; column < table[i].size(); ++column) {
        cells.push_back({table[i][column], colour(judgement, table.front()[column], cell)});
      }
    }
    text_ += html_table(table.front(), rows, kinds);
  }

  /// A table of the history as it is.
  void plain_table(const db::Table& table, const std::string& kinds) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& values : table.rows) {
      std::vector<HtmlCell>& cells = rows.emplace_back();
      for (std::size_t i = 0; i < values.size(); ++i) {
        std::string text = shown(values[i]);
        const std::string& column = table.columns[i];
        if (column.size() > 4 && column.compare(column.size() - 4, 4, "_utc") == 0) text = minute(text);
        std::string style;
        if (column == "status" || column == "state") {
          const bool good = text == "passed" || text == "clean" || text == "fixed";
          style = good ? "good" : "bad";
        }
        cells.push_back({std::move(text), std::move(style)});
      }
    }
    text_ += html_table(table.columns, rows, kinds);
  }

  /// The first rows, with a note if there are more.
  db::Table shortened(db::Table table, std::size_t most, const char* view) {
    if (table.rows.size() <= most) return table;
    table.rows.resize(most);
    note(fmt::format("The first {}; {} has them all.", most, view));
    return table;
  }

  void flips() {
    if (!data_.base) return note("No base.");
    if (data_.against_base.cells.empty()) return note("The two runs have no instance of a case in common.");
    const Judgement& judgement = data_.against_base;
    std::vector<const Finding*> flips;
    for (const Finding& finding : judgement.findings) {
      if (finding.what.kind == ChangeKind::kStatus) flips.push_back(&finding);
    }
    if (flips.empty()) return note("No instance is solved by one of the two runs only.");
    if (flips.size() > kMostFlips) note(fmt::format("The first {}; v_flips has them all.", kMostFlips));
    flips.resize(std::min(flips.size(), kMostFlips));
    std::vector<std::vector<HtmlCell>> rows;
    for (const Finding* flip : flips) {
      const std::string direction(heading(judgement, *flip));
      rows.push_back({{direction, direction == "lost"     ? "bad"
                                  : direction == "gained" ? "good"
                                                          : ""},
                      {judgement.cells[flip->cell].name},
                      {judgement.result(*flip).instance},
                      {flip->what.base},
                      {flip->what.head}});
    }
    text_ += html_table({"direction", "case", "instance", "base", "run"}, rows, "ttttt");
  }

  void trends() {
    for (const ReportTrend& trend : data_.trends) {
      text_ += fmt::format("<h3>{}: {}</h3>\n", trend.metric->name, trend.metric->meaning);
      std::string lines;
      for (const db::TrendSeries& series : trend.series) {
        for (const db::TrendChange& change : series.changes) {
          const db::TrendPoint& point = series.points[change.position];
          lines +=
              fmt::format("<li>{} ({}, {}): {}; {}</li>\n", xml_escaped(version_name(point)),
                          point.committed_utc.substr(0, 10), xml_escaped(point.subject),
                          xml_escaped(series_name(series)), xml_escaped(change_text(*trend.metric, change)));
        }
      }
      bool enough = false;
      for (const db::TrendSeries& series : trend.series) enough = enough || series.points.size() > 1;
      if (!enough) {
        note("One version so far.");
        continue;
      }
      text_ +=
          lines.empty() ? "<p class=\"note\">No change of level found.</p>\n" : "<ul>\n" + lines + "</ul>\n";
      trend_charts(trend);
    }
  }

  /// A small picture for each series that varies: those that never did have nothing to show.
  void trend_charts(const ReportTrend& trend) {
    text_ += "<div class=\"charts\">\n";
    std::size_t constant = 0;
    for (const db::TrendSeries& series : trend.series) {
      bool varies = false;
      for (const db::TrendPoint& point : series.points)
        varies = varies || point.value != series.points[0].value;
      if (!varies) {
        ++constant;
        continue;
      }
      Chart chart = trend_chart(*trend.metric, {series});
      chart.title = series.instances.empty() ? series.label : series.label + ", " + series.instances;
      if (!series.is_comparable()) chart.title += " (not comparable: no planning is solved by all)";
      if (!series.context.empty()) chart.x_label = series.context;
      chart.width = 380;
      chart.height = 220;
      if (chart.x_ticks.size() > 2) chart.x_ticks = {chart.x_ticks.front(), chart.x_ticks.back()};
      draw(std::move(chart));
    }
    text_ += "</div>\n";
    if (constant > 0) note(fmt::format("{} series never changed and are not drawn.", constant));
  }

  void properties() {
    if (data_.properties.rows.empty())
      return note("No property run is recorded; scripts/test --record does so.");
    std::size_t passed = 0;
    for (const auto& values : data_.properties.rows) {
      passed += NamedRow(data_.properties, values).text("status") == "passed" ? 1U : 0U;
    }
    note(fmt::format("{} of {} pass at their newest run.", passed, data_.properties.rows.size()));
    plain_table(data_.properties, "twtntt");
  }

  void fuzzing() {
    if (data_.fuzz_runs.rows.empty()) {
      note("No fuzz run is recorded.");
    } else {
      plain_table(data_.fuzz_runs, "tttnnnn");
    }
    if (data_.findings.rows.empty()) return note("No finding.");
    plain_table(shortened(data_.findings, kMostFindings, "v_findings"), "ntttwwttn");
  }

  const ReportData& data_;
  std::string text_;
  std::vector<Chart> charts_;
};

}  // namespace

Expected<std::string, std::string> report_page(const ReportData& data,
                                               const std::vector<DensityChart>& charts) {
  return Page(data).write(charts);
}

}  // namespace sipplab::bench
