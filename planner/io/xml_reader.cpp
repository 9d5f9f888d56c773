// XML with lines and first errors: see xml_reader.hpp.
#include "planner/io/xml_reader.hpp"

#include <algorithm>
#include <limits>

#include "planner/io/text.hpp"

namespace sipplab {
namespace {

constexpr std::int64_t kLeastInteger = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t kMostInteger = std::numeric_limits<std::int32_t>::max();
constexpr const char* kIntegerWords = "an integer";
constexpr const char* kIntegerRangeWords = "an integer between -2147483648 and 2147483647";

/// As many as a person reads; a file in a wrong dialect could give one for each
/// of its elements.
constexpr std::size_t kMaxWarnings = 20;

bool contains(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_text(pugi::xml_node node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

std::string tag(pugi::xml_node node) {
  std::string text = "<";
  text += node.name();
  return text += '>';
}

std::string shown(pugi::xml_node node, const char* attribute, std::string_view value) {
  return std::string(attribute) + " " + in_quotes(value) + " in " + tag(node);
}

/// "Error parsing start element tag" as a part of a sentence.
std::string describe(const pugi::xml_parse_result& result) {
  std::string text = result.description();
  if (!text.empty()) {
    text[0] = static_cast<char>(text[0] >= 'A' && text[0] <= 'Z' ? text[0] - 'A' + 'a' : text[0]);
  }
  return text;
}

}  // namespace

Input<std::unique_ptr<XmlReader>> XmlReader::parse(std::string_view text, const std::string& file_name) {
  text = without_byte_order_mark(text);
  std::unique_ptr<XmlReader> reader(new XmlReader(text, file_name));
  const auto error_at = [&](std::size_t offset, std::string what, std::string expected) {
    return Unexpected{
        InputError{file_name, reader->lines_.line(offset), std::move(what), std::move(expected)}};
  };
  // The parser would take a zero byte for the end of the text.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    return error_at(zero, "a zero byte", "XML as UTF-8 text");
  }
  // As a fragment, so that text around the root element is seen and not skipped.
  constexpr unsigned kFlags = pugi::parse_default | pugi::parse_fragment;
  const pugi::xml_parse_result result =
      reader->document_.load_buffer(text.data(), text.size(), kFlags, pugi::encoding_utf8);
  if (!result) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
    return error_at(std::min(offset, text.size()), "not well-formed XML: " + describe(result),
                    "a complete document");
  }
  for (const pugi::xml_node node : reader->document_.children()) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    if (is_text(node)) {
      const std::string_view value(node.value());
      const std::size_t blanks = std::min(value.find_first_not_of(" \t\r\n"), value.size());
      return error_at(offset + blanks, "text " + in_quotes(trimmed(value)) + " outside of the root element",
                      "none");
    }
    if (node.type() != pugi::node_element) continue;
    if (reader->root_) return error_at(offset, "a second root element " + tag(node), "one");
    reader->root_ = node;
  }
  if (!reader->root_) return error_at(text.size(), "no element", "<root>");
  if (std::string_view(reader->root_.name()) != "root") {
    return error_at(static_cast<std::size_t>(reader->root_.offset_debug()),
                    "root element " + tag(reader->root_), kRootTag);
  }
  return reader;
}

int XmlReader::line(pugi::xml_node node) const {
  return lines_.line(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)));
}

void XmlReader::fail(pugi::xml_node node, std::string what, std::string expected) {
  if (!error_) error_ = InputError{file_name_, line(node), std::move(what), std::move(expected)};
}

void XmlReader::warn(pugi::xml_node node, const std::string& text) {
  if (warnings_.size() < kMaxWarnings) {
    warnings_.push_back(InputError{file_name_, line(node), text, ""}.message());
  } else {
    ++warnings_left_out_;
  }
}

std::vector<std::string> XmlReader::take_warnings() {
  if (warnings_left_out_ > 0) {
    warnings_.push_back(file_name_ + ": " + std::to_string(warnings_left_out_) +
                        " more warnings of this kind");
    warnings_left_out_ = 0;
  }
  return std::move(warnings_);
}

