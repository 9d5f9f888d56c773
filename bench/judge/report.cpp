#include "bench/judge/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "bench/judge/junit.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/judge/text_table.hpp"
#include "db/json_text.hpp"

namespace sipplab::bench {
namespace {

using nlohmann::ordered_json;
using Cell = std::optional<std::size_t>;  ///< none: all cells together

constexpr const char* kNothing = "-";

std::string p_text(double p_value) { return p_value < 1 ? fmt::format("{:.2g}", p_value) : "1"; }

/// Effect and p value; "-" if nothing was measured.
std::string effect_text(const Difference* row) {
  return row == nullptr || row->pairs.empty() ? kNothing : percent_more(row->effect, 1);
}
std::string p_text(const Difference* row) {
  return row == nullptr || row->pairs.empty() ? kNothing : p_text(row->adjusted_p);
}

/// Processes are tested for being slower and for being faster: the test of the side that the effect is on.
double p_of_its_side(const Difference& row) {
  const bool faster = row.metric->test == Test::kFreshPairs && row.effect < 0;
  return faster ? row.adjusted_faster_p : row.adjusted_p;
}

TextRow behaviour_row(const Judgement& judgement, Cell number, bool times) {
  const Judged& cell = judgement.at(number);
  const Difference* success = judgement.find(kSuccess, number);  // of plannings alone
  const Difference* flowtime = judgement.find(kFlowtime, number);
  const bool repeated = cell.instances != cell.compared;
  const bool timed = times && cell.base_par2_s;
  return {cell.name,
          repeated ? fmt::format("{} ({})", cell.instances, cell.compared) : std::to_string(cell.compared),
          std::to_string(cell.differing),
          fmt::format("{} -> {}", cell.base_solved, cell.head_solved),
          success == nullptr ? kNothing : std::to_string(success->lost),
          success == nullptr ? kNothing : std::to_string(success->gained),
          p_text(success),
          times ? effect_text(judgement.find(kSweepTime, number)) : kNothing,
          timed ? fmt::format("{:.3g} -> {:.3g}", *cell.base_par2_s, *cell.head_par2_s) : kNothing,
          std::to_string(cell.both_solved),
          effect_text(flowtime),
          p_text(flowtime),
          effect_text(judgement.find(kMakespan, number)),
          effect_text(judgement.find(kExpansions, number))};
}

/// What was judged and differs: a line for a metric over all cells, or in one.
TextRow judged_row(const Judgement& judgement, const Difference& row, bool with_cell) {
  const bool share = row.metric == &kSuccess;
  const auto text = [share](double effect) {
    if (!std::isfinite(effect)) return std::string(kNothing);
    return share ? fmt::format("{:+.1f} points", -100 * effect) : percent_more(effect);
  };
  const double low = share ? row.at_most : row.at_least;
  const double high = share ? row.at_least : row.at_most;
  const std::string interval = std::isfinite(low) ? text(low) + " to " + text(high) : kNothing;
  TextRow words = {std::string(row.metric->name),
                   std::to_string(row.pairs.size()),
                   text(row.effect),
                   interval,
                   p_text(p_of_its_side(row)),
                   !std::isfinite(row.detectable) ? kNothing
                   : share                        ? fmt::format("{:.1f} points", 100 * row.detectable)
                                                  : fmt::format("{:.1f} %", 100 * std::expm1(row.detectable)),
                   std::string(name(*row.verdict))};
  if (with_cell) words.insert(words.begin(), judgement.at(row.cell).name);
  return words;
}

TextRow time_row(const Judgement& judgement, const Difference& row) {
  return {judgement.at(row.cell).name,
          percent_more(row.effect),
          percent_more(row.at_most),
          p_text(p_of_its_side(row)),
          row.confirmation ? percent_more(row.confirmation->effect) : kNothing,
          row.confirmation ? p_text(row.confirmation->p_value) : kNothing,
          percent_more(row.detectable),
          std::string(name(row.verdict.value_or(Verdict::kSame)))};
}

/// Empty if there are no rows. Columns that say nothing are left out.
std::vector<TextRow> table(TextRow heading, std::vector<TextRow> rows) {
  if (rows.empty()) return {};
  rows.insert(rows.begin(), std::move(heading));
  for (std::size_t column = rows.front().size(); column-- > 0;) {
    const bool empty = std::all_of(rows.begin() + 1, rows.end(),
                                   [column](const TextRow& row) { return row[column] == kNothing; });
    if (!empty) continue;
    for (TextRow& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(column));
  }
  return rows;
}

/// Over all cells: the metrics that differ. Empty if none does.
std::vector<TextRow> pooled_table(const Judgement& judgement) {
  std::vector<TextRow> rows;
  for (const Difference& row : judgement.differences) {
    if (row.cell || !row.verdict || row.worse() + row.better() == 0) continue;
    rows.push_back(judged_row(judgement, row, false));
  }
  return table({"over all cells", "pairs", "change", "95 %", "p", "sees from", "verdict"}, rows);
}

/// The cells that are not like the others. Empty if all are alike.
std::vector<TextRow> news_table(const Judgement& judgement) {
  std::vector<TextRow> rows;
  for (const Difference& row : judgement.differences) {
    if (row.cell && is_news(row)) rows.push_back(judged_row(judgement, row, true));
  }
  return table({"cell", "metric", "pairs", "change", "95 %", "p", "sees from", "verdict"}, rows);
}

std::string cells_text(const Judgement& judgement) {
  std::map<Verdict, std::size_t> counts;
  for (const Judged& cell : judgement.cells) ++counts[cell.verdict];
  std::string text;
  for (auto count = counts.rbegin(); count != counts.rend(); ++count) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count->second, name(count->first));
  }
  return fmt::format("cells: {}\n", text);
}

