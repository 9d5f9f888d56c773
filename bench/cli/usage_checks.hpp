// What holds for the arguments of every command, checked in one place.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace sipplab::cli {

/// Makes every option of the program and of its commands that takes a whole number from 0 on refuse signs
/// and numbers that do not fit: the library underneath lets -1 through as the largest number there is.
void refuse_false_counts(CLI::App& program);

/// Before parsing: one line if a list on the command line has an element of no characters, as in
/// --ssi 5,,9, which the library underneath would leave out. Else empty.
std::string empty_element_error(const CLI::App& program, int argc, const char* const* argv);

/// After parsing: one line if an option is given without a value, as in --db "$UNSET". Else empty.
std::string empty_value_error(const CLI::App& program);

/// After parsing: one line if a file that would be written is another one that was named, be it read,
/// written as well, or the history itself, which would be lost. Else empty.
std::string overwrite_error(const CLI::App& program, std::filesystem::path (*history)());

/// After parsing: one line if a flag was given that changes nothing without another one, such as
/// --objective without improvement. Else empty.
std::string idle_flag_error(const CLI::App& program);

}  // namespace sipplab::cli
