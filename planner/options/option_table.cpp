// The table of options; see option_table.hpp.
#include "planner/options/option_table.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "planner/core/number.hpp"

namespace sipplab {
namespace {

template <class Value>
using Names = std::vector<std::pair<Value, std::string_view>>;

const Names<InitialOrder>& names_of(InitialOrder) {
  static const Names<InitialOrder> names = {{InitialOrder::kFifo, "fifo"},
                                            {InitialOrder::kShortestFirst, "shortest"},
                                            {InitialOrder::kLongestFirst, "longest"},
                                            {InitialOrder::kRandom, "random"}};
  return names;
}

const Names<Rescheduling>& names_of(Rescheduling) {
  static const Names<Rescheduling> names = {{Rescheduling::kNone, "none"},
                                            {Rescheduling::kDeterministic, "deterministic"},
                                            {Rescheduling::kRandom, "random"},
                                            {Rescheduling::kEjection, "ejection"}};
  return names;
}

const Names<Method>& names_of(Method) {
  static const Names<Method> names = {{Method::kPrioritized, "prioritized"}, {Method::kComplete, "complete"}};
  return names;
}

const Names<Fallback>& names_of(Fallback) {
  static const Names<Fallback> names = {{Fallback::kNone, "none"}, {Fallback::kComplete, "complete"}};
  return names;
}

template <class Value>
std::string_view name_in(const Names<Value>& names, Value value) {
  for (const auto& [known, text] : names) {
    if (known == value) return text;
  }
  return "unknown";
}

/// Adds what can be told from the member, which `get` refers to, and the way in which a text is read: `read`
/// gives an optional value, `write` a text.
template <class Get, class Read, class Write>
Option row(Option option, OptionKind kind, std::string expected, Get get, Read read, Write write) {
  option.kind = kind;
  option.expected = std::move(expected);
  option.get = [get, write](const PlannerOptions& options) { return std::string(write(get(options))); };
  option.set = [get, read](PlannerOptions& options, std::string_view text) {
    auto value = read(text);
    if (value) get(options) = *value;
    return value.has_value();
  };
  return option;
}

template <class Get>
Option yes_no(Option option, Get get) {
  option.published = {{"yes", "true"}, {"no", "false"}};
  const auto read = [](std::string_view text) -> std::optional<bool> {
    if (text == "yes" || text == "true" || text == "1") return true;
    if (text == "no" || text == "false" || text == "0") return false;
    return std::nullopt;
  };
  return row(std::move(option), OptionKind::kYesNo, "true or false", get, read,
             [](bool value) { return value ? "yes" : "no"; });
}

/// A number in [least, most].
template <class Get>
Option number(Option option, Get get, const std::string& unit, double least, double most) {
  const auto read = [least, most](std::string_view text) {
    std::optional<double> value = parse_ssi(text);
    return value && *value >= least && *value <= most ? value : std::nullopt;
  };
  return row(std::move(option), OptionKind::kNumber,
             unit + " from " + format_ssi(least) + " to " + format_ssi(most), get, read, format_ssi);
}

/// A whole number from `least` to the largest that is asked for.
template <class Get>
Option count(Option option, Get get, std::string expected, std::uint64_t least, std::uint64_t most) {
  using Value = std::decay_t<decltype(get(std::declval<PlannerOptions&>()))>;
  const auto read = [least, most](std::string_view text) -> std::optional<Value> {
    const auto value = parse_number<std::uint64_t>(text);
    if (!value || *value < least || *value > most) return std::nullopt;
    return static_cast<Value>(*value);
  };
  return row(std::move(option), OptionKind::kCount, std::move(expected), get, read,
             [](Value value) { return std::to_string(value); });
}

template <class Get>
Option word(Option option, Get get) {
  using Value = std::decay_t<decltype(get(std::declval<PlannerOptions&>()))>;
  const Names<Value>& names = names_of(Value{});
  std::string expected;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) expected += i + 1 < names.size() ? ", " : " or ";
    expected += names[i].second;
  }
  option.help += ": " + expected;
  const auto read = [&names](std::string_view text) -> std::optional<Value> {
    for (const auto& [value, known] : names) {
      if (known == text) return value;
    }
    return std::nullopt;
  };
  return row(std::move(option), OptionKind::kWord, std::move(expected), get, read,
             [&names](Value value) { return name_in(names, value); });
}

