// Reports of judgements: JSON, tables and JUnit against the judgement that they tell of.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/judge/judgement.hpp"
#include "bench/judge/report.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/paired_results.hpp"
#include "property_tests/support/plain_statistics.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::bench::judgement_reports_laws {
namespace {

constexpr int kFewer = (kCasesOfHistories + 1) / 2;

void reports_say_what_was_judged() {
  Judgement judgement = measured(any_cells());
  if (judgement.results.empty()) RC_DISCARD("nothing to compare");
  judge(judgement, {});
  Report report{judgement, "sipplab compare", "base", "head"};
  report.changes_fail = db::any_flag();
  const auto json = nlohmann::json::parse(report_json(report));
  RC_ASSERT(json.at("verdict") == name(judgement.all.verdict));
  RC_ASSERT(json.at("reason") == judgement.all.reason);
  RC_ASSERT(json.at("compared") == judgement.all.compared);
  RC_ASSERT(json.at("differing") == judgement.all.differing);
  RC_ASSERT(json.at("other_plans") == judgement.all.other_plans);
  const Difference& success = *judgement.find(kSuccess, std::nullopt);
  RC_ASSERT(json.at("lost") == success.lost);
  RC_ASSERT(json.at("gained") == success.gained);
  RC_ASSERT(json.at("cells").size() == judgement.cells.size());
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) {
    const auto& cell = json.at("cells")[i];
    const Judged& judged = judgement.cells[i];
    RC_ASSERT(cell.at("cell") == judged.name);
    RC_ASSERT(cell.at("instances") == judged.instances);
    RC_ASSERT(cell.at("plannings") == judged.compared);
    RC_ASSERT(cell.at("differing") == judged.differing);
    RC_ASSERT(cell.at("base_solved") == judged.base_solved);
    RC_ASSERT(cell.at("head_solved") == judged.head_solved);
    RC_ASSERT(cell.at("both_solved") == judged.both_solved);
    RC_ASSERT(cell.at("base_par2_s").is_null() == !judged.base_par2_s.has_value());
    if (judged.base_par2_s) RC_ASSERT(cell.at("base_par2_s") == *judged.base_par2_s);
    if (judged.head_par2_s) RC_ASSERT(cell.at("head_par2_s") == *judged.head_par2_s);
    RC_ASSERT(cell.at("verdict") == name(judged.verdict));
    RC_ASSERT(cell.at("environment") == judgement.results[i].parameters.environment);
    RC_ASSERT(cell.at("robots") == judgement.results[i].parameters.robots);
  }
  const auto is_number = [](const nlohmann::json& value, double expected) {
    return std::isfinite(expected) ? value.is_number() && close(value.get<double>(), expected)
                                   : value.is_null();
  };
  RC_ASSERT(json.at("differences").size() == judgement.differences.size());
  for (std::size_t i = 0; i < judgement.differences.size(); ++i) {
    const auto& said = json.at("differences")[i];
    const Difference& row = judgement.differences[i];
    const bool share = row.metric == &kSuccess;
    // Logarithms as ratios less one.
    const auto shown = [share](double value) {
      return share || !std::isfinite(value) ? value : std::exp(value) - 1;
    };
    RC_LOG() << row.metric->name << '\n';
    RC_ASSERT(said.at("metric") == row.metric->name);
    RC_ASSERT(said.at("pairs") == row.pairs.size());
    RC_ASSERT(said.at("worse") == row.worse());
    RC_ASSERT(said.at("better") == row.better());
    RC_ASSERT(is_number(said.at("effect"), shown(row.effect)));
    RC_ASSERT(is_number(said.at("at_least"), shown(row.at_least)));
    RC_ASSERT(is_number(said.at("at_most"), shown(row.at_most)));
    RC_ASSERT(is_number(said.at("floor"), shown(row.floor)));
    RC_ASSERT(is_number(said.at("detectable"), shown(row.detectable)));
    const bool is_tested = row.metric != &kMemory && row.metric != &kSweepTime;
    RC_ASSERT(said.at("p_value").is_null() == !is_tested);
    if (is_tested) RC_ASSERT(is_number(said.at("p_value"), row.p_value));
    if (is_tested) RC_ASSERT(is_number(said.at("adjusted_p_value"), row.adjusted_p));
    RC_ASSERT(said.at("verdict").is_null() == !row.verdict.has_value());
    if (row.verdict) RC_ASSERT(said.at("verdict") == name(*row.verdict));
  }
  RC_ASSERT(json.at("findings").size() == judgement.findings.size());
  for (std::size_t i = 0; i < judgement.findings.size(); ++i) {
    const auto& said = json.at("findings")[i];
    const Finding& finding = judgement.findings[i];
    RC_ASSERT(said.at("what") == name(finding.what.kind));
    RC_ASSERT(said.at("instance_hash") == judgement.result(finding).instance_hash);
    RC_ASSERT(said.at("position") == judgement.result(finding).base.position);
    RC_ASSERT(said.at("plannings") == finding.plannings);
    RC_ASSERT(said.at("base") == finding.what.base);
    RC_ASSERT(said.at("head") == finding.what.head);
  }
  // The table for people: each cell's counts in its row, and those of all in the last.
  const std::vector<TextRow> table = behaviour_table(judgement);
  RC_ASSERT(table.size() == judgement.cells.size() + 2);
  const auto column = [&table](const char* heading, std::size_t row) {
    const auto at = std::find(table[0].begin(), table[0].end(), heading);
    return at == table[0].end() ? std::string("-")
                                : table[row][static_cast<std::size_t>(at - table[0].begin())];
  };
  for (std::size_t i = 0; i <= judgement.cells.size(); ++i) {
    const std::optional<std::size_t> number = i < judgement.cells.size() ? std::optional(i) : std::nullopt;
    const Judged& judged = judgement.at(number);
    const Difference& row = *judgement.find(kSuccess, number);
    RC_ASSERT(table[i + 1][0] == judged.name);
    RC_ASSERT(column("differ", i + 1) == std::to_string(judged.differing));
    RC_ASSERT(column("solved", i + 1) ==
              std::to_string(judged.base_solved) + " -> " + std::to_string(judged.head_solved));
    RC_ASSERT(column("lost", i + 1) == std::to_string(row.lost));
    RC_ASSERT(column("gained", i + 1) == std::to_string(row.gained));
    RC_ASSERT(column("both solved", i + 1) == std::to_string(judged.both_solved));
  }
  // A test for each cell and one for the whole; failed is what regressed or is not to be planned otherwise,
  // skipped what nobody can tell.
  const std::string xml = report_junit(report);
  const auto occurrences = [&xml](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = xml.find(text); at != std::string::npos; at = xml.find(text, at + 1)) ++found;
    return found;
  };
  std::size_t failed = 0;
  std::size_t skipped = 0;
  const auto count = [&](const Judged& judged) {
    const bool fails =
        judged.verdict == Verdict::kRegressed || (report.changes_fail && judged.other_plans > 0);
    failed += fails ? 1U : 0U;
    skipped += !fails && judged.verdict == Verdict::kInconclusive ? 1U : 0U;
  };
  count(judgement.all);
  for (const Judged& cell : judgement.cells) count(cell);
  RC_ASSERT(occurrences("<testcase ") == judgement.cells.size() + 1);
  RC_ASSERT(occurrences("<failure ") == failed);
  RC_ASSERT(occurrences("<skipped ") == skipped);
  RC_ASSERT(occurrences("failures=\"" + std::to_string(failed) + "\" skipped=\"" + std::to_string(skipped) +
                        "\"") == 1U);
}

const PropertyRoom room("judgement_reports", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("reports say what was judged", reports_say_what_was_judged, kFewer);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::judgement_reports_laws
