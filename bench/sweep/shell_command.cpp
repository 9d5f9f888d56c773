#include "bench/sweep/shell_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

/// Whether a word means itself to the shell.
bool is_plain_word(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("/._-+@%,:").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

/// Programs that only start another one, with their options that take a word, and the words before it.
struct Starter {
  std::string_view name;
  std::string_view options;
  std::size_t words;
};
constexpr Starter kStarters[] = {
    {"env", " -u -C ", 0},  {"nice", " -n ", 0}, {"ionice", " -c -n ", 0}, {"timeout", " -s -k ", 1},
    {"time", " -f -o ", 0}, {"nohup", "", 0},    {"setsid", "", 0},        {"stdbuf", " -i -o -e ", 0},
    {"taskset", "", 1},     {"chrt", "", 1},     {"exec", " -a ", 0},      {"numactl", " -N -m ", 0}};
/// What runs a script; versions are digits behind the name.
constexpr std::string_view kInterpreters =
    " sh bash dash ksh zsh python pypy perl ruby node lua julia Rscript java php ";
/// Before the program, up to && or a semicolon.
constexpr std::string_view kSettings = " cd export ulimit umask set ";

bool is_in(std::string_view words, std::string_view word) {
  return words.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

std::string base_name(const std::string& word) { return fs::path(word).filename().string(); }

}  // namespace

bool is_plain_path(std::string_view word) {
  return word.find_first_of("/.") != std::string_view::npos && is_plain_word(word);
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_word(const std::string& text) {
  return !text.empty() && is_plain_word(text) ? text : shell_quoted(text);
}

std::vector<std::string> from_program(const std::string& command) {
  std::istringstream text(command);
  std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  const auto drop = [&words](std::size_t count) {
    words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(std::min(count, words.size())));
  };
  while (words.size() > 1) {
    const std::string first = base_name(words[0]);
    const auto starter = std::find_if(std::begin(kStarters), std::end(kStarters),
                                      [&](const Starter& known) { return known.name == first; });
    if (is_in(kSettings, first)) {
      const auto end = std::find_if(words.begin(), words.end(), [](const std::string& word) {
        return word == "&&" || word.back() == ';';
      });
      if (end == words.end()) return words;
      words.erase(words.begin(), end + 1);
    } else if (starter != std::end(kStarters)) {
      drop(1);
      while (!words.empty() && words[0].front() == '-') drop(is_in(starter->options, words[0]) ? 2 : 1);
      drop(starter->words);
    } else if (words[0].find('=') < words[0].find('/')) {
      drop(1);
    } else {
      break;
    }
  }
  return words;
}

std::string program_name_of(const std::string& command) {
  const std::vector<std::string> words = from_program(command);
  if (words.empty()) return "";
  const std::string program = base_name(words[0]);
  if (!is_in(kInterpreters, program.substr(0, program.find_first_of("0123456789")))) return program;
  std::optional<std::string> script;
  for (std::size_t i = 1; i < words.size() && words[i].find('{') == std::string::npos; ++i) {
    if (words[i].front() == '-' || !is_plain_word(words[i])) continue;
    std::error_code ignored;
    if (fs::is_regular_file(words[i], ignored)) return base_name(words[i]);
    if (!script) script = words[i];
  }
  return script ? base_name(*script) : program;
}

std::string with_absolute_paths(const std::string& command) {
  std::string absolute;
  std::string_view rest = command;
  std::string_view before;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of(" \t\n"), rest.size());
    const std::string_view word = rest.substr(0, end);
    std::error_code ignored;
    const fs::path path(word);
    const bool is_file = is_plain_path(word) && path.is_relative() && fs::is_regular_file(path, ignored);
    const bool is_folder = before == "cd" && path.is_relative() && fs::is_directory(path, ignored);
    before = word;
    absolute += is_file || is_folder ? shell_quoted(fs::absolute(path, ignored).lexically_normal().string())
                                     : std::string(word);
    if (end < rest.size()) absolute += rest[end];
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return absolute;
}

}  // namespace sipplab::bench
