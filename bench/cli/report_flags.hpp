// How `sipplab compare` and `sipplab gate` deliver a report.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/judge/report.hpp"

namespace sipplab::cli {

struct ReportFlags {
  std::string format = "text";
  bool json = false;
  std::optional<std::string> junit;
  std::vector<std::string> floors;
  bool expects_changes = false;  ///< plans that differ are no reason to fail

  bool wants_json() const { return json || format == "json"; }
};

void add_report_flags(CLI::App& command, ReportFlags& flags);

/// The smallest changes that count, as --floor has them.
bench::Floors floors_of(const ReportFlags& flags);

/// Prints the report and writes the file of --junit. Returns the exit code of its verdict.
int print_report(bench::Report report, const ReportFlags& flags);

}  // namespace sipplab::cli