/// Start-safe intervals: the first, and the longer ones after it.
Option intervals(Option option) {
  option.kind = OptionKind::kNumber;
  option.expected = "seconds from 0 to " + format_ssi(kMaxSsiS) + ", or inf";
  option.get = [](const PlannerOptions& options) {
    std::string text = format_ssi(options.ssi_s);
    for (const double longer_s : options.longer_ssi_s) {
      text += ',';
      text += format_ssi(longer_s);
    }
    return text;
  };
  option.set = [](PlannerOptions& options, std::string_view text) {
    std::vector<double> intervals_s;
    for (bool more = true; more;) {
      const std::size_t comma = text.find(',');
      more = comma != std::string_view::npos;
      const std::optional<double> ssi_s = parse_ssi(text.substr(0, comma));
      if (!ssi_s || !is_ssi(*ssi_s)) return false;
      intervals_s.push_back(*ssi_s);
      text.remove_prefix(more ? comma + 1 : text.size());
    }
    options.ssi_s = intervals_s.front();
    options.longer_ssi_s.assign(intervals_s.begin() + 1, intervals_s.end());
    return true;
  };
  return option;
}

constexpr OptionGroup kMotion = OptionGroup::kMotion;
constexpr OptionGroup kLimits = OptionGroup::kLimits;
constexpr OptionGroup kImprovement = OptionGroup::kImprovement;
constexpr const char* kCounts = "a whole number >= 0 of 64 bits";

// clang-format off
#define MEMBER(path) [](auto& options) -> auto& { return options.path; }
std::vector<Option> make_rows() {
  return {
      intervals({.name = "ssi", .value = "K,...",
                 .help = "start-safe interval in seconds, or inf; 5,9,15 tries the next one if one fails",
                 .xml = "startsafeinterval", .json = "ssi", .column = "ssi_s",
                 .always_told = true, .is_list = true, .published = {{"inf", "infinity"}}}),
      word({.name = "order", .value = "ORDER", .help = "initial priority order",
            .xml = "prioritization", .json = "initial_order", .column = "initial_order", .always_told = true,
            .published = {{"shortest", "shortest_first"}, {"longest", "longest_first"}}},
           MEMBER(order)),
      word({.name = "reschedule", .value = "RULE", .help = "how the order changes after a robot fails",
            .xml = "rescheduling", .json = "reschedule", .column = "reschedule", .always_told = true,
            .published = {{"none", "no"}, {"deterministic", "rulebased"}}},
           MEMBER(rescheduling)),
      yes_no({.name = "any-angle", .help = "straight moves between any two cell centres",
              .xml = "allowanyangle", .json = "any_angle", .column = "any_angle", .always_told = true},
             MEMBER(any_angle)),
      count({.name = "connectedness", .value = "2..5", .help = "2^k neighbours of a cell",
             .xml = "connectedness", .json = "connectedness", .column = "connectedness",
             .always_told = true},
            MEMBER(connectedness), "2, 3, 4 or 5", 2, 5),
      number({.name = "weight", .value = "W",
              .help = "weight of the heuristic: 1.05 expands far fewer nodes on large maps",
              .xml = "weight", .json = "weight", .column = "weight"},
             MEMBER(weight), "a number", 1, kMaxWeight),
      yes_no({.name = "turns", .help = "robots have headings; turning takes time", .group = kMotion,
              .xml = "planforturns", .json = "turns", .column = "turns"},
             MEMBER(rules.turns)),
      number({.name = "wait-before-move", .value = "S",
              .help = "seconds to stand before each move", .group = kMotion,
              .xml = "waitbeforemove", .json = "wait_before_move", .column = "wait_before_move_s"},
             MEMBER(rules.wait_before_move_s), "seconds", 0, kMaxMotionMargin),
      // Published as a time; the published planner adds it to the distance (its issue 14).
      number({.name = "inflate-distance", .value = "CELLS",
              .help = "distance that moving robots keep beyond their radii", .group = kMotion,
              .xml = "inflatecollisionintervals", .json = "inflate_distance",
              .column = "inflate_distance_cells"},
             MEMBER(rules.inflate_distance_cells), "cells", 0, kMaxMotionMargin),
      number({.name = "inflate-time", .value = "S",
              .help = "time gap in seconds between occupants of one place", .group = kMotion,
              .xml = "inflatecollisiontime", .json = "inflate_time", .column = "inflate_time_s"},
             MEMBER(rules.inflate_time_s), "seconds", 0, kMaxMotionMargin),
      count({.name = "seed", .value = "N", .help = "seed of random orders",
             .xml = "seed", .json = "seed", .column = "seed", .always_told = true},
            MEMBER(seed), kCounts, 0, UINT64_MAX),
      count({.name = "max-expansions", .value = "N", .help = "limit on expanded nodes, over all tries",
             .group = kLimits,
             .xml = "maxexpansions", .json = "max_expansions", .column = "max_expansions"},
            MEMBER(max_expansions), kCounts, 0, UINT64_MAX),
      count({.name = "max-restarts", .value = "N", .help = "limit on tries after the first", .group = kLimits,
             .xml = "maxrestarts", .json = "max_restarts", .column = "max_restarts"},
            MEMBER(max_restarts), kCounts, 0, UINT64_MAX),
      row({.name = "time-limit", .value = "S", .help = "limit on wall-clock seconds, or inf", .group = kLimits,
           .xml = "timelimit", .json = "time_limit", .column = "time_limit_s", .always_told = true,
           .published = {{"inf", "-1"}}},
          OptionKind::kNumber, "a number of seconds > 0, or inf", MEMBER(time_limit_s),
          [](std::string_view text) {
            const std::optional<double> seconds = parse_ssi(text);
            return seconds > 0 ? seconds : std::nullopt;
          },
          format_ssi),
      word({.name = "method", .value = "METHOD", .help = "planner",
            .xml = "method", .json = "method", .column = "method"},
           MEMBER(method)),
      word({.name = "fallback", .value = "METHOD", .help = "planner to use if the method fails or reaches a limit",
            .xml = "fallback", .json = "fallback", .column = "fallback"},
           MEMBER(fallback)),
      yes_no({.name = "best",
              .help = "best plan within --time-limit (30 s if none): all methods in turn, then improvement",
              .group = kImprovement, .xml = "best", .json = "best", .column = "best"},
             MEMBER(best)),
      row({.name = "improve", .value = "SECONDS|ITERATIONSi",
           .help = "improve the plan for a time (30s) or a number of iterations (500i)",
           .group = kImprovement, .xml = "improve", .json = "improve", .column = "improve"},
          OptionKind::kWord, "seconds > 0, such as 30s, or iterations > 0, such as 500i", MEMBER(improve),
          [](std::string_view text) -> std::optional<std::optional<ImproveBudget>> {
            if (text == "none") return std::optional<ImproveBudget>();
            const std::optional<ImproveBudget> budget = parse_improve_budget(text);
            if (!budget) return std::nullopt;
            return budget;
          },
          [](const std::optional<ImproveBudget>& budget) {
            return budget ? format_improve_budget(*budget) : std::string("none");
          }),
      row({.name = "objective", .value = "WHAT",
           .help = "what improvement minimises: flowtime, makespan, or weights of both (1:20)",
           .group = kImprovement, .xml = "objective", .json = "objective", .column = "objective"},
          OptionKind::kWord, "flowtime, makespan, or two weights such as 1:20", MEMBER(objective),
          parse_objective, format_objective),
      count({.name = "threads", .value = "N",
             .help = "threads of improvement; the plan of a fixed iteration count does not depend on them",
             .group = kImprovement},
            MEMBER(threads), "a whole number from 1 to " + std::to_string(kMostThreads), 1, kMostThreads),
  };
}
#undef MEMBER
// clang-format on

}  // namespace

