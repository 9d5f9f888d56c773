#include "bench/cli/planner_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "bench/cli/console.hpp"
#include "planner/complete/complete_planner.hpp"
#include "planner/io/text.hpp"

namespace sipplab::cli {
namespace {

constexpr const char* kRescheduleNames = "none, deterministic, random or ejection";
constexpr const char* kOrderNames = "fifo, shortest, longest or random";
constexpr const char* kMethodNames = "prioritized or complete";
constexpr const char* kFallbackNames = "none or complete";
constexpr int kMinConnectedness = 2;
constexpr int kMaxConnectedness = 5;

std::string expected(const std::string& text, const std::string& what) {
  return in_quotes(text) + ", expected " + what;
}

/// A flag and its opposite, empty unless the user gave one of them. By way of a function: a
/// flag bound to an optional would count from 0, which is false.
void add_yes_or_no(CLI::App& command, const std::string& names, std::optional<bool>& choice,
                   const std::string& words) {
  // Releases of CLI11 from 2.4 on take any text for false here.
  const auto check = [](const std::string& text) {
    constexpr std::array<std::string_view, 4> kWords = {"true", "false", "1", "0"};
    const bool known = std::find(kWords.begin(), kWords.end(), text) != kWords.end();
    return known ? "" : expected(text, "a flag without a value, or one of true and false");
  };
  command
      .add_flag_function(
          names, [&choice](std::int64_t count) { choice = count > 0; }, words)
      ->check(check);
}

}  // namespace

std::string check_ssi(const std::string& text) {
  const std::optional<double> ssi_s = parse_ssi(text);
  return ssi_s && is_ssi(*ssi_s) ? ""
                                 : expected(text, fmt::format("seconds from 0 to {:g}, or inf", kMaxSsiS));
}

std::string check_reschedule(const std::string& text) {
  return parse_rescheduling(text) ? "" : expected(text, kRescheduleNames);
}

std::string check_order(const std::string& text) {
  return parse_initial_order(text) ? "" : expected(text, kOrderNames);
}

std::string check_objective(const std::string& text) {
  return parse_objective(text) ? "" : expected(text, "flowtime, makespan, or two weights such as 1:20");
}

std::string check_improve(const std::string& text) {
  return parse_improve_budget(text)
             ? ""
             : expected(text, "seconds > 0, such as 30s, or iterations > 0, such as 500i");
}

double parse_time_limit_s(std::string_view text) {
  if (text == "inf" || text == "infinity") return std::numeric_limits<double>::infinity();
  return parse_real(text).value_or(0);
}

std::string check_time_limit(const std::string& text) {
  return parse_time_limit_s(text) > 0 ? "" : expected(text, "a number of seconds > 0, or inf");
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

void InstanceFlags::add_to(CLI::App& command) {
  command.add_option("--instance", files_.instance,
                     "instance in one file (XML, or a .scen that names its map)");
  command.add_option("--map", files_.map, "map (XML or MovingAI .map)");
  command.add_option("--task", files_.task, "agents (XML or MovingAI .scen)");
  command.add_option("--config", files_.config, "planner options (XML); flags here go before them");
  command.add_option("--obstacles", files_.obstacles, "dynamic obstacles (XML)");
  command.add_option("--agents", files_.agents, "only the first N agents");
  command.add_flag("--allow-unreachable", files_.allow_unreachable,
                   "take instances in which a goal cannot be reached");
}

Expected<LoadedInstance, std::string> InstanceFlags::load() const {
  if (!files_.instance && !files_.task) {
    return Unexpected{
        std::string("sipplab: no instance given, expected --instance FILE, or --map FILE --task FILE")};
  }
  Input<LoadedInstance> loaded = load_instance(files_);
  if (!loaded) return Unexpected{loaded.error().message()};
  for (const std::string& warning : loaded->warnings) diagnose("warning: " + warning);
  return std::move(*loaded);
}

void MotionFlags::add_to(CLI::App& command) {
  add_yes_or_no(command, "--turns,!--no-turns", turns_, "robots have headings, and turning takes time");
  const auto add_margin = [&command](const char* name, std::optional<double>& margin, const char* unit,
                                     const char* words) {
    command.add_option(name, margin, words)->check(real_between(0, kMaxMotionMargin))->type_name(unit);
  };
  add_margin("--wait-before-move", wait_before_move_s_, "S", "seconds that a robot stands before each move");
  add_margin("--inflate-distance", inflate_distance_cells_, "CELLS",
             "cells that a moving robot stays away beyond the radii; inflatecollisionintervals of files");
  add_margin("--inflate-time", inflate_time_s_, "S",
             "seconds in which nobody is where another one was or will be");
}

void MotionFlags::apply_to(MotionRules& rules) const {
  if (turns_) rules.turns = *turns_;
  if (wait_before_move_s_) rules.wait_before_move_s = *wait_before_move_s_;
  if (inflate_distance_cells_) rules.inflate_distance_cells = *inflate_distance_cells_;
  if (inflate_time_s_) rules.inflate_time_s = *inflate_time_s_;
}

void PlannerFlags::add_to(CLI::App& command) {
  command
      .add_option("--ssi", ssi_,
                  "start-safe interval in seconds, or inf; of several, 5,9,15, each is tried when the one "
                  "before it fails")
      ->delimiter(',')
      ->check(check_ssi)
      ->type_name("K,...");
  command.add_option("--reschedule", reschedule_, kRescheduleNames)
      ->check(check_reschedule)
      ->type_name("RULE");
  command.add_option("--order", order_, "first priority order: " + std::string(kOrderNames))
      ->check(check_order)
      ->type_name("ORDER");
  command.add_option("--connectedness", connectedness_, "2^k neighbours")
      ->check(CLI::Range(kMinConnectedness, kMaxConnectedness))
      ->type_name("2..5");
  add_any_angle_flag(command, any_angle_);
  command.add_option("--weight", weight_, kWeightWords)->check(real_between(1, kMaxWeight))->type_name("W");
  command.add_option("--seed", seed_, "of random orders")->check(CLI::Range(std::uint64_t{0}, kMaxSeed));
  command.add_option("--time-limit", time_limit_, "wall-clock seconds, or inf")
      ->check(check_time_limit)
      ->type_name("S");
  command.add_option("--max-expansions", max_expansions_, "nodes expanded, over all tries");
  command.add_option("--max-restarts", max_restarts_, "tries after the first");
  add_method_flags(command, method_, fallback_);
  motion_.add_to(command);
}

void PlannerFlags::apply_to(PlannerOptions& options) const {
  if (!ssi_.empty()) options.ssi_s = parse_ssi(ssi_.front()).value_or(options.ssi_s);
  if (reschedule_) options.rescheduling = parse_rescheduling(*reschedule_).value_or(options.rescheduling);
  if (order_) options.order = parse_initial_order(*order_).value_or(options.order);
  if (connectedness_) options.connectedness = *connectedness_;
  if (any_angle_) options.any_angle = *any_angle_;
  if (weight_) options.weight = *weight_;
  if (seed_) options.seed = *seed_;
  if (time_limit_) options.time_limit_s = parse_time_limit_s(*time_limit_);
  if (max_expansions_) options.max_expansions = *max_expansions_;
  if (max_restarts_) options.max_restarts = *max_restarts_;
  if (method_) options.method = parse_method(*method_).value_or(options.method);
  if (fallback_) options.fallback = parse_fallback(*fallback_).value_or(options.fallback);
  motion_.apply_to(options.rules);
}

std::optional<std::string> beyond_complete(const Instance& instance, const PlannerOptions& options) {
  const bool asked_for = options.method == Method::kComplete || options.fallback == Fallback::kComplete;
  if (!asked_for) return std::nullopt;
  const std::optional<InstanceError> error = find_beyond_complete(instance, options.rules);
  if (!error) return std::nullopt;
  return error->what + ", expected " + error->expected;
}

std::vector<double> PlannerFlags::longer_ssi_s() const {
  std::vector<double> longer_s;
  for (std::size_t i = 1; i < ssi_.size(); ++i) longer_s.push_back(parse_ssi(ssi_[i]).value_or(0));
  return longer_s;
}

void ImproveFlags::add_to(CLI::App& command) {
  command
      .add_option("--improve", budget, "improve the plan for so many seconds (30, 30s) or iterations (500i)")
      ->check(check_improve)
      ->type_name("SECONDS|ITERATIONSi");
  command
      .add_option("--objective", objective,
                  "what improvement minimises: flowtime, makespan, or weights of both, such as 1:20")
      ->check(check_objective)
      ->capture_default_str()
      ->type_name("WHAT");
  command
      .add_option("--threads", threads,
                  "of improvement; so many iterations give the same plan on any number of threads")
      ->check(CLI::Range(1U, kMostThreads))
      ->capture_default_str()
      ->type_name("N");
}

bench::Refinement ImproveFlags::refinement(bool best) const {
  bench::Refinement refinement;
  refinement.best = best;
  if (budget) refinement.improve = parse_improve_budget(*budget);
  refinement.objective = parse_objective(objective).value_or(Objective{});
  refinement.threads = threads;
  return refinement;
}

void add_any_angle_flag(CLI::App& command, std::optional<bool>& any_angle) {
  add_yes_or_no(command, "--any-angle,!--no-any-angle", any_angle, "straight moves between any two cells");
}

void add_method_flags(CLI::App& command, std::optional<std::string>& method,
                      std::optional<std::string>& fallback) {
  command.add_option("--method", method, "who plans: " + std::string(kMethodNames))
      ->check([](const std::string& text) { return parse_method(text) ? "" : expected(text, kMethodNames); })
      ->type_name("METHOD");
  command
      .add_option("--fallback", fallback,
                  "who plans where that failed or met a limit: " + std::string(kFallbackNames))
      ->check(
          [](const std::string& text) { return parse_fallback(text) ? "" : expected(text, kFallbackNames); })
      ->type_name("METHOD");
}

void PictureFlags::add_to(CLI::App& command, const std::string& words) {
  CLI::Option* svg = command.add_option("--svg", file, words)->type_name("FILE");
  command
      .add_option("--animate", animate_,
                  "a picture that moves, so many seconds of the plan in one of its own")
      ->needs(svg)
      ->check(check_positive_real)
      ->type_name("SPEED");
}

double PictureFlags::animation_speed() const { return animate_ ? parse_real(*animate_).value_or(1) : 0; }

void add_database_flag(CLI::App& command, std::optional<std::string>& path) {
  command.add_option("--db", path, "history file; default $SIPPLAB_DB, else ./sipplab.db")->type_name("FILE");
}

}  // namespace sipplab::cli
