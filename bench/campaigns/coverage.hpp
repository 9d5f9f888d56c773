// What llvm-cov says about the planner.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "db/fuzz_runs.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// The files below planner/ in the JSON of `llvm-cov export -summary-only`. Errors: one line.
Expected<std::vector<db::FileCoverage>, std::string> parse_coverage(std::string_view text,
                                                                    const std::string& name);

}  // namespace sipplab::bench
