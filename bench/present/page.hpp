// The report as one HTML page that needs nothing else: no scripts, no fonts, no pictures
// from elsewhere.
#pragma once

#include <string>
#include <vector>

#include "bench/present/density.hpp"
#include "bench/present/report_data.hpp"

namespace sipplab::bench {

/// Errors: as pictures_of().
Expected<std::string, std::string> report_page(const ReportData& data,
                                               const std::vector<DensityChart>& charts);

}  // namespace sipplab::bench
