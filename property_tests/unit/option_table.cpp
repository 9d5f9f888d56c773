// The table of options: what is written is read back, and one more row is found wherever options are written.
#include "planner/options/option_table.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "planner/io/case_codec.hpp"
#include "planner/io/json_options.hpp"
#include "planner/io/write_xml.hpp"
#include "planner/io/xml_options.hpp"

namespace sipplab {
namespace {

/// Another value than by default, of each option.
const std::pair<const char*, const char*> kOtherValues[] = {
    {"ssi", "2.5,inf"},
    {"order", "longest"},
    {"reschedule", "random"},
    {"any-angle", "no"},
    {"connectedness", "3"},
    {"weight", "1.25"},
    {"turns", "yes"},
    {"wait-before-move", "0.5"},
    {"inflate-distance", "0.25"},
    {"inflate-time", "0.125"},
    {"seed", "18446744073709551615"},
    {"max-expansions", "7"},
    {"max-restarts", "0"},
    {"time-limit", "inf"},
    {"method", "complete"},
    {"fallback", "complete"},
    {"best", "yes"},
    {"improve", "500i"},
    {"objective", "1:20"},
    {"threads", "4"},
};

PlannerOptions other_options() {
  PlannerOptions options;
  for (const auto& [name, text] : kOtherValues) EXPECT_TRUE(find_option(name)->set(options, text)) << name;
  return options;
}

/// What XML and JSON keep: the number of threads is the machine's.
PlannerOptions without_threads(PlannerOptions options) {
  options.threads = 1;
  return options;
}

std::string written(const PlannerOptions& options, OptionRows rows = option_rows()) {
  pugi::xml_document document;
  add_options(document.append_child("root"), options, rows);
  std::ostringstream text;
  document.save(text);
  return text.str();
}

Input<StatedOptions> read_xml(const std::string& text, OptionRows rows = option_rows()) {
  Input<std::unique_ptr<XmlReader>> reader = XmlReader::parse(text, "f");
  if (!reader) return Unexpected{reader.error()};
  const std::optional<OptionsPart> part = read_options(**reader, rows);
  if ((*reader)->failed()) return Unexpected{(*reader)->error()};
  EXPECT_TRUE((*reader)->take_warnings().empty());
  return part->options;
}

TEST(OptionTable, EachRowHasNamesOfItsOwn) {
  std::set<std::string> names, elements, keys, columns;
  for (const Option& option : option_rows()) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_TRUE(*option.xml == '\0' || elements.insert(option.xml).second) << option.xml;
    EXPECT_TRUE(*option.json == '\0' || keys.insert(option.json).second) << option.json;
    EXPECT_TRUE(*option.column == '\0' || columns.insert(option.column).second) << option.column;
    EXPECT_FALSE(option.help.empty() || option.expected.empty()) << option.name;
  }
}

TEST(OptionTable, WhatARowWritesItReads) {
  const PlannerOptions other = other_options();
  PlannerOptions copy;
  EXPECT_EQ(option_rows().size(), std::size(kOtherValues));
  for (const auto& [name, text] : kOtherValues) {
    const Option& option = *find_option(name);
    EXPECT_EQ(option.get(other), text);
    EXPECT_TRUE(differs(option, other)) << name;
    EXPECT_FALSE(differs(option, {})) << name;
    EXPECT_TRUE(option.set(copy, option.get(other)));
    EXPECT_TRUE(takes(option, option.get({}))) << name;
  }
  EXPECT_EQ(copy, other);
}

TEST(OptionTable, AWrongTextChangesNothing) {
  const std::pair<const char*, const char*> wrong[] = {
      {"ssi", "5,,9"},         {"ssi", "-1"},          {"ssi", "1e8"},
      {"ssi", "nan"},          {"connectedness", "6"}, {"connectedness", "2.5"},
      {"weight", "0.5"},       {"weight", "inf"},      {"turns", "maybe"},
      {"inflate-time", "101"}, {"seed", "-1"},         {"max-restarts", "1e3"},
      {"time-limit", "0"},     {"time-limit", "nan"},  {"method", "greedy"},
      {"improve", "0i"},       {"objective", "0:0"},   {"threads", "0"},
      {"threads", "65"}};
  for (const auto& [name, text] : wrong) {
    PlannerOptions options;
    EXPECT_FALSE(find_option(name)->set(options, text)) << name << ' ' << text;
    EXPECT_EQ(options, PlannerOptions{});
  }
}

TEST(OptionTable, XmlAndJsonKeepEachOption) {
  const PlannerOptions other = without_threads(other_options());
  const std::string xml = written(other);
  EXPECT_NE(xml.find("<rescheduling>random</rescheduling>"), std::string::npos);
  EXPECT_NE(xml.find("<timelimit>-1</timelimit>"), std::string::npos) << "in words of published files";
  const Input<StatedOptions> stated = read_xml(xml);
  ASSERT_TRUE(stated) << stated.error().message();
  EXPECT_EQ(stated->applied_to({}), other);
  PlannerOptions read;
  for (const Option& option : option_rows()) {
    const auto value = nlohmann::json::parse(option_to_json(option, other));
    EXPECT_TRUE(option_from_json(option, value, read)) << option.name;
  }
  EXPECT_EQ(read, other);
}

TEST(OptionTable, ACaseKeepsEachOptionButWallClockAndThreads) {
  PlanCase plan_case{{}, without_threads(other_options())};
  plan_case.instance.map = GridMap(1, 1);
  const auto read = decode_case(encode_case(plan_case));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->options, plan_case.options);
  EXPECT_FALSE(decode_case(".\ntime-limit 5\n"));
  EXPECT_FALSE(decode_case(".\nthreads 2\n"));
}

/// An option that is nowhere but in its row.
double patience = 0;

Option imaginary() {
  Option option;
  option.name = "patience";
  option.xml = "patience";
  option.json = "patience";
  option.column = "patience_s";
  option.kind = OptionKind::kNumber;
  option.expected = "a number";
  option.get = [](const PlannerOptions&) { return format_ssi(patience); };
  option.set = [](PlannerOptions&, std::string_view text) {
    const std::optional<double> value = parse_ssi(text);
    if (value) patience = *value;
    return value.has_value();
  };
  return option;
}

TEST(OptionTable, OneMoreRowIsFoundInXmlJsonAndCases) {
  std::vector<Option> rows(option_rows().begin(), option_rows().end());
  rows.push_back(imaginary());
  rows.back().always_told = true;
  patience = 2.5;
  const std::string xml = written({}, rows);
  const std::string json = option_to_json(rows.back(), {});
  PlanCase plan_case;
  plan_case.instance.map = GridMap(1, 1);
  const std::string text = encode_case(plan_case, rows);
  for (const std::string& shown : {xml, json, text}) {
    EXPECT_NE(shown.find("2.5"), std::string::npos) << shown;
  }

  patience = 0;
  EXPECT_TRUE(read_xml(xml, rows)->applied_to({}) == PlannerOptions{} && patience == 2.5);
  patience = 0;
  PlannerOptions options;
  EXPECT_TRUE(option_from_json(rows.back(), nlohmann::json::parse(json), options) && patience == 2.5);
  patience = 0;
  EXPECT_TRUE(decode_case(text, rows) && patience == 2.5);
  EXPECT_FALSE(decode_case(text)) << "the table has no such row";
  EXPECT_EQ(read_xml("<root><algorithm><patience>x</patience></algorithm></root>", rows).error().message(),
            "f:1: <patience> 'x', expected a number");
}

}  // namespace
}  // namespace sipplab
