// <algorithm> and <options>: see xml_options.hpp.
#include "planner/io/xml_options.hpp"

#include <limits>
#include <map>

namespace sipplab {
namespace {

using pugi::xml_node;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();

constexpr NumberRange kSsis{0, kMaxSsiS, "seconds from 0 to 1e7, or infinity"};
constexpr NumberRange kTimeLimits{0, kLargest, "seconds above 0, or -1 for no limit", false};
constexpr NumberRange kWeights{1, kMaxWeight, "a number from 1 to 100"};
constexpr NumberRange kDelays{0, kMaxMotionMargin, "seconds from 0 to 100"};
constexpr NumberRange kInflations{0, kMaxMotionMargin, "cells from 0 to 100"};
constexpr NumberRange kLogLevels{0, 2, "0, 1 or 2"};

template <class T>
T read_word(XmlReader& reader, xml_node node, const std::map<std::string_view, T>& words) {
  const std::string text = XmlReader::text_of(node);
  const auto found = words.find(trimmed(text));
  if (found != words.end()) return found->second;
  std::string expected;
  for (const auto& word : words) expected += (expected.empty() ? "" : ", ") + std::string(word.first);
  reader.fail(node, "<" + std::string(node.name()) + "> " + in_quotes(trimmed(text)), "one of " + expected);
  return {};
}

void read_algorithm(XmlReader& reader, xml_node node, FileOptions& options) {
  static const std::map<std::string_view, InitialOrder> kOrders = {
      {"fifo", InitialOrder::kFifo},
      {"shortest_first", InitialOrder::kShortestFirst},
      {"longest_first", InitialOrder::kLongestFirst},
      {"random", InitialOrder::kRandom}};
  static const std::map<std::string_view, Rescheduling> kReschedulings = {
      {"no", Rescheduling::kNone},
      {"none", Rescheduling::kNone},
      {"rulebased", Rescheduling::kDeterministic},
      {"deterministic", Rescheduling::kDeterministic},
      {"random", Rescheduling::kRandom},
      {"ejection", Rescheduling::kEjection}};
  // The last line: settings of older dialects that leave nothing to choose here.
  reader.expect_only_children(
      node, {"allowanyangle", "connectedness", "rescheduling", "startsafeinterval", "prioritization",
             "timelimit", "planforturns", "waitbeforemove", "inflatecollisionintervals", "weight",
             "inflatecollisiontime",  // of this project alone
             "metrictype", "breakingties", "hweight", "constraints_type"});

  if (const xml_node child = reader.only_child(node, "allowanyangle")) {
    options.any_angle = reader.boolean_text(child);
  }
  if (const xml_node child = reader.only_child(node, "connectedness")) {
    options.connectedness = reader.integer_text(child);
    if (*options.connectedness < 2 || *options.connectedness > 5) {
      reader.fail(child, "<connectedness> " + in_quotes(trimmed(XmlReader::text_of(child))), "2, 3, 4 or 5");
    }
  }
  if (const xml_node child = reader.only_child(node, "weight")) {
    options.weight = reader.real_text(child, kWeights);
  }
  if (const xml_node child = reader.only_child(node, "rescheduling")) {
    options.rescheduling = read_word(reader, child, kReschedulings);
  }
  if (const xml_node child = reader.only_child(node, "prioritization")) {
    options.order = read_word(reader, child, kOrders);
  }
  const auto is_word = [](xml_node child, std::string_view word) {
    return trimmed(XmlReader::text_of(child)) == word;
  };
  if (const xml_node child = reader.only_child(node, "startsafeinterval")) {
    options.ssi_s =
        is_word(child, "infinity") || is_word(child, "inf") ? kInfinity : reader.real_text(child, kSsis);
  }
  if (const xml_node child = reader.only_child(node, "timelimit")) {
    const bool unlimited = is_word(child, "-1") || is_word(child, "infinity");
    options.time_limit_s = unlimited ? kInfinity : reader.real_text(child, kTimeLimits);
  }
  if (const xml_node child = reader.only_child(node, "planforturns")) {
    options.turns = reader.boolean_text(child);
  }
  if (const xml_node child = reader.only_child(node, "waitbeforemove")) {
    options.wait_before_move_s = reader.real_text(child, kDelays);
  }
  if (const xml_node child = reader.only_child(node, "inflatecollisionintervals")) {
    // Documented as a time; the published planner adds it to the distance (its issue 14).
    options.inflate_distance_cells = reader.real_text(child, kInflations);
  }
  if (const xml_node child = reader.only_child(node, "inflatecollisiontime")) {
    options.inflate_time_s = reader.real_text(child, kDelays);
  }
}

}  // namespace

std::optional<OptionsPart> read_options(XmlReader& reader) {
  const xml_node algorithm = reader.only_child(reader.root(), "algorithm");
  const xml_node options = reader.only_child(reader.root(), "options");
  if (!algorithm && !options) return std::nullopt;
  OptionsPart part;
  part.line = reader.line(algorithm ? algorithm : options);
  read_algorithm(reader, algorithm, part.options);
  reader.expect_only_children(options, {"loglevel", "logpath", "logfilename", "logname"},
                              XmlReader::Others::kIgnored);
  if (const xml_node child = reader.only_child(options, "loglevel")) {
    part.options.log_level = reader.real_text(child, kLogLevels);
  }
  return part;
}

}  // namespace sipplab