void XmlReader::report(pugi::xml_node node, std::string what, const std::vector<std::string_view>& names,
                       Others others) {
  if (others == Others::kIgnored) return warn(node, what + ", ignored");
  std::string known;
  for (const std::string_view name : names) known += (known.empty() ? "only " : ", ") + std::string(name);
  fail(node, std::move(what), known.empty() ? "none" : known);
}

void XmlReader::expect_only_children(pugi::xml_node node, const std::vector<std::string_view>& names,
                                     Others others) {
  for (const pugi::xml_node child : node.children()) {
    if (is_text(child)) {
      report(child, "text " + in_quotes(trimmed(child.value())) + " in " + tag(node), names, others);
    } else if (child.type() == pugi::node_element && !contains(names, child.name())) {
      report(child, "unknown tag " + tag(child) + " in " + tag(node), names, others);
    }
  }
}

void XmlReader::expect_only_attributes(pugi::xml_node node, const std::vector<std::string_view>& names,
                                       Others others) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    if (contains(names, attribute.name())) continue;
    report(node, "unknown attribute " + in_quotes(attribute.name()) + " in " + tag(node), names, others);
  }
}

pugi::xml_node XmlReader::only_child(pugi::xml_node node, const char* name) {
  const pugi::xml_node child = node.child(name);
  if (const pugi::xml_node second = child.next_sibling(name)) {
    fail(second, "a second " + tag(second) + " in " + tag(node), "one");
  }
  return child;
}

std::string XmlReader::text_of(pugi::xml_node node) {
  std::string text;
  for (const pugi::xml_node child : node.children()) {
    if (is_text(child)) text += child.value();
  }
  return text;
}

std::int32_t XmlReader::required_integer(pugi::xml_node node, const char* attribute) {
  const pugi::xml_attribute value = node.attribute(attribute);
  if (!value) {
    fail(node, std::string("no ") + attribute + " in " + tag(node), "an integer");
    return 0;
  }
  const auto number = parse_integer(value.value());
  if (!number || *number < kLeastInteger || *number > kMostInteger) {
    fail(node, shown(node, attribute, value.value()), number ? kIntegerRangeWords : kIntegerWords);
    return 0;
  }
  return static_cast<std::int32_t>(*number);
}

double XmlReader::required_real(pugi::xml_node node, const char* attribute, const NumberRange& range) {
  if (!node.attribute(attribute)) {
    fail(node, std::string("no ") + attribute + " in " + tag(node), range.words);
  }
  return optional_real(node, attribute, range).value_or(0);
}

std::optional<double> XmlReader::optional_real(pugi::xml_node node, const char* attribute,
                                               const NumberRange& range) {
  const pugi::xml_attribute value = node.attribute(attribute);
  if (!value) return std::nullopt;
  const auto number = parse_real(value.value());
  if (!number || !range.contains(*number)) {
    fail(node, shown(node, attribute, value.value()), range.words);
    return std::nullopt;
  }
  return number;
}

std::int32_t XmlReader::integer_text(pugi::xml_node node) {
  const std::string text = text_of(node);
  const auto number = parse_integer(text);
  if (!number || *number < kLeastInteger || *number > kMostInteger) {
    fail(node, tag(node) + " " + in_quotes(trimmed(text)), number ? kIntegerRangeWords : kIntegerWords);
    return 0;
  }
  return static_cast<std::int32_t>(*number);
}

double XmlReader::real_text(pugi::xml_node node, const NumberRange& range) {
  const std::string text = text_of(node);
  const auto number = parse_real(text);
  if (!number || !range.contains(*number)) {
    fail(node, tag(node) + " " + in_quotes(trimmed(text)), range.words);
    return range.most;
  }
  return *number;
}

std::string XmlReader::words(pugi::xml_node node, const char* attribute) {
  const std::string_view text = node.attribute(attribute).value();
  if (!is_valid_utf8(text)) {
    fail(node, shown(node, attribute, text), "UTF-8 text");
    return "";
  }
  return std::string(text);
}

}  // namespace sipplab
