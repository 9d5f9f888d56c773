// What `sipplab compare` and `sipplab gate` print: one report, as text, Markdown, JSON or JUnit's XML.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/judge/judgement.hpp"
#include "bench/judge/text_table.hpp"

namespace sipplab::bench {

/// A judgement, and what only its command knows.
struct Report {
  const Judgement& judgement;
  std::string command;  ///< "sipplab compare", "sipplab gate"
  std::string base;     ///< of a side, one line
  std::string head;
  nlohmann::ordered_json details = {};  ///< members of the JSON document, beside those of the judgement
  std::string notes = {};               ///< lines below the tables
  std::string all_findings = {};        ///< where the findings are that are not listed
  std::size_t listed = 10;              ///< findings that text and Markdown show; JSON has all of them
  bool changes_fail = false;            ///< other plans are failures in JUnit's XML, as exit code 5 is
};

std::string report_text(const Report& report);
/// For a comment on a pull request.
std::string report_markdown(const Report& report);
std::string report_json(const Report& report);
std::string report_junit(const Report& report);

/// "REGRESSED: flowtime +14.3 % ...": loud where something is to be done.
std::string headline(const Judgement& judgement);

/// Heading, cells, and all of them together; beside times of processes only cells in which something differs.
/// `times`: with those of sweeps, which did not run in turn.
std::vector<TextRow> behaviour_table(const Judgement& judgement, bool times = true);

/// One row as JSON; logarithms as ratios less one.
nlohmann::ordered_json difference_json(const Judgement& judgement, const Difference& row);

/// "+3.10 %", "-0.20 %": from a logarithm, with `digits` decimals; "-" if it is not finite.
std::string percent_more(double log_ratio, int digits = 2);

}  // namespace sipplab::bench
