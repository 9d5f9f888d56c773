// What the command line says, and with which code it ends. Answers go to stdout,
// everything else to stderr.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "bench/program.hpp"
#include "planner/core/try.hpp"
#include "sipplab/error.hpp"

namespace sipplab::cli {

/// Exit codes: scripts depend on them.
enum ExitCode : int {
  kSuccess = 0,
  kNegativeVerdict = 1,  ///< unsolved, invalid, a regression, a finding
  kBadUsage = 2,         ///< bad usage or input, and output that cannot be written
  kInconclusive = 3,
  kNothingComparable = 4,
  kChangedPlans = 5,  ///< nothing is worse for certain, and no one said that plans would differ
  kInternalError = 70,
};

using bench::kSignalExitBase;

/// Writes to stdout; what cannot be written is noticed by close_stdout().
void print(std::string_view text);
void print_json(const nlohmann::ordered_json& json);

/// Flushes stdout, standard streams included. Returns `code`; the code of a program that SIGPIPE ends,
/// without a word, if the reader has gone; kBadUsage with one line on stderr if the disk is full.
int close_stdout(int code);

/// One line on stderr as it is; line breaks in it become blanks.
void diagnose(std::string_view line);

/// diagnose(line), and the code to end with.
int fail(int code, std::string_view line);
/// Of bad input: the line names its file.
int fail(const std::string& line);
int fail(const InputError& error);
/// Of bad usage: "sipplab: " and the line.
int bad_usage(const std::string& line);

bool stderr_is_terminal();

}  // namespace sipplab::cli
