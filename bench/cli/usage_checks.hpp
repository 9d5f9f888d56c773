// What holds for the arguments of every command, checked in one place.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sipplab::cli {

/// Makes every option of the program and of its commands that takes a whole number from 0 on refuse signs
/// and numbers that do not fit: the library underneath lets -1 through as the largest number there is.
void refuse_false_counts(CLI::App& program);

/// After parsing: one line where a file that would be written is another one that was named, be it read,
/// written as well, or the history itself, which would be lost. Else empty.
std::string overwrite_error(const CLI::App& program);

}  // namespace sipplab::cli
