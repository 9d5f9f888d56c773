// Density curves of a run.
#include "bench/present/density.hpp"

#include <fmt/core.h>

#include <set>

#include "bench/present/plots.hpp"

namespace sipplab::bench {
namespace {

/// What stays the same within a picture.
std::string method_of(const db::CaseInfo& of) {
  return fmt::format("{}, {}, {}, {}", of.environment, of.text("reschedule"), of.text("initial_order"),
                     of.planner);
}

std::string file_name(const std::string& kind, const std::string& method) {
  std::string name = kind + '-';
  for (const char c : method) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (plain) {
      name += c;
    } else if (name.back() != '-') {
      name += '-';
    }
  }
  return name;
}

}  // namespace

std::vector<DensityChart> density_charts(const db::RunReport& run, const std::optional<db::RunReport>& base) {
  PlotRequest request;
  request.runs.push_back({run, {}, {}});
  if (base) request.runs.push_back({*base, {}, {}});
  request.second_is_base = true;
  std::vector<DensityChart> charts;
  std::set<std::string> seen;
  std::set<std::string> taken;
  for (const db::CellSummary& cell : run.cells) {
    const db::CaseInfo& of = cell.parameters;
    const std::string method = method_of(of);
    if (!seen.insert(method).second) continue;
    request.filter.environment = of.environment;
    request.filter.planner = of.planner;
    for (const char* column : {"reschedule", "initial_order"}) {
      request.filter.options[column] = of.option(column);
    }
    // Methods may differ in what a file's name does not hold.
    std::string suffix;
    for (int copy = 2; !taken.insert(file_name("", method) + suffix).second; ++copy) {
      suffix = fmt::format("-{}", copy);
    }
    charts.push_back({file_name("success", method) + suffix, success_chart(request)});
    charts.push_back({file_name("runtime", method) + suffix, runtime_chart(request)});
  }
  return charts;
}

}  // namespace sipplab::bench
