// The command that plans one instance of the history again.
#pragma once

#include <string>

#include "db/records.hpp"
#include "planner/options/option_table.hpp"

namespace sipplab::bench {

/// " --ssi 5 --order shortest --weight 1.05": the flags of `sipplab plan` for options, each that is told.
std::string option_flags(const PlannerOptions& options, OptionRows rows = option_rows());

/// "sipplab generate ... && sipplab plan ..." for an instance that was generated, "sipplab plan
/// --instance ..." for one that was read from a file; of another program's case, the words that say
/// which file to give it. `instance_name` is the history's.
std::string replay_command(const db::CaseInfo& parameters, const std::string& instance_name);

}  // namespace sipplab::bench
