// The reproduction for people: tables as text, and one page with the figure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/present/chart.hpp"
#include "bench/present/paper.hpp"

namespace sipplab::bench {

/// Table 1 beside the paper's, and each claim with its verdict.
std::string reproduction_text(const std::vector<MeasuredCell>& cells);

/// The same for programs: "run", "reproduced", and arrays "cells" (as measured), "table1" (beside the
/// paper, with the standing of each figure) and "claims" ("holds" is null if nothing was measured).
nlohmann::ordered_json reproduction_json(const std::vector<MeasuredCell>& cells, const std::string& run);

/// Success over the number of robots, one line for each start-safe interval. `source` of the captions says
/// which run it is, see run_words().
Chart figure_chart(const std::vector<MeasuredCell>& cells, const std::string& source);

/// Mean seconds over the number of robots in the warehouse, one line for each order and
/// re-scheduling; dashed: the paper's, from another machine.
Chart table_chart(const std::vector<MeasuredCell>& cells, const std::string& source);

/// An HTML page that needs nothing else; `source` says which run of which build it shows, the charts are
/// those of the figure and the table. Errors: as pictures_of().
Expected<std::string, std::string> reproduction_page(const std::vector<MeasuredCell>& cells,
                                                     const std::string& source,
                                                     const std::vector<Chart>& charts);

/// Whether nothing that was measured differs from the paper and every claim that could be
/// checked holds.
bool is_reproduced(const std::vector<MeasuredCell>& cells);

}  // namespace sipplab::bench
