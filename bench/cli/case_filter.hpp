// --case: which cases of the history a command is about.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "db/trends.hpp"
#include "sipplab/error.hpp"

namespace sipplab::cli {

void add_case_flag(CLI::App& command, std::vector<std::string>& parts);

/// "7", or "robots=64", "ssi=inf", "environment=warehouse", ... together. Errors: one line.
Expected<db::CaseFilter, std::string> parse_case_filter(const std::vector<std::string>& parts);

}  // namespace sipplab::cli
