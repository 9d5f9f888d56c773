// What `sipplab compare` prints.
#pragma once

#include <cstddef>
#include <string>

#include "bench/judge/compare.hpp"

namespace sipplab::bench {

/// Where the two sides come from, and how much of it is shown.
struct CompareReport {
  const db::ComparisonSide& base;
  const db::ComparisonSide& head;
  const CompareResult& result;
  std::size_t listed = 10;  ///< flips, and other differences, that text and Markdown show
};

std::string compare_text(const CompareReport& report);
/// For a comment on a pull request.
std::string compare_markdown(const CompareReport& report);
/// Everything, whatever `listed` says.
std::string compare_json(const CompareReport& report);
std::string compare_junit(const CompareReport& report);

}  // namespace sipplab::bench
