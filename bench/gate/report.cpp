#include "bench/gate/report.hpp"
#include "db/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sipplab::bench {
namespace {

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

nlohmann::ordered_json build_json(const WorkerGreeting& greeting) {
  const SourceInfo source = source_info(greeting.program);
  return {{"commit", source.commit ? nlohmann::ordered_json(source.commit->hash) : nullptr},
          {"dirty", greeting.build.dirty},
          {"compiler", greeting.build.compiler + " " + greeting.build.compiler_version},
          {"build_type", greeting.build.build_type},
          {"binary_hash", greeting.build.binary_hash}};
}

/// All cells together first.
std::vector<const Difference*> time_rows(const GateResult& result) {
  std::vector<const Difference*> rows;
  for (const Difference& row : result.judgement.differences) {
    if (row.metric == &kProcessTime) rows.push_back(&row);
  }
  return rows;
}

std::string percent(double log_ratio) {
  return std::isfinite(log_ratio) ? fmt::format("{:.1f} %", 100 * std::expm1(log_ratio)) : "-";
}

/// Where those are that are not listed: of the gate's own plannings, and of both sweeps.
std::string all_findings(const GateRequest& request) {
  std::string text = "`SELECT * FROM v_gate_differences`";
  if (request.sweeps.empty()) return text;
  const db::PairedCell& cell = request.sweeps.front();
  return text + fmt::format(", `sipplab compare {:.8} {:.8} --list`", cell.base_run, cell.head_run);
}

}  // namespace

Report gate_report(const GateRequest& request, const GateResult& result, const std::string& run) {
  return {result.judgement,
          "sipplab gate",
          build_text(result.base),
          build_text(result.head),
          {{"gate_run", run},
           {"suite", request.suite},
           {"base", build_json(result.base)},
           {"head", build_json(result.head)},
           {"pairs", request.pairs},
           {"calibrations", result.calibrations},
           {"tolerance", request.tolerance},
           {"seconds", result.wall_s}},
          noise_text(request, result),
          all_findings(request)};
}

std::string noise_text(const GateRequest& request, const GateResult& result) {
  const std::vector<const Difference*> rows = time_rows(result);
  const Difference& all = *rows.front();
  const Difference& worst = **std::max_element(
      rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->detectable < b->detectable; });
  const std::string source =
      result.calibrations > 0
          ? fmt::format("from {} comparison{} of equal builds on this machine", result.calibrations,
                        result.calibrations == 1 ? "" : "s")
          : std::string("from this comparison alone; `sipplab gate --calibrate` measures it");
  const std::string noise = fmt::format("noise: {:.2f} % over all cells (standard error of {} pairs, {})\n",
                                        100 * all.noise, request.pairs, source);
  if (std::isinf(all.detectable)) return noise + "sees: nothing with so few pairs\n";
  return noise + fmt::format("sees: a slowdown of {} over all cells, of {} in {} alone (19 times of 20)\n",
                             percent(all.detectable), percent(worst.detectable),
                             result.judgement.at(worst.cell).name);
}

std::string noise_json(const GateRequest& request, const GateResult& result) {
  nlohmann::ordered_json json = {
      {"suite", request.suite}, {"comparisons", result.calibrations}, {"pairs", request.pairs}};
  for (const Difference* row : time_rows(result)) {
    json["rows"].push_back(difference_json(result.judgement, *row));
  }
  return db::json_text(json);
}

}  // namespace sipplab::bench
