// What Andreychuk and Yakovlev report (AAMAS 2018, pages 2177 ff.: Figure 1, Table 1 and the
// sentences about them) beside what a recorded run of the same cells gave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "db/error.hpp"

namespace sipplab::bench {

/// All runs of one cell of the paper's: every instance, seed and repetition.
struct MeasuredCell {
  std::string environment;  ///< "empty" or "warehouse"
  std::int64_t robots = 0;
  double ssi_s = 0;
  std::string reschedule;
  std::string order;
  std::int64_t runs = 0;
  std::int64_t solved = 0;
  double mean_seconds = 0;  ///< over all runs, as the paper has it
  /// Over solved runs; missing where there is none.
  std::optional<double> mean_makespan_s;
  std::optional<double> mean_flowtime_s;
  /// Half the width of the 95 % interval of the mean, over instances; infinite below five.
  double makespan_error_s = 0;
  double flowtime_error_s = 0;

  double success() const { return runs == 0 ? 0 : static_cast<double>(solved) / static_cast<double>(runs); }
};

/// The cells of a run, by environment, method, start-safe interval and robots. Other maps than
/// the paper's are left out.
db::Result<std::vector<MeasuredCell>> measured_cells(const std::filesystem::path& database,
                                                     const std::string& run);

/// One line of Table 1: warehouse, start-safe interval 5, shortest first.
struct PaperRow {
  std::int64_t robots = 0;
  const char* reschedule = "";
  double success = 0;
  std::optional<double> seconds = {};
  std::optional<double> makespan_s = {};
  std::optional<double> flowtime_s = {};
};
const std::vector<PaperRow>& paper_table();

/// How a figure of ours stands to the paper's, which was measured on other instances. It is
/// reproduced where its 95 % interval holds the paper's, and a flowtime within kFlowtimeShare
/// or a makespan within kMakespanShare of the paper's as well; else it is better or it differs.
enum class Standing { kReproduced, kBetter, kDiffers, kNotMeasured };
std::string_view name(Standing standing);
inline constexpr double kFlowtimeShare = 0.01;
inline constexpr double kMakespanShare = 0.03;

struct TableLine {
  PaperRow paper;
  std::optional<MeasuredCell> measured;
  Standing success = Standing::kNotMeasured;
  Standing makespan = Standing::kNotMeasured;
  Standing flowtime = Standing::kNotMeasured;
};
std::vector<TableLine> compare_with_table(const std::vector<MeasuredCell>& cells);

/// A sentence of the paper, checked.
struct Claim {
  std::string id;        ///< "fig1-a"
  std::string sentence;  ///< in our words
  /// Missing where the cells that it speaks of were not measured.
  std::optional<bool> holds;
  std::string figures;  ///< that decided
};
std::vector<Claim> check_claims(const std::vector<MeasuredCell>& cells);

}  // namespace sipplab::bench
