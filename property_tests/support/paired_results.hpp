// Pairs of results, drawn: of a base and a head that differ here and there.
#pragma once

#include <vector>

#include "db/comparisons.hpp"

namespace sipplab::bench {

/// A result of any status, mostly solved.
db::ResultRow any_row();

/// Nearly as the other.
db::ResultRow changed(db::ResultRow row);

/// Up to three cells of up to twelve results, some of one instance; one side's flowtimes may be longer
/// everywhere.
std::vector<db::PairedCell> any_cells();

}  // namespace sipplab::bench
