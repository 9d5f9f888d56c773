// What the gate adds to a report: the two builds, and how noisy the machine is.
#pragma once

#include <string>

#include "bench/gate/comparison.hpp"
#include "bench/judge/report.hpp"

namespace sipplab::bench {

/// `run`: UUID in the history, empty if it was not recorded.
Report gate_report(const GateRequest& request, const GateResult& result, const std::string& run);

/// "noise: ...": what was found and what it allows to see, two lines; then rates of errors, if there are any.
std::string noise_text(const GateRequest& request, const GateResult& result);
std::string noise_json(const GateRequest& request, const GateResult& result);

}  // namespace sipplab::bench
