// Flags that several commands share: which instance, which planner options, and
// where the history is.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/options/option_table.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"

namespace sipplab::cli {

/// --instance, --map, --task, --config, --obstacles, --agents, --radius, --speed, --allow-unreachable.
class InstanceFlags {
 public:
  void add_to(CLI::App& command);

  /// The file that names the robots; empty where none was given.
  std::string robots_file() const { return files_.task.value_or(files_.instance.value_or("")); }
  /// Reads the files, warnings to stderr. Errors are one line.
  Expected<LoadedInstance, std::string> load() const;

 private:
  InstanceFiles files_;
  std::vector<std::string> radius_;
  std::vector<std::string> speed_;
};

/// Flags of the planner's options, from their table. Empty unless the user gave them.
class OptionFlags {
 public:
  /// `many`: it takes several values, with commas between.
  CLI::Option* add(CLI::App& command, const Option& option, bool many = false);
  /// Those of some groups that the command has no flag of its own for.
  void add_to(CLI::App& command, std::initializer_list<OptionGroup> groups, bool many = false,
              OptionRows rows = option_rows());

  /// The first value of each flag; of a list all.
  StatedOptions stated() const;
  /// Each flag that was given, with its values.
  const std::vector<OptionValues>& values() const { return values_; }

 private:
  std::vector<OptionValues> values_;
};

/// --format and -o: a solution to a file, or to standard output.
struct SolutionOutput {
  std::optional<std::string> format;  ///< a name of solution_formats() that is written
  std::optional<std::string> file;

  void add_to(CLI::App& command);
  bool wanted() const { return format || file; }
  /// The text, which is in the file now if one was named; or one line that says why not.
  Expected<std::string, std::string> write(const Instance& instance, const SolutionDocument& document) const;
};

/// --solution-format: a name of solution_formats().
CLI::Option* add_solution_format(CLI::App& command, std::optional<std::string>& format);

/// Largest seed: the history keeps seeds as signed 64-bit integers.
inline constexpr std::uint64_t kMaxSeed = INT64_MAX;
/// Most robots that can be asked for; more than that do not fit into memory.
inline constexpr std::size_t kMostRobots = 1'000'000;
/// Checks for CLI11: empty when the text is right, else what was expected.
std::string check_ssi(const std::string& text);
std::string check_positive_real(const std::string& text);
/// A flag of one or more numbers above 0, "0.3,1.4".
void add_values(CLI::App& command, const std::string& flag, std::vector<std::string>& values,
                const std::string& words);
std::vector<double> numbers_of(const std::vector<std::string>& texts);
/// A number in [low, high]. CLI::Range lets "nan" through, which is below and above nothing.
CLI::Validator real_between(double low, double high);

/// --svg, with `words` for help, and --animate.
struct PictureFlags {
  std::optional<std::string> file;

  void add_to(CLI::App& command, const std::string& words);
  /// As SvgOptions::animation_speed.
  double animation_speed() const;
  /// One line if the file is called otherwise than a picture of a plan.
  std::optional<std::string> find_error() const;

 private:
  std::optional<std::string> animate_;
};

/// --db, with its help text.
void add_database_flag(CLI::App& command, std::optional<std::string>& path);

}  // namespace sipplab::cli
