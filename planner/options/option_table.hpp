// One row for each option of the planner. Command line, XML, JSON, fuzz cases, commands that plan again and
// the columns of the history are all made from these rows: a new option is a member of PlannerOptions and a
// row.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sipplab/options.hpp"

namespace sipplab {

enum class OptionGroup { kPlanner, kMotion, kLimits, kImprovement };
/// How an option is written in a format that tells texts, numbers and truth values apart.
enum class OptionKind { kYesNo, kNumber, kCount, kWord };

struct Option {
  const char* name = "";   ///< "max-expansions": of the flag, and of the line in a fuzz case
  const char* value = "";  ///< stands for the value in help: "S"
  std::string help = {};   ///< one line
  OptionGroup group = OptionGroup::kPlanner;
  const char* xml = "";      ///< element of <algorithm>; empty: not in XML
  const char* json = "";     ///< key of a solution; empty: not in JSON
  const char* column = "";   ///< of the history's cases; empty: kept under its key in JSON, if it has one
  bool always_told = false;  ///< written although it has its default
  bool is_list = false;      ///< takes several values, with commas between
  /// Words of ours and those that published files have for them. The first pair is written.
  std::vector<std::pair<std::string_view, std::string_view>> published = {};

  // Made from the member and its bounds.
  OptionKind kind = OptionKind::kWord;
  std::string expected = {};  ///< end of a message about a wrong value: "a number from 1 to 100"
  /// The value as text, "yes" or "no" of a choice between these.
  std::function<std::string(const PlannerOptions&)> get = {};
  /// Takes what get() writes, and true, false, 1, 0 for a choice. False, and nothing is changed, if the
  /// text is no value of this option.
  std::function<bool(PlannerOptions&, std::string_view)> set = {};
};

using OptionRows = std::span<const Option>;
/// In the order in which they are shown and written.
OptionRows option_rows();
/// None if there is no such option.
const Option* find_option(std::string_view name, OptionRows rows = option_rows());

/// Whether the option has another value than by default.
bool differs(const Option& option, const PlannerOptions& options);
/// Whether it is written: it differs, or is told always.
inline bool is_told(const Option& option, const PlannerOptions& options) {
  return option.always_told || differs(option, options);
}
/// Whether set() would take the text.
bool takes(const Option& option, std::string_view text);

/// The word of published files for a text of ours, and the other way round; the same text if there is
/// none.
std::string published_text(const Option& option, std::string_view text);
std::string text_of_published(const Option& option, std::string_view published);

/// Values of an option, as texts: those of a flag that was given, or a dimension of a sweep.
struct OptionValues {
  const Option* option = nullptr;
  std::vector<std::string> texts;
};

}  // namespace sipplab
