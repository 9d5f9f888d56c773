// The judged half of the gate: a process of one build that plans what it is told, again and
// again, and answers with what came out and how much processor time it took.
#pragma once

#include <iosfwd>

namespace sipplab::bench {

/// Serves the lines of `requests` until they end:
///
///     {"load": FILE}                    -> {"instance": 0, "content_hash": "..."}
///     {"instance": 0, "options": {..}}  -> {"job": 0}; with "task", one of laboratory.hpp
///     {"plan": 0}                       -> the answer; with "check", validated; with "memory", measured
///
/// What goes wrong is answered as {"error": "one line"}.
void serve_gate(std::istream& requests, std::ostream& answers);

}  // namespace sipplab::bench
