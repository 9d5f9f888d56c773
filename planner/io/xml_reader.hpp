// A parsed XML text that remembers its lines and the first thing that was wrong
// with it. Seen by the XML readers alone: nothing else includes pugixml.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "planner/io/text.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

/// Numbers that are welcome, and how a message calls them.
struct NumberRange {
  double least = 0;
  double most = 0;
  const char* words = "";
  bool least_is_allowed = true;

  bool contains(double value) const {
    return (least_is_allowed ? value >= least : value > least) && value <= most;
  }
};

/// What every file of the format has around it.
inline constexpr const char* kRootTag = "<root>";

/// The functions that read a value return a harmless one if it is bad and keep
/// the complaint; the first complaint is the one that counts. So a reader can go
/// straight on and look at error() from time to time.
class XmlReader {
 public:
  /// Errors: not well-formed, not one element <root>, text around it.
  static Input<std::unique_ptr<XmlReader>> parse(std::string_view text, const std::string& file_name);

  pugi::xml_node root() const { return root_; }
  int line(pugi::xml_node node) const;
  const std::string& file_name() const { return file_name_; }

  bool failed() const { return error_.has_value(); }
  const InputError& error() const { return *error_; }
  void fail(pugi::xml_node node, std::string what, std::string expected);

  /// "file:line: text". Beyond kMaxWarnings they are only counted.
  void warn(pugi::xml_node node, const std::string& text);
  /// All warnings so far; a last one says how many more there were.
  std::vector<std::string> take_warnings();

  /// What becomes of tags, attributes and text that the reader does not know. Refused if they could change
  /// the problem; reported by a warning if they cannot.
  enum class Others { kRefused, kIgnored };
  /// Looks for children, and text between children, that are not in the list.
  void expect_only_children(pugi::xml_node node, const std::vector<std::string_view>& names,
                            Others others = Others::kRefused);
  void expect_only_attributes(pugi::xml_node node, const std::vector<std::string_view>& names,
                              Others others = Others::kRefused);

  /// The child of this name, or an empty node; a second one is an error.
  pugi::xml_node only_child(pugi::xml_node node, const char* name);
  /// All text directly within the element.
  static std::string text_of(pugi::xml_node node);

  std::int32_t required_integer(pugi::xml_node node, const char* attribute);
  double required_real(pugi::xml_node node, const char* attribute, const NumberRange& range);
  /// Empty if there is no such attribute.
  std::optional<double> optional_real(pugi::xml_node node, const char* attribute, const NumberRange& range);

  /// The element's own text as a number.
  std::int32_t integer_text(pugi::xml_node node);
  double real_text(pugi::xml_node node, const NumberRange& range);
  /// An attribute that is words, kept as they are; empty if there is none. What is no UTF-8 is
  /// an error: JSON could not write it.
  std::string words(pugi::xml_node node, const char* attribute);

 private:
  void report(pugi::xml_node node, std::string what, const std::vector<std::string_view>& names,
              Others others);

  XmlReader(std::string_view text, const std::string& file_name) : lines_(text), file_name_(file_name) {}

  LineTable lines_;
  std::string file_name_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::optional<InputError> error_;
  std::vector<std::string> warnings_;
  std::size_t warnings_left_out_ = 0;
};

}  // namespace sipplab
