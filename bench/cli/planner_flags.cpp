#include "bench/cli/planner_flags.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/cli/console.hpp"
#include "bench/present/picture_format.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

std::string expected(const std::string& text, const std::string& what) {
  return in_quotes(text) + ", expected " + what;
}

const char* title(OptionGroup group) {
  constexpr const char* kNames[] = {"Planner", "Motion", "Limits", "Improvement"};
  return kNames[static_cast<std::size_t>(group)];
}

}  // namespace

std::string check_ssi(const std::string& text) {
  const std::optional<double> ssi_s = parse_ssi(text);
  return ssi_s && is_ssi(*ssi_s) ? ""
                                 : expected(text, fmt::format("seconds from 0 to {:g}, or inf", kMaxSsiS));
}

std::string check_positive_real(const std::string& text) {
  return parse_real(text).value_or(0) > 0 ? "" : expected(text, "a number > 0");
}

CLI::Validator real_between(double low, double high) {
  const std::string range = "in [" + format_real(low) + " - " + format_real(high) + "]";
  const auto check = [low, high, range](const std::string& text) {
    const std::optional<double> number = parse_real(text);
    return number && *number >= low && *number <= high ? "" : expected(text, "a number " + range);
  };
  return {check, "FLOAT " + range};
}

void add_values(CLI::App& command, const std::string& flag, std::vector<std::string>& values,
                const std::string& words) {
  command.add_option(flag, values, words)->delimiter(',')->check(check_positive_real)->type_name("X,..");
}

std::vector<double> numbers_of(const std::vector<std::string>& texts) {
  std::vector<double> numbers;
  for (const std::string& text : texts) numbers.push_back(parse_real(text).value_or(0));
  return numbers;
}

void InstanceFlags::add_to(CLI::App& command) {
  command.option_defaults()->group("Input");
  command.add_option("--instance", files_.instance,
                     "instance in one file (XML, or a .scen that names its map)");
  command.add_option("--map", files_.map, "map (XML or MovingAI .map)");
  command.add_option("--task", files_.task, "agents (XML or MovingAI .scen)");
  command.add_option("--config", files_.config, "planner options (XML); command-line flags override it");
  command.add_option("--obstacles", files_.obstacles, "dynamic obstacles (XML)");
  command.add_option("--agents", files_.agents, "only the first N agents");
  const auto add_value = [&command](const char* flag, std::vector<std::string>& value, const char* words) {
    command.add_option(flag, value, words)->expected(1)->check(check_positive_real)->type_name("X");
  };
  add_value("--radius", radius_, "radius in cells of robots in a .scen, which states none; default 0.5");
  add_value("--speed", speed_, "cells per second; likewise; default 1");
  command.add_flag("--allow-unreachable", files_.allow_unreachable,
                   "accept instances in which a goal cannot be reached");
  command.option_defaults()->group("Options");
}

Expected<LoadedInstance, std::string> InstanceFlags::load() const {
  if (!files_.instance && !files_.task) {
    return Unexpected{
        std::string("sipplab: no instance given, expected --instance FILE, or --map FILE --task FILE")};
  }
  InstanceFiles files = files_;
  if (!radius_.empty()) files.radius_cells = parse_real(radius_.front());
  if (!speed_.empty()) files.speed_cells_per_s = parse_real(speed_.front());
  Input<LoadedInstance> loaded = load_instance(files);
  if (!loaded) return Unexpected{loaded.error().message()};
  for (const std::string& warning : loaded->warnings) diagnose("warning: " + warning);
  return std::move(*loaded);
}

CLI::Option* OptionFlags::add(CLI::App& command, const Option& option, bool many) {
  const std::string flag = "--" + std::string(option.name);
  const bool is_choice = option.kind == OptionKind::kYesNo;
  const auto check = [&option, is_choice](const std::string& text) {
    const std::string without = is_choice ? "a flag without a value, or one of " : "";
    return takes(option, text) ? "" : expected(text, without + option.expected);
  };
  const auto take = [this, &option](const std::vector<std::string>& texts) {
    values_.push_back({&option, texts});
  };
  if (is_choice) {
    // By way of a function: a flag bound to a value would count from 0, which is false.
    const auto take_count = [take](std::int64_t count) { take({count > 0 ? "yes" : "no"}); };
    return command.add_flag_function(flag + ",!--no-" + option.name, take_count, option.help)
        ->check(check)
        ->group(title(option.group));
  }
  CLI::Option* added = command.add_option_function<std::vector<std::string>>(flag, take, option.help);
  added->check(check)->type_name(option.value)->group(title(option.group));
  return many || option.is_list ? added->delimiter(',') : added->expected(1);
}

void OptionFlags::add_to(CLI::App& command, std::initializer_list<OptionGroup> groups, bool many,
                         OptionRows rows) {
  for (const Option& option : rows) {
    const bool is_wanted = std::find(groups.begin(), groups.end(), option.group) != groups.end();
    // Some commands have one of their own.
    if (is_wanted && command.get_option_no_throw("--" + std::string(option.name)) == nullptr) {
      add(command, option, many);
    }
  }
}

StatedOptions OptionFlags::stated() const {
  StatedOptions stated;
  for (const auto& [option, texts] : values_) {
    stated.state(*option, option->is_list ? fmt::format("{}", fmt::join(texts, ",")) : texts.front());
  }
  return stated;
}

void PictureFlags::add_to(CLI::App& command, const std::string& words) {
  CLI::Option* svg = command.add_option("--svg", file, words)->type_name("FILE")->group("Output");
  command.add_option("--animate", animate_, "animate the picture; 2 is twice as fast as the plan")
      ->needs(svg)
      ->check(check_positive_real)
      ->type_name("SPEED")
      ->group("Output");
}

std::optional<std::string> PictureFlags::find_error() const {
  return file ? bench::find_plan_picture_error(*file) : std::nullopt;
}

double PictureFlags::animation_speed() const { return animate_ ? parse_real(*animate_).value_or(1) : 0; }

void add_database_flag(CLI::App& command, std::optional<std::string>& path) {
  command.add_option("--db", path, "history file; default $SIPPLAB_DB, else ./sipplab.db")->type_name("FILE");
}

CLI::Option* add_solution_format(CLI::App& command, std::optional<std::string>& format) {
  std::vector<std::string> names;
  for (const SolutionFormat& known : solution_formats()) names.emplace_back(known.name);
  return command.add_option("--solution-format", format, "format of the solution where guessing fails")
      ->check(CLI::IsMember(names));
}

void SolutionOutput::add_to(CLI::App& command) {
  std::vector<std::string> names;
  for (const SolutionFormat& known : solution_formats()) {
    if (known.write != nullptr) names.emplace_back(known.name);
  }
  command.add_option("--format", format, "format of the solution; default: by the suffix of -o, else xml")
      ->check(CLI::IsMember(names));
  command.add_option("-o,--output", file, "write the solution there")->type_name("FILE");
}

Expected<std::string, std::string> SolutionOutput::write(const Instance& instance,
                                                         const SolutionDocument& document) const {
  const std::string named(format ? *format : solution_format_of_file(file.value_or("")));
  auto text = write_solution(named, instance, document);
  if (!text || !file) return text;
  if (const auto error = write_file(*file, *text)) return Unexpected{error->message()};
  return text;
}

}  // namespace sipplab::cli
