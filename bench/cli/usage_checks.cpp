#include "bench/cli/usage_checks.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "planner/core/number.hpp"
#include "planner/io/text.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;

/// Names of options, of any command, that name files.
constexpr std::string_view kWritten[] = {"output", "svg", "junit"};
constexpr std::string_view kRead[] = {"instance", "map", "task", "config", "obstacles", "solution"};
constexpr std::string_view kHistory = "db";
/// Of Google Benchmark, which parses it itself.
constexpr std::string_view kBenchmarkOut = "--benchmark_out=";

/// Flags that say how plans are improved, and those that ask for it.
constexpr std::string_view kOfImprovement[] = {"objective", "threads"};
constexpr std::string_view kImproving[] = {"improve", "best"};

/// Options that may be empty: words that a checkout need not have, the value of a parameter, and what may
/// stand without a value.
constexpr std::string_view kMayBeEmpty[] = {"subject", "branch", "param", "resume"};

struct NamedFile {
  std::string option;  ///< "--svg"
  fs::path path;
  bool written = false;
};

std::string check_count(const std::string& text) {
  return parse_number<std::uint64_t>(text) ? ""
                                           : in_quotes(text) + ", expected a whole number >= 0 of 64 bits";
}

bool has_name(const CLI::Option& option, std::string_view name) {
  const std::vector<std::string>& names = option.get_lnames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether an option of this name takes a list, in any command.
bool takes_list(const CLI::App& command, const std::string& name) {
  const CLI::Option* option = command.get_option_no_throw("--" + name);
  if (option != nullptr && option->get_delimiter() == ',') return true;
  const auto commands = command.get_subcommands([](const CLI::App*) { return true; });
  return std::any_of(commands.begin(), commands.end(),
                     [&name](const CLI::App* one) { return takes_list(*one, name); });
}

/// The files that the commands on the line name.
void collect(const CLI::App& command, std::vector<NamedFile>& files, bool& has_history) {
  for (const CLI::Option* option : command.get_options()) {
    const auto is_one_of = [option](const auto& names) {
      return std::any_of(std::begin(names), std::end(names),
                         [option](std::string_view name) { return has_name(*option, name); });
    };
    const bool written = is_one_of(kWritten);
    const bool history = has_name(*option, kHistory);
    has_history = has_history || history;
    if (option->count() == 0 || !(written || history || is_one_of(kRead))) continue;
    for (const std::string& text : option->results()) {
      files.push_back({"--" + option->get_lnames().front(), text, written});
    }
  }
  for (const std::string& text : command.remaining()) {
    if (text.rfind(kBenchmarkOut, 0) == 0) {
      files.push_back({"--benchmark_out", text.substr(kBenchmarkOut.size()), true});
    }
  }
  for (const CLI::App* named : command.get_subcommands()) collect(*named, files, has_history);
}

/// Whether writing one of them loses the other.
bool is_same_file(const NamedFile& a, const NamedFile& b) {
  std::error_code error;
  if (fs::exists(a.path, error) && fs::exists(b.path, error)) {
    // Folders keep both; streams such as /dev/null may be written as often as one likes.
    return fs::is_regular_file(a.path, error) && fs::equivalent(a.path, b.path, error);
  }
  // Files that do not exist yet matter only if both are written; a path to read may be the name of a map.
  if (!a.written || !b.written || a.path.empty()) return false;
  const auto normal = [&error](const NamedFile& file) {
    return fs::absolute(file.path, error).lexically_normal();
  };
  return normal(a) == normal(b);
}

}  // namespace

void refuse_false_counts(CLI::App& program) {
  for (CLI::Option* option : program.get_options()) {
    if (option->get_type_name().rfind("UINT", 0) == 0) option->check(check_count, "");
  }
  for (CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    refuse_false_counts(*command);
  }
}

std::string empty_element_error(const CLI::App& program, int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) != 0) continue;
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(2, equals == std::string::npos ? equals : equals - 2);
    if (name.empty() || !takes_list(program, name)) continue;
    std::string list;
    if (equals != std::string::npos) {
      list = argument.substr(equals + 1);
    } else if (i + 1 < argc) {
      list = argv[i + 1];
    }
    const bool has_empty =
        !list.empty() && (list.front() == ',' || list.back() == ',' || list.find(",,") != std::string::npos);
    if (has_empty) return "--" + name + ": " + in_quotes(list) + ", expected something between the commas";
  }
  return "";
}

std::string empty_value_error(const CLI::App& program) {
  for (const CLI::Option* option : program.get_options()) {
    const auto names = [option](std::string_view name) { return has_name(*option, name); };
    if (std::any_of(std::begin(kMayBeEmpty), std::end(kMayBeEmpty), names)) continue;
    for (const std::string& value : option->results()) {
      if (value.empty()) return option->get_name() + " is empty, expected a value";
    }
  }
  for (const CLI::App* command : program.get_subcommands()) {
    if (std::string error = empty_value_error(*command); !error.empty()) return error;
  }
  return "";
}

std::string overwrite_error(const CLI::App& program, fs::path (*history)()) {
  std::vector<NamedFile> files;
  bool has_history = false;
  collect(program, files, has_history);
  const bool names_history =
      std::any_of(files.begin(), files.end(), [](const NamedFile& file) { return file.option == "--db"; });
  if (has_history && !names_history && history != nullptr) files.push_back({"the history", history(), false});
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t k = 0; k < files.size(); ++k) {
      if (i == k || !files[i].written || !is_same_file(files[i], files[k])) continue;
      return files[i].option + " " + files[i].path.string() + " would overwrite " + files[k].option +
             ", expected a file of its own";
    }
  }
  return "";
}

std::string idle_flag_error(const CLI::App& program) {
  const auto is_given = [&program](std::string_view name) {
    const CLI::Option* option = program.get_option_no_throw("--" + std::string(name));
    return option != nullptr && option->count() > 0;
  };
  const bool improves = std::any_of(std::begin(kImproving), std::end(kImproving), is_given);
  for (const std::string_view flag : kOfImprovement) {
    if (is_given(flag) && !improves) {
      return "--" + std::string(flag) +
             " says how a plan is improved, expected --improve or --best beside it";
    }
  }
  for (const CLI::App* command : program.get_subcommands()) {
    if (std::string error = idle_flag_error(*command); !error.empty()) return error;
  }
  return "";
}

}  // namespace sipplab::cli
