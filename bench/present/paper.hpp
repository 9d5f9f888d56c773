// What Andreychuk and Yakovlev report (AAMAS 2018, pages 2177 ff.: Figure 1, Table 1 and the
// sentences about them) beside what a recorded run of the same cells gave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/sqlite/error.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::bench {

/// How the planner is called in tables with which the paper was measured.
inline constexpr std::string_view kPaperMethod = "sipplab connectedness:3";

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
  /// Over solved runs; missing if there is none.
  std::optional<double> mean_makespan_s;
  std::optional<double> mean_flowtime_s;
  /// Half the width of the 95 % interval of these means, by the scatter over instances; infinite below
  /// five of them.
  double makespan_error_s = 0;
  double flowtime_error_s = 0;
  /// So many independent runs would tell as much of success: seeds of one instance go together, and ten
  /// of them are between one and ten. None: all runs are independent.
  std::optional<double> independent_runs = {};
  std::string method = std::string(kPaperMethod);  ///< the planner's name in tables
  std::optional<std::int64_t> instances = {};      ///< that were planned. None: another one in each run

  double success() const { return runs == 0 ? 0 : static_cast<double>(solved) / static_cast<double>(runs); }
  /// 95 %, Wilson's.
  db::statistics::ConfidenceInterval success_interval() const;
};

/// Of fewer instances a variance says next to nothing: no cost is judged, and no claim by them.
inline constexpr std::int64_t kFewestInstances = 5;

/// The cells of a run, by environment, re-scheduling, start-safe interval and robots. Other maps than
/// the paper's are left out. Of a run with several planners, weights or neighbourhoods: those of any-angle
/// over 8 neighbours, as the paper has it; an error if there are none.
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
/// reproduced if its 95 % interval holds the paper's, and a flowtime within kFlowtimeShare
/// or a makespan within kMakespanShare of the paper's as well; else it is better or it differs. A cost over
/// so few instances that it has no interval is not judged.
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
  /// Missing if the cells that it speaks of were not measured.
  std::optional<bool> holds;
  std::string figures;  ///< that decided
};
std::vector<Claim> check_claims(const std::vector<MeasuredCell>& cells);

}  // namespace sipplab::bench
