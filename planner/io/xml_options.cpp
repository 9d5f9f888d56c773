// <algorithm> and <options>: see xml_options.hpp.
#include "planner/io/xml_options.hpp"

namespace sipplab {
namespace {

using pugi::xml_node;

constexpr NumberRange kLogLevels{0, 2, "0, 1 or 2"};

/// Settings of older dialects that leave nothing to choose here.
constexpr const char* kPassedOver[] = {"metrictype", "breakingties", "hweight", "constraints_type"};

void read_algorithm(XmlReader& reader, xml_node node, StatedOptions& stated, OptionRows rows) {
  std::vector<std::string_view> known(std::begin(kPassedOver), std::end(kPassedOver));
  for (const Option& option : rows) {
    if (*option.xml != '\0') known.emplace_back(option.xml);
  }
  reader.expect_only_children(node, known);
  for (const Option& option : rows) {
    if (*option.xml == '\0') continue;
    const xml_node child = reader.only_child(node, option.xml);
    if (!child) continue;
    const std::string all = XmlReader::text_of(child);
    const std::string_view text = trimmed(all);
    if (stated.state(option, text_of_published(option, text))) continue;
    reader.fail(child, "<" + std::string(option.xml) + "> " + in_quotes(text), option.expected);
  }
}

}  // namespace

std::optional<OptionsPart> read_options(XmlReader& reader, OptionRows rows) {
  const xml_node algorithm = reader.only_child(reader.root(), "algorithm");
  const xml_node options = reader.only_child(reader.root(), "options");
  if (!algorithm && !options) return std::nullopt;
  OptionsPart part;
  part.line = reader.line(algorithm ? algorithm : options);
  read_algorithm(reader, algorithm, part.options, rows);
  reader.expect_only_children(options, {"loglevel", "logpath", "logfilename", "logname"},
                              XmlReader::Others::kIgnored);
  if (const xml_node child = reader.only_child(options, "loglevel")) reader.real_text(child, kLogLevels);
  return part;
}

}  // namespace sipplab
