#include "bench/gate/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "db/json_text.hpp"
#include "db/statistics/statistics.hpp"

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

std::string place(const GateResult& result, const Planted& planted) {
  if (!planted.row) return "all cells";
  return result.judgement.at(time_rows(result)[*planted.row]->cell).name + " alone";
}

/// "equal builds: 0.1 % called regressed (95 %: 0.0 to 0.4), 0.2 % inconclusive".
std::string rate_text(const GateResult& result, const ErrorRate& rate) {
  const double all = static_cast<double>(rate.comparisons);
  const auto found = static_cast<double>(rate.regressed);
  const auto interval = db::statistics::wilson_interval(found, all);
  const std::string head = rate.planted.slowdown == 0
                               ? std::string("equal builds")
                               : percent(rate.planted.slowdown) + " slower in " + place(result, rate.planted);
  return fmt::format("  {}: {:.1f} % called regressed (95 %: {:.1f} to {:.1f}), {:.1f} % inconclusive\n",
                     head, 100 * found / all, 100 * interval.low, 100 * interval.high,
                     100 * static_cast<double>(rate.inconclusive) / all);
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
  std::string text = fmt::format("noise: {:.2f} % over all cells (standard error of {} pairs, {})\n",
                                 100 * all.noise, request.pairs, source);
  text += std::isinf(all.detectable)
              ? std::string("sees: nothing with so few pairs\n")
              : fmt::format("sees: a slowdown of {} over all cells, of {} in {} alone (19 times of 20)\n",
                            percent(all.detectable), percent(worst.detectable),
                            result.judgement.at(worst.cell).name);
  if (result.error_rates.empty()) return text;
  text += fmt::format("of {} comparisons drawn from these pairs:\n", result.error_rates.front().comparisons);
  for (const ErrorRate& rate : result.error_rates) text += rate_text(result, rate);
  return text;
}

std::string noise_json(const GateRequest& request, const GateResult& result) {
  nlohmann::ordered_json json = {
      {"suite", request.suite}, {"comparisons", result.calibrations}, {"pairs", request.pairs}};
  for (const Difference* row : time_rows(result)) {
    json["rows"].push_back(difference_json(result.judgement, *row));
  }
  for (const ErrorRate& rate : result.error_rates) {
    json["error_rates"].push_back({{"slowdown", std::expm1(rate.planted.slowdown)},
                                   {"where", place(result, rate.planted)},
                                   {"comparisons", rate.comparisons},
                                   {"regressed", rate.regressed},
                                   {"inconclusive", rate.inconclusive}});
  }
  return db::json_text(json);
}

}  // namespace sipplab::bench
