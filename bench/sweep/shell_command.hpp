// What a command line of the shell runs, as far as its words tell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sipplab::bench {

/// The text as one word of the shell.
std::string shell_quoted(const std::string& text);

/// The same, without quotes where the text needs none: for people to read.
std::string shell_word(const std::string& text);

/// Whether a word means itself to the shell, and may name a file by its path.
bool is_plain_path(std::string_view word);

/// The words from the program on, without what only starts it: assignments, `env`, `nice`, `cd x &&`.
std::vector<std::string> from_program(const std::string& command);

/// The program's file name; of a script that an interpreter is to run, the script's.
std::string program_name_of(const std::string& command);

/// The command with absolute paths for words that name files from here, such as ./planner or script.py, and
/// for the folder of a `cd`: it runs in a folder of its own.
std::string with_absolute_paths(const std::string& command);

}  // namespace sipplab::bench
