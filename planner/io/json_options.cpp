// See json_options.hpp.
#include "planner/io/json_options.hpp"

#include <nlohmann/json.hpp>

namespace sipplab {
namespace {

/// Lists and infinity have no numbers in JSON.
bool is_plain_number(std::string_view text) { return text.find_first_of(",i") == std::string_view::npos; }

}  // namespace

std::string option_to_json(const Option& option, const PlannerOptions& options) {
  const std::string text = option.get(options);
  if (option.kind == OptionKind::kYesNo) return published_text(option, text);
  return option.kind != OptionKind::kWord && is_plain_number(text) ? text : '"' + text + '"';
}

bool option_from_json(const Option& option, const nlohmann::json& value, PlannerOptions& options) {
  if (!value.is_string()) {
    const bool fits = option.kind == OptionKind::kYesNo ? value.is_boolean() : value.is_number();
    return fits && option.kind != OptionKind::kWord && option.set(options, value.dump());
  }
  const std::string text = value.get<std::string>();
  const bool fits =
      option.kind == OptionKind::kNumber ? !is_plain_number(text) : option.kind == OptionKind::kWord;
  return fits && option.set(options, text);
}

}  // namespace sipplab