std::string_view name(InitialOrder order) { return name_in(names_of(order), order); }
std::string_view name(Rescheduling rescheduling) { return name_in(names_of(rescheduling), rescheduling); }
std::string_view name(Method method) { return name_in(names_of(method), method); }
std::string_view name(Fallback fallback) { return name_in(names_of(fallback), fallback); }

OptionRows option_rows() {
  static const std::vector<Option> rows = make_rows();
  return rows;
}

const Option* find_option(std::string_view name, OptionRows rows) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [name](const Option& option) { return name == option.name; });
  return found == rows.end() ? nullptr : &*found;
}

bool differs(const Option& option, const PlannerOptions& options) {
  return option.get(options) != option.get(PlannerOptions{});
}

bool takes(const Option& option, std::string_view text) {
  PlannerOptions scratch;
  return option.set(scratch, text);
}

std::string published_text(const Option& option, std::string_view text) {
  for (const auto& [ours, published] : option.published) {
    if (ours == text) return std::string(published);
  }
  return std::string(text);
}

std::string text_of_published(const Option& option, std::string_view text) {
  for (const auto& [ours, published] : option.published) {
    if (published == text) return std::string(ours);
  }
  return std::string(text);
}

bool StatedOptions::state(const Option& option, std::string_view text) {
  if (!takes(option, text)) return false;
  stated_.emplace_back(&option, text);
  return true;
}

bool StatedOptions::states(std::string_view name) const {
  return std::any_of(stated_.begin(), stated_.end(),
                     [name](const auto& stated) { return name == stated.first->name; });
}

PlannerOptions StatedOptions::applied_to(PlannerOptions options) const {
  for (const auto& [option, text] : stated_) option->set(options, text);
  return options;
}

}  // namespace sipplab