std::string sees_text(const Judgement& judgement) {
  const std::string sight = sight_text(judgement);
  if (sight.empty()) return "";
  return fmt::format("sees, 19 times of 20, with {} plannings of {} instances: {}\n", judgement.all.compared,
                     judgement.all.instances, sight);
}

std::string unpaired_text(const Judgement& judgement) {
  std::size_t base = 0;
  std::size_t head = 0;
  for (const db::PairedCell& cell : judgement.results) {
    base += cell.base_only;
    head += cell.head_only;
  }
  if (base + head == 0) return "";
  return fmt::format("left out: {} results of the base and {} of the head that have no partner\n", base,
                     head);
}

constexpr const char* kBehaviourNotes =
    "instances: of different content, and in brackets how many times they were planned, if more: "
    "repetitions and equal files are one observation, and so counted in lost, gained and p\n"
    "p: adjusted (Holm) over metrics, or over cells and metrics; flowtime, makespan, expansions: mean change "
    "over instances that both solved\n";
constexpr const char* kSweepTimeNote =
    "time: median over instances of single plannings that were not interleaved; it informs and judges "
    "nothing, `sipplab gate` does\n";

/// Empty if no pairs of processes were timed.
std::vector<TextRow> time_table(const Judgement& judgement) {
  std::vector<TextRow> times;
  for (const Difference& row : judgement.differences) {
    if (row.metric == &kProcessTime) times.push_back(time_row(judgement, row));
  }
  if (!times.empty()) std::rotate(times.begin(), times.begin() + 1, times.end());  // all cells at the end
  return table({"cell", "slowdown", "at most", "p", "fresh pairs", "p", "sees", "verdict"}, times);
}

std::string behaviour_notes(const Judgement& judgement, bool times) {
  return kBehaviourNotes + std::string(times ? kSweepTimeNote : "") + unpaired_text(judgement);
}

std::string replay(const Judgement& judgement, const Finding& finding) {
  return replay_command(judgement.results[finding.cell].parameters, judgement.result(finding).instance);
}

std::string finding_text(const Judgement& judgement, const Finding& finding) {
  const std::string count = finding.plannings > 1 ? fmt::format(", {} plannings", finding.plannings) : "";
  return fmt::format("{}: {}\n  {}{}\n  base: {}\n  head: {}\n  again: {}\n", heading(judgement, finding),
                     judgement.result(finding).instance, judgement.cells[finding.cell].name, count,
                     finding.what.base, finding.what.head, replay(judgement, finding));
}

std::string findings_text(const Report& report) {
  const std::vector<Finding>& findings = report.judgement.findings;
  std::string text;
  const std::size_t shown = std::min(report.listed, findings.size());
  for (std::size_t i = 0; i < shown; ++i) text += finding_text(report.judgement, findings[i]);
  if (shown == findings.size()) return text;
  return text + fmt::format("and {} more: {}\n", findings.size() - shown, report.all_findings);
}

