#include "bench/gate/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/judge/junit.hpp"
#include "bench/judge/text_table.hpp"

namespace sipplab::bench {
namespace {

/// More would bury the verdict; the history has them all.
constexpr std::size_t kDifferencesShown = 10;
constexpr std::size_t kShortHash = 8;

std::string build_text(const WorkerGreeting& greeting) {
  const SourceInfo source = source_info(greeting.program);
  const std::string commit =
      source.commit ? source.commit->hash.substr(0, kShortHash) + (greeting.build.dirty ? "+changes" : "")
                    : std::string("unknown commit");
  return fmt::format("{} ({} {}, {}, program {})", commit, greeting.build.compiler,
                     greeting.build.compiler_version, greeting.build.build_type,
                     greeting.build.binary_hash.substr(0, kShortHash));
}

std::vector<TextRow> time_rows(const GateResult& result) {
  std::vector<TextRow> rows = {{"cell", "slowdown", "at most", "p", "fresh pairs", "p", "sees", "verdict"}};
  for (const GateRow& row : result.rows) {
    TextRow cells = {row.name, percent_slower(row.suspicion.effect), percent_slower(row.at_most),
                     fmt::format("{:.2g}", row.suspicion.p_value)};
    cells.push_back(row.confirmation ? percent_slower(row.confirmation->effect) : "");
    cells.push_back(row.confirmation ? fmt::format("{:.2g}", row.confirmation->p_value) : "");
    cells.push_back(percent(std::expm1(row.detectable)));
    cells.emplace_back(name(row.verdict));
    rows.push_back(std::move(cells));
  }
  return rows;
}

std::string exact_text(const GateResult& result) {
  if (result.differences.empty()) {
    return fmt::format("{} plannings: the same status, plan and work in both", result.compared);
  }
  return fmt::format("{} of {} plannings differ ({} lost, {} gained)", result.differing, result.compared,
                     result.lost, result.gained);
}

std::string difference_text(const GateCases& cases, const GateDifference& difference) {
  const GateJob& job = cases.jobs()[difference.job];
  return fmt::format("{}: {}\n  {}\n  base: {}\n  head: {}\n  again: {}\n", name(difference.what.kind),
                     job.row.name, cases.cells()[job.cell].name, difference.what.base, difference.what.head,
                     job.replay);
}

std::string differences_text(const GateCases& cases, const GateResult& result) {
  std::string text;
  const std::size_t shown = std::min(result.differences.size(), kDifferencesShown);
  for (std::size_t i = 0; i < shown; ++i) text += difference_text(cases, result.differences[i]);
  if (shown < result.differences.size()) {
    text += fmt::format("and {} more: SELECT * FROM v_gate_differences\n", result.differences.size() - shown);
  }
  return text;
}

std::string verdict_text(const GateResult& result) {
  return fmt::format("{}: {}", name(result.verdict), result.reason);
}

nlohmann::ordered_json number(double log_ratio) {
  if (!std::isfinite(log_ratio)) return nullptr;
  return std::expm1(log_ratio);
}

nlohmann::ordered_json build_json(const WorkerGreeting& greeting) {
  const SourceInfo source = source_info(greeting.program);
  nlohmann::ordered_json json;
  json["commit"] = source.commit ? nlohmann::ordered_json(source.commit->hash) : nullptr;
  json["dirty"] = greeting.build.dirty;
  json["compiler"] = greeting.build.compiler + " " + greeting.build.compiler_version;
  json["build_type"] = greeting.build.build_type;
  json["binary_hash"] = greeting.build.binary_hash;
  return json;
}

nlohmann::ordered_json row_json(const GateRow& row) {
  nlohmann::ordered_json json;
  json["cell"] = row.name;
  json["slowdown"] = number(row.suspicion.effect);
  json["p_value"] = row.suspicion.p_value;
  json["confirm_slowdown"] = row.confirmation ? number(row.confirmation->effect) : nullptr;
  json["confirm_p_value"] = row.confirmation ? nlohmann::ordered_json(row.confirmation->p_value) : nullptr;
  json["at_most"] = number(row.at_most);
  json["noise"] = row.noise;
  json["floor"] = row.floor;
  json["detectable"] = number(row.detectable);
  json["verdict"] = name(row.verdict);
  return json;
}

}  // namespace

std::string noise_text(const GateRequest& request, const GateResult& result) {
  const GateRow& all = result.rows.back();
  const auto worst =
      std::max_element(result.rows.begin(), result.rows.end(),
                       [](const GateRow& a, const GateRow& b) { return a.detectable < b.detectable; });
  const std::string source =
      result.calibrations > 0
          ? fmt::format("from {} comparison{} of equal builds on this machine", result.calibrations,
                        result.calibrations == 1 ? "" : "s")
          : std::string("from this comparison alone; `sipplab gate --calibrate` measures it");
  if (std::isinf(all.detectable)) {
    return fmt::format(
        "noise: {:.2f} % over all cells (standard error of {} pairs, {})\n"
        "sees: nothing with so few pairs\n",
        100 * all.noise, request.pairs, source);
  }
  return fmt::format(
      "noise: {:.2f} % over all cells (standard error of {} pairs, {})\n"
      "sees: a slowdown of {} over all cells, of {} in {} alone (19 times of 20)\n",
      100 * all.noise, request.pairs, source, percent(std::expm1(all.detectable)),
      percent(std::expm1(worst->detectable)), worst->name);
}

std::string noise_json(const GateRequest& request, const GateResult& result) {
  nlohmann::ordered_json json;
  json["suite"] = request.suite;
  json["comparisons"] = result.calibrations;
  json["pairs"] = request.pairs;
  json["rows"] = nlohmann::ordered_json::array();
  for (const GateRow& row : result.rows) {
    nlohmann::ordered_json entry;
    entry["cell"] = row.name;
    entry["noise"] = row.noise;
    entry["floor"] = row.floor;
    entry["detectable"] = number(row.detectable);
    json["rows"].push_back(std::move(entry));
  }
  return json.dump(2) + "\n";
}

std::string gate_text(const GateRequest& request, const GateCases& cases, const GateResult& result) {
  std::string text = fmt::format("base {}\nhead {}\n\n", build_text(result.base), build_text(result.head));
  text += "exact: " + exact_text(result) + "\n" + differences_text(cases, result) + "\n";
  text += terminal_table(time_rows(result), 1) + "\n" + noise_text(request, result);
  return text + "\n" + verdict_text(result) + "\n";
}

std::string gate_markdown(const GateRequest& request, const GateCases& cases, const GateResult& result) {
  std::string text = fmt::format("### Gate: {}\n\n", verdict_text(result));
  text += fmt::format("Base {}, head {}.\n\n", build_text(result.base), build_text(result.head));
  text += "**Behaviour.** " + exact_text(result) + ".\n\n";
  if (!result.differences.empty()) text += "```\n" + differences_text(cases, result) + "```\n\n";
  text += "**Time**, head over base, processor time of planning.\n\n" + markdown_table(time_rows(result), 1) +
          "\n";
  return text + "```\n" + noise_text(request, result) + "```\n";
}

std::string gate_json(const GateRequest& request, const GateCases& cases, const GateResult& result,
                      const std::string& run) {
  nlohmann::ordered_json json;
  json["verdict"] = name(result.verdict);
  json["reason"] = result.reason;
  json["gate_run"] = run;
  json["suite"] = request.suite;
  json["base"] = build_json(result.base);
  json["head"] = build_json(result.head);
  json["compared"] = result.compared;
  json["differing"] = result.differing;
  json["lost"] = result.lost;
  json["gained"] = result.gained;
  json["differences"] = nlohmann::ordered_json::array();
  for (const GateDifference& difference : result.differences) {
    const GateJob& job = cases.jobs()[difference.job];
    nlohmann::ordered_json entry;
    entry["what"] = name(difference.what.kind);
    entry["instance"] = job.row.name;
    entry["instance_hash"] = job.row.content_hash;
    entry["cell"] = cases.cells()[job.cell].name;
    entry["base"] = difference.what.base;
    entry["head"] = difference.what.head;
    entry["replay"] = job.replay;
    json["differences"].push_back(std::move(entry));
  }
  json["pairs"] = request.pairs;
  json["calibrations"] = result.calibrations;
  json["tolerance"] = request.tolerance;
  json["rows"] = nlohmann::ordered_json::array();
  for (const GateRow& row : result.rows) json["rows"].push_back(row_json(row));
  json["seconds"] = result.wall_s;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string gate_junit(const GateCases& cases, const GateResult& result) {
  std::vector<JunitCase> tests;
  JunitCase behaviour;
  behaviour.name = "behaviour";
  behaviour.output = differences_text(cases, result);
  if (result.behaviour_failed) behaviour.failure = exact_text(result);
  tests.push_back(std::move(behaviour));
  for (const GateRow& row : result.rows) {
    JunitCase test;
    test.name = "time: " + row.name;
    test.output = fmt::format("head {}, at most {}, sees {}", percent_slower(row.suspicion.effect),
                              percent_slower(row.at_most), percent(std::expm1(row.detectable)));
    if (result.times_excused) {
      test.output += "; the same program, so this is noise";
    } else if (row.verdict == RowVerdict::kRegressed) {
      test.failure = "slower by " + percent_slower(row.confirmation->effect);
    } else if (row.verdict == RowVerdict::kInconclusive) {
      test.skipped = "too noisy to tell";
    }
    tests.push_back(std::move(test));
  }
  return junit_xml("sipplab gate", tests);
}

}  // namespace sipplab::bench
