#include "bench/judge/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

TextRow behaviour_row(const Judgement& judgement, Cell number) {
  const Judged& cell = judgement.at(number);
  const Difference& success = *judgement.find(kSuccess, number);
  const Difference* flowtime = judgement.find(kFlowtime, number);
  const bool repeated = cell.instances != cell.compared;
  return {cell.name,
          repeated ? fmt::format("{} ({})", cell.instances, cell.compared) : std::to_string(cell.compared),
          std::to_string(cell.differing),
          fmt::format("{} -> {}", cell.base_solved, cell.head_solved),
          std::to_string(success.worse()),
          std::to_string(success.better()),
          p_text(&success),
          effect_text(judgement.find(kSweepTime, number)),
          cell.base_par2_s ? fmt::format("{:.3g} -> {:.3g}", *cell.base_par2_s, *cell.head_par2_s) : kNothing,
          std::to_string(cell.both_solved),
          effect_text(flowtime),
          p_text(flowtime),
          effect_text(judgement.find(kMakespan, number)),
          effect_text(judgement.find(kExpansions, number))};
}

TextRow time_row(const Judgement& judgement, const Difference& row) {
  return {judgement.at(row.cell).name,
          percent_more(row.effect),
          percent_more(row.at_most),
          p_text(row.adjusted_p),
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

/// "over all cells: flowtime +1.3 % (95 %: +1.1 % to +1.5 %), ..."
std::string pooled_text(const Judgement& judgement) {
  std::string text;
  for (const Metric* metric : {&kFlowtime, &kMakespan, &kExpansions}) {
    const Difference* row = judgement.find(*metric, std::nullopt);
    if (row == nullptr || !std::isfinite(row->at_most)) continue;
    text += fmt::format("{} {} {} (95 %: {} to {})", text.empty() ? "over all cells:" : ",", metric->name,
                        percent_more(row->effect), percent_more(row->at_least), percent_more(row->at_most));
  }
  return text.empty() ? text : text + "\n";
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
    "p: adjusted for the number of cells (Holm); flowtime, makespan, expansions: mean change over instances "
    "that both solved\n";
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

std::string behaviour_notes(const Judgement& judgement) {
  const bool timed = judgement.find(kProcessTime, std::nullopt) != nullptr;
  return kBehaviourNotes + std::string(timed ? "" : kSweepTimeNote) + pooled_text(judgement) +
         unpaired_text(judgement);
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

std::string verdict_text(const Judged& judged) {
  return fmt::format("{}: {}", name(judged.verdict), judged.reason);
}

template <class T>
ordered_json optional_json(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json share_json(double log_ratio) {
  return std::isfinite(log_ratio) ? ordered_json(std::expm1(log_ratio)) : ordered_json(nullptr);
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

std::vector<TextRow> behaviour_table(const Judgement& judgement) {
  const bool timed = judgement.find(kProcessTime, std::nullopt) != nullptr;
  std::vector<TextRow> rows;
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) {
    if (!timed || judgement.cells[i].differing > 0) rows.push_back(behaviour_row(judgement, i));
  }
  if (!rows.empty()) rows.push_back(behaviour_row(judgement, std::nullopt));
  return table({"cell", "instances", "differ", "solved", "lost", "gained", "p", "time", "PAR-2 [s]",
                "both solved", "flowtime", "p", "makespan", "expansions"},
               rows);
}

std::string report_text(const Report& report) {
  const Judgement& judgement = report.judgement;
  const std::vector<TextRow> behaviour = behaviour_table(judgement);
  const std::vector<TextRow> times = time_table(judgement);
  std::string text = fmt::format("base {}\nhead {}\n\nexact: {}\n{}\n", report.base, report.head,
                                 behaviour_text(judgement), findings_text(report));
  if (!behaviour.empty()) text += terminal_table(behaviour, 1) + "\n" + behaviour_notes(judgement) + "\n";
  if (!times.empty()) text += terminal_table(times, 1) + "\n";
  return text + report.notes + (report.notes.empty() ? "" : "\n") + verdict_text(judgement.all) + "\n";
}

std::string report_markdown(const Report& report) {
  const Judgement& judgement = report.judgement;
  const std::vector<TextRow> behaviour = behaviour_table(judgement);
  const std::vector<TextRow> times = time_table(judgement);
  std::string text =
      fmt::format("### {}: {}\n\nBase {}, head {}.\n\n**Behaviour.** {}.\n", report.command,
                  verdict_text(judgement.all), report.base, report.head, behaviour_text(judgement));
  if (!judgement.findings.empty()) {
    text +=
        "\n<details><summary>Instances</summary>\n\n```\n" + findings_text(report) + "```\n\n</details>\n";
  }
  if (!behaviour.empty()) text += "\n" + markdown_table(behaviour, 1) + "\n" + behaviour_notes(judgement);
  if (times.empty()) return text;
  return text + "\n**Time**, head over base, processor time of planning.\n\n" + markdown_table(times, 1) +
         "\n```\n" + report.notes + "```\n";
}

std::string report_json(const Report& report) {
  const Judgement& judgement = report.judgement;
  const Difference& success = *judgement.find(kSuccess, std::nullopt);
  ordered_json json = {{"verdict", name(judgement.all.verdict)}, {"reason", judgement.all.reason}};
  for (const auto& member : report.details.items()) json[member.key()] = member.value();
  json.update({{"compared", judgement.all.compared},
               {"differing", judgement.all.differing},
               {"lost", success.worse()},
               {"gained", success.better()}});
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
  const auto add = [&tests](const std::string& title, const Judged& judged) {
    JunitCase test;
    test.name = title;
    if (judged.verdict == Verdict::kRegressed) test.failure = judged.reason;
    if (judged.verdict == Verdict::kInconclusive) test.skipped = judged.reason;
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
      {"at_least", share_json(row.at_least)},
      {"at_most", share_json(row.at_most)},
      {"p_value", is_tested ? ordered_json(row.p_value) : nullptr},
      {"adjusted_p_value", is_tested ? ordered_json(row.adjusted_p) : nullptr},
      {"floor", share_json(row.floor)}};
  if (row.metric == &kProcessTime) {
    json.update({{"confirm_effect", row.confirmation ? share_json(row.confirmation->effect) : nullptr},
                 {"confirm_p_value", row.confirmation ? ordered_json(row.confirmation->p_value) : nullptr},
                 {"noise", share_json(row.noise)},
                 {"detectable", share_json(row.detectable)}});
  }
  json["verdict"] = row.verdict ? ordered_json(name(*row.verdict)) : ordered_json(nullptr);
  return json;
}

std::string percent_more(double log_ratio, int digits) {
  if (!std::isfinite(log_ratio)) return kNothing;
  return fmt::format("{:+.{}f} %", 100 * std::expm1(log_ratio), digits);
}

}  // namespace sipplab::bench