template <class T>
ordered_json optional_json(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json share_json(double log_ratio) {
  return std::isfinite(log_ratio) ? ordered_json(std::expm1(log_ratio)) : ordered_json(nullptr);
}

ordered_json finite_json(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json cell_json(const Judgement& judgement, std::size_t number) {
  const Judged& cell = judgement.cells[number];
  const db::PairedCell& results = judgement.results[number];
  return {{"cell", cell.name},
          {"environment", results.parameters.environment},
          {"robots", results.parameters.robots},
          {"base_run", results.base_run},
          {"head_run", results.head_run},
          {"instances", cell.instances},
          {"plannings", cell.compared},
          {"differing", cell.differing},
          {"base_solved", cell.base_solved},
          {"head_solved", cell.head_solved},
          {"both_solved", cell.both_solved},
          {"base_par2_s", optional_json(cell.base_par2_s)},
          {"head_par2_s", optional_json(cell.head_par2_s)},
          {"verdict", name(cell.verdict)},
          {"reason", cell.reason}};
}

ordered_json finding_json(const Judgement& judgement, const Finding& finding) {
  const db::PairedResult& result = judgement.result(finding);
  return {{"what", name(finding.what.kind)},
          {"instance", result.instance},
          {"instance_hash", result.instance_hash},
          {"cell", judgement.cells[finding.cell].name},
          {"position", result.base.position},
          {"repetition", result.base.repetition},
          {"plannings", finding.plannings},
          {"base", finding.what.base},
          {"head", finding.what.head},
          {"replay", replay(judgement, finding)}};
}

}  // namespace

std::string headline(const Judgement& judgement) {
  std::string verdict(name(judgement.all.verdict));
  for (char& letter : verdict) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return verdict + ": " + judgement.all.reason;
}

std::vector<TextRow> behaviour_table(const Judgement& judgement, bool times) {
  const bool timed = judgement.find(kProcessTime, std::nullopt) != nullptr;
  std::vector<TextRow> rows;
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) {
    if (!timed || judgement.cells[i].differing > 0)
      rows.push_back(behaviour_row(judgement, i, times && !timed));
  }
  if (!rows.empty()) rows.push_back(behaviour_row(judgement, std::nullopt, times && !timed));
  return table({"cell", "instances", "differ", "solved", "lost", "gained", "p", "time", "PAR-2 [s]",
                "both solved", "flowtime", "p", "makespan", "expansions"},
               rows);
}

std::string report_text(const Report& report) {
  const Judgement& judgement = report.judgement;
  const bool timed = judgement.find(kProcessTime, std::nullopt) != nullptr;
  std::string text = fmt::format("base {}\nhead {}\n\nexact: {}\n{}\n", report.base, report.head,
                                 behaviour_text(judgement), findings_text(report));
  const std::vector<TextRow> behaviour = behaviour_table(judgement);
  if (!behaviour.empty()) {
    text += terminal_table(behaviour, 1) + "\n" + behaviour_notes(judgement, !timed) + "\n";
  }
  for (const auto& rows : {time_table(judgement), pooled_table(judgement), news_table(judgement)}) {
    if (!rows.empty()) text += terminal_table(rows, 1) + "\n";
  }
  return text + report.notes + sees_text(judgement) + cells_text(judgement) + "\n" + headline(judgement) +
         "\n";
}

std::string report_markdown(const Report& report) {
  const Judgement& judgement = report.judgement;
  std::string text = fmt::format("**{}**\n\n`{}`: {} against {}. {}", headline(judgement), report.command,
                                 report.head, report.base, cells_text(judgement));
  for (const auto& rows : {pooled_table(judgement), news_table(judgement)}) {
    if (!rows.empty()) text += "\n" + markdown_table(rows, 1);
  }
  const auto fold = [&text](const std::string& title, const std::string& what) {
    if (!what.empty()) {
      text += fmt::format("\n<details><summary>{}</summary>\n\n{}\n</details>\n", title, what);
    }
  };
  const auto block = [](const std::string& lines) { return lines.empty() ? "" : "```\n" + lines + "```\n"; };
  if (!judgement.findings.empty()) {
    fold(fmt::format("Instances that differ: {}", judgement.findings.size()), block(findings_text(report)));
  }
  const std::vector<TextRow> behaviour = behaviour_table(judgement, false);
  if (!behaviour.empty()) {
    fold("Behaviour in each cell",
         markdown_table(behaviour, 1) + "\n" + block(behaviour_notes(judgement, false)));
  }
  const std::vector<TextRow> times = time_table(judgement);
  if (!times.empty()) fold("Time in each cell, head over base", markdown_table(times, 1));
  fold("What this could see", block(report.notes + sees_text(judgement)));
  return text;
}

