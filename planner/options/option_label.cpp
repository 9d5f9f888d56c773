#include "planner/options/option_label.hpp"

#include <algorithm>
#include <iterator>

namespace sipplab {
namespace {

/// Columns of a case that distinguish cases in addition to the label.
constexpr std::string_view kToldBeside[] = {
    "ssi", "order", "reschedule", "seed", "max-expansions", "max-restarts", "time-limit"};

bool is_in_label(const Option& option) {
  const bool beside =
      std::find(std::begin(kToldBeside), std::end(kToldBeside), option.name) != std::end(kToldBeside);
  return !beside && *option.json != '\0';
}

}  // namespace

std::string label_of(const PlannerOptions& options, OptionRows rows) {
  std::string label = "sipplab";
  for (const Option& option : rows) {
    if (!is_in_label(option) || !differs(option, options)) continue;
    label.append(" ").append(option.name).append(":").append(option.get(options));
  }
  return label;
}

}  // namespace sipplab
