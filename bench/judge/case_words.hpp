// Names of cases for people, as short as tells them apart.
#pragma once

#include <string>
#include <vector>

#include "db/records.hpp"

namespace sipplab::bench {

/// "warehouse, 64 robots" for each case, and after it what is not the same in all of them:
/// ", ssi 5, deterministic". One case alone is described in full. Cases that would have one name then are
/// told apart by their limits, instances and bodies.
std::vector<std::string> case_words(const std::vector<db::CaseInfo>& cases);

}  // namespace sipplab::bench
