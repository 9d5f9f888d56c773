#include "bench/judge/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/judge/case_words.hpp"
#include "bench/judge/junit.hpp"
#include "bench/judge/replay_command.hpp"
#include "bench/judge/text_table.hpp"

namespace sipplab::bench {
namespace {

using nlohmann::ordered_json;

constexpr const char* kNotes =
    "instances: of different content, and in brackets how many times they were planned, where that is more: "
    "repetitions and equal files are one observation, and so counted in lost, gained and p\n"
    "p: exact, adjusted for the number of cells (Holm)\n"
    "time: median over instances of single plannings that were not interleaved; it informs and judges "
    "nothing, `sipplab gate` does\n";

std::string change(double ratio) { return fmt::format("{:+.1f} %", 100 * (ratio - 1)); }

std::string p_text(double p_value) { return p_value < 1 ? fmt::format("{:.2g}", p_value) : "1"; }

std::string time_text(const CellComparison& cell) { return cell.time_ratio ? change(*cell.time_ratio) : "-"; }

std::string par2_text(const CellComparison& cell) {
  if (!cell.base_par2_s || !cell.head_par2_s) return "-";
  return fmt::format("{:.3g} -> {:.3g}", *cell.base_par2_s, *cell.head_par2_s);
}

/// "8", or "8 (80)" where they were planned 80 times.
std::string instances_text(const CellComparison& cell) {
  const std::size_t plannings = cell.cell->results.size();
  return cell.instances == plannings ? std::to_string(plannings)
                                     : fmt::format("{} ({})", cell.instances, plannings);
}

std::vector<TextRow> cell_rows(const CompareResult& result) {
  std::vector<TextRow> rows = {{"cell", "instances", "differ", "solved", "lost", "gained", "p", "time",
                                "PAR-2 [s]", "both solved", "flowtime", "p", "makespan"}};
  std::vector<db::CaseInfo> cases;
  for (const CellComparison& cell : result.cells) cases.push_back(cell.cell->parameters);
  const std::vector<std::string> names = case_words(cases);
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const CellComparison& cell = result.cells[i];
    const bool quality = cell.both_solved > 0;
    rows.push_back(
        {names[i], instances_text(cell), std::to_string(cell.differences.size()),
         fmt::format("{} -> {}", cell.base_solved, cell.head_solved), std::to_string(cell.lost.size()),
         std::to_string(cell.gained.size()), p_text(cell.success_p), time_text(cell), par2_text(cell),
         std::to_string(cell.both_solved), quality ? change(cell.flowtime.mean_ratio) : "-",
         quality ? p_text(cell.flowtime.p_value) : "-", quality ? change(cell.makespan.mean_ratio) : "-"});
  }
  return rows;
}

std::string replay(const CellComparison& cell, std::size_t result) {
  return replay_command(cell.cell->parameters, cell.cell->results[result].instance);
}

/// "lost  warehouse agents:64 seed:1 index:3 (..)" with the command that plans it again.
std::string flip_text(const CellComparison& cell, std::size_t result, const char* what) {
  const db::PairedResult& pair = cell.cell->results[result];
  return fmt::format("{}: {}, {} -> {}\n  again: {}\n", what, pair.instance, db::name(pair.base.status),
                     db::name(pair.head.status), replay(cell, result));
}

std::string difference_text(const CellComparison& cell, const InstanceDifference& difference) {
  return fmt::format("{}: {}\n  base: {}\n  head: {}\n  again: {}\n", name(difference.what.kind),
                     cell.cell->results[difference.result].instance, difference.what.base,
                     difference.what.head, replay(cell, difference.result));
}

bool is_flip(const CellComparison& cell, std::size_t result) {
  const db::PairedResult& pair = cell.cell->results[result];
  return (pair.base.status == db::ResultStatus::kSolved) != (pair.head.status == db::ResultStatus::kSolved);
}

/// The first `listed` of the texts, and how many more there are.
std::string first_of(const std::vector<std::string>& texts, std::size_t listed) {
  std::string text;
  for (std::size_t i = 0; i < std::min(listed, texts.size()); ++i) text += texts[i];
  if (texts.size() > listed) text += fmt::format("and {} more (--list)\n", texts.size() - listed);
  return text;
}

std::vector<std::string> flips(const CompareResult& result) {
  std::vector<std::string> texts;
  for (const CellComparison& cell : result.cells) {
    for (const std::size_t i : cell.lost) texts.push_back(flip_text(cell, i, "lost"));
  }
  for (const CellComparison& cell : result.cells) {
    for (const std::size_t i : cell.gained) texts.push_back(flip_text(cell, i, "gained"));
  }
  return texts;
}

/// Differences that are not listed as flips.
std::vector<std::string> other_differences(const CompareResult& result) {
  std::vector<std::string> texts;
  for (const CellComparison& cell : result.cells) {
    for (const InstanceDifference& difference : cell.differences) {
      if (!is_flip(cell, difference.result)) texts.push_back(difference_text(cell, difference));
    }
  }
  return texts;
}

std::string exact_text(const CompareResult& result) {
  return result.differing == 0
             ? sameness_text(result)
             : fmt::format("{} of {} plannings differ; instances: {} lost, {} gained, p = {}",
                           result.differing, result.compared, result.lost, result.gained,
                           p_text(result.success_p));
}

std::string unpaired_text(const CompareResult& result) {
  std::size_t base = 0;
  std::size_t head = 0;
  for (const CellComparison& cell : result.cells) {
    base += cell.cell->base_only;
    head += cell.cell->head_only;
  }
  return base + head == 0 ? ""
                          : fmt::format(
                                "left out: {} results of the base and {} of the head that have no "
                                "partner\n",
                                base, head);
}

std::string verdict_text(const CompareResult& result) {
  return fmt::format("{}: {}", name(result.verdict), result.reason);
}

ordered_json optional_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json result_json(const CellComparison& cell, std::size_t result) {
  const db::PairedResult& pair = cell.cell->results[result];
  ordered_json json;
  json["instance"] = pair.instance;
  json["instance_hash"] = pair.instance_hash;
  json["position"] = pair.base.position;
  json["repetition"] = pair.base.repetition;
  json["base_status"] = db::name(pair.base.status);
  json["head_status"] = db::name(pair.head.status);
  json["replay"] = replay(cell, result);
  return json;
}

ordered_json cell_json(const CellComparison& cell) {
  const db::CaseInfo& parameters = cell.cell->parameters;
  ordered_json json;
  json["environment"] = parameters.environment;
  json["robots"] = parameters.robots;
  json["case"] = case_words({parameters}).front();
  json["base_run"] = cell.cell->base_run;
  json["head_run"] = cell.cell->head_run;
  json["instances"] = cell.instances;
  json["plannings"] = cell.cell->results.size();
  json["base_solved"] = cell.base_solved;
  json["head_solved"] = cell.head_solved;
  json["success_p_value"] = cell.success_p;
  json["time_ratio"] = optional_json(cell.time_ratio);
  json["base_par2_s"] = optional_json(cell.base_par2_s);
  json["head_par2_s"] = optional_json(cell.head_par2_s);
  json["both_solved"] = cell.both_solved;
  json["flowtime_ratio"] = cell.flowtime.mean_ratio;
  json["flowtime_p_value"] = cell.flowtime.p_value;
  json["makespan_ratio"] = cell.makespan.mean_ratio;
  json["makespan_p_value"] = cell.makespan.p_value;
  for (const char* direction : {"lost", "gained"}) {
    json[direction] = ordered_json::array();
    for (const std::size_t i : direction == std::string("lost") ? cell.lost : cell.gained) {
      json[direction].push_back(result_json(cell, i));
    }
  }
  json["differences"] = ordered_json::array();
  for (const InstanceDifference& difference : cell.differences) {
    ordered_json entry = result_json(cell, difference.result);
    entry["what"] = name(difference.what.kind);
    entry["base"] = difference.what.base;
    entry["head"] = difference.what.head;
    json["differences"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace

std::string compare_text(const CompareReport& report) {
  const CompareResult& result = report.result;
  std::string text = fmt::format("base {}\nhead {}\n\n", report.base.title, report.head.title);
  text += "exact: " + exact_text(result) + "\n" + first_of(flips(result), report.listed) +
          first_of(other_differences(result), report.listed) + "\n";
  text += terminal_table(cell_rows(result), 1) + "\n" + kNotes + unpaired_text(result);
  return text + "\n" + verdict_text(result) + "\n";
}

std::string compare_markdown(const CompareReport& report) {
  const CompareResult& result = report.result;
  std::string text = fmt::format("### Comparison: {}\n\n", verdict_text(result));
  text += fmt::format("Base {}, head {}.\n\n", report.base.title, report.head.title);
  text += "**Behaviour.** " + exact_text(result) + ".\n\n";
  const std::string listed =
      first_of(flips(result), report.listed) + first_of(other_differences(result), report.listed);
  if (!listed.empty()) {
    text += "<details><summary>Instances</summary>\n\n```\n" + listed + "```\n\n</details>\n\n";
  }
  return text + markdown_table(cell_rows(result), 1) + "\n" + kNotes + unpaired_text(result);
}

std::string compare_json(const CompareReport& report) {
  const CompareResult& result = report.result;
  ordered_json json;
  json["verdict"] = name(result.verdict);
  json["reason"] = result.reason;
  json["base"] = report.base.title;
  json["base_commit"] = report.base.commit_hash ? ordered_json(*report.base.commit_hash) : nullptr;
  json["head"] = report.head.title;
  json["head_commit"] = report.head.commit_hash ? ordered_json(*report.head.commit_hash) : nullptr;
  json["compared"] = result.compared;
  json["differing"] = result.differing;
  json["lost"] = result.lost;
  json["gained"] = result.gained;
  json["success_p_value"] = result.success_p;
  json["cells"] = ordered_json::array();
  for (const CellComparison& cell : result.cells) json["cells"].push_back(cell_json(cell));
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string compare_junit(const CompareReport& report) {
  std::vector<JunitCase> tests;
  JunitCase verdict;
  verdict.name = "verdict";
  verdict.output = exact_text(report.result);
  if (report.result.verdict == CompareVerdict::kRegressed) verdict.failure = report.result.reason;
  if (report.result.verdict == CompareVerdict::kInconclusive) verdict.skipped = report.result.reason;
  tests.push_back(std::move(verdict));
  for (const CellComparison& cell : report.result.cells) {
    JunitCase test;
    test.name = case_words({cell.cell->parameters}).front();
    for (const std::size_t i : cell.lost) test.output += flip_text(cell, i, "lost");
    for (const std::size_t i : cell.gained) test.output += flip_text(cell, i, "gained");
    if (!cell.regression.empty()) test.failure = cell.regression;
    tests.push_back(std::move(test));
  }
  return junit_xml("sipplab compare", tests);
}

}  // namespace sipplab::bench
