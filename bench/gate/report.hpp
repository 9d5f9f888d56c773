// What the gate prints.
#pragma once

#include <string>

#include "bench/gate/comparison.hpp"

namespace sipplab::bench {

std::string gate_text(const GateRequest& request, const GateCases& cases, const GateResult& result);
/// For a comment on a pull request.
std::string gate_markdown(const GateRequest& request, const GateCases& cases, const GateResult& result);
/// `run`: UUID in the history, empty where it was not recorded.
std::string gate_json(const GateRequest& request, const GateCases& cases, const GateResult& result,
                      const std::string& run);
std::string gate_junit(const GateCases& cases, const GateResult& result);

/// "noise of this machine ...": what was found and what it allows to see, one or two lines.
std::string noise_text(const GateRequest& request, const GateResult& result);
std::string noise_json(const GateRequest& request, const GateResult& result);

}  // namespace sipplab::bench