std::string report_json(const Report& report) {
  const Judgement& judgement = report.judgement;
  const Difference& success = *judgement.find(kSuccess, std::nullopt);
  ordered_json json = {{"verdict", name(judgement.all.verdict)}, {"reason", judgement.all.reason}};
  for (const auto& member : report.details.items()) json[member.key()] = member.value();
  json.update({{"compared", judgement.all.compared},
               {"differing", judgement.all.differing},
               {"other_plans", judgement.all.other_plans},
               {"lost", success.lost},
               {"gained", success.gained}});
  for (const char* list : {"cells", "findings", "differences"}) json[list] = ordered_json::array();
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) json["cells"].push_back(cell_json(judgement, i));
  for (const Finding& finding : judgement.findings)
    json["findings"].push_back(finding_json(judgement, finding));
  for (const Difference& row : judgement.differences) {
    json["differences"].push_back(difference_json(judgement, row));
  }
  return db::json_text(json);
}

std::string report_junit(const Report& report) {
  const Judgement& judgement = report.judgement;
  std::vector<JunitCase> tests;
  const auto add = [&](const std::string& title, const Judged& judged) {
    JunitCase test;
    test.name = title;
    const bool changed = judged.other_plans + judged.other_tasks > 0;
    if (judged.verdict == Verdict::kRegressed || (report.changes_fail && changed)) {
      test.failure = judged.reason;
    } else if (judged.verdict == Verdict::kInconclusive) {
      test.skipped = judged.reason;
    }
    tests.push_back(std::move(test));
  };
  for (const Judged& cell : judgement.cells) add(cell.name, cell);
  for (const Finding& finding : judgement.findings)
    tests[finding.cell].output += finding_text(judgement, finding);
  add("verdict", judgement.all);
  tests.back().output = report_text(report);
  return junit_xml(report.command, tests);
}

ordered_json difference_json(const Judgement& judgement, const Difference& row) {
  const bool is_share = row.metric->test == Test::kSigns;
  const bool is_tested = row.metric->test != Test::kNone;
  ordered_json json = {
      {"metric", row.metric->name},
      {"cell", row.cell ? ordered_json(judgement.cells[*row.cell].name) : ordered_json(nullptr)},
      {"pairs", row.pairs.size()},
      {"worse", row.worse()},
      {"better", row.better()},
      {"effect", is_share ? ordered_json(row.effect) : share_json(row.effect)},
      {"at_least", is_share ? finite_json(row.at_least) : share_json(row.at_least)},
      {"at_most", is_share ? finite_json(row.at_most) : share_json(row.at_most)},
      {"p_value", is_tested ? ordered_json(row.p_value) : nullptr},
      {"adjusted_p_value", is_tested ? ordered_json(row.adjusted_p) : nullptr},
      {"floor", is_share ? finite_json(row.floor) : share_json(row.floor)}};
  json["detectable"] = is_share ? finite_json(row.detectable) : share_json(row.detectable);
  if (row.metric == &kProcessTime) {
    json.update({{"confirm_effect", row.confirmation ? share_json(row.confirmation->effect) : nullptr},
                 {"confirm_p_value", row.confirmation ? ordered_json(row.confirmation->p_value) : nullptr},
                 {"noise", share_json(row.noise)}});
  }
  json["verdict"] = row.verdict ? ordered_json(name(*row.verdict)) : ordered_json(nullptr);
  return json;
}

std::string percent_more(double log_ratio, int digits) {
  if (!std::isfinite(log_ratio)) return kNothing;
  return fmt::format("{:+.{}f} %", 100 * std::expm1(log_ratio), digits);
}

}  // namespace sipplab::bench
