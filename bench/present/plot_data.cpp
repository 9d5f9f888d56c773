// The questions behind the pictures.
#include <string_view>

#include "bench/present/named_row.hpp"
#include "bench/present/plots.hpp"
#include "db/database.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {

db::Result<PlottedRun> read_plotted_run(const std::filesystem::path& path, const std::string& run,
                                        bool with_results, bool with_steps) {
  auto database = SIPPLAB_TRY(db::Database::open_read_only(path));
  PlottedRun plotted;
  plotted.report = SIPPLAB_TRY(db::show_run(database, run));
  const std::vector<std::pair<std::string, std::string>> of_run{{"run", plotted.report.run.uuid}};
  const auto optional_real = [](const NamedRow& row, std::string_view column) {
    return std::holds_alternative<db::Null>(row[column]) ? std::nullopt : std::optional(row.real(column));
  };
  const std::string instance = "instance_hash || '/' || position || '/' || repetition AS instance";
  if (with_results) {
    const auto table =
        SIPPLAB_TRY(db::run_sql(path,
                                "SELECT case_id, " + instance +
                                    ", status = 'solved' AS solved, planning_time_s, flowtime_s, makespan_s "
                                    "FROM v_all_results WHERE run = :run",
                                of_run));
    for (const auto& values : table.rows) {
      const NamedRow row(table, values);
      plotted.results.push_back({row.integer("case_id"), row.text("instance"), row.integer("solved") != 0,
                                 row.real("planning_time_s"), optional_real(row, "flowtime_s"),
                                 optional_real(row, "makespan_s")});
    }
  }
  if (with_steps) {
    const auto table =
        SIPPLAB_TRY(db::run_sql(path,
                                "SELECT case_id, " + instance +
                                    ", elapsed_s, flowtime_gap FROM v_progress WHERE run = :run "
                                    "ORDER BY case_id, instance, step",
                                of_run));
    for (const auto& values : table.rows) {
      const NamedRow row(table, values);
      plotted.steps.push_back(
          {row.integer("case_id"), row.text("instance"), row.real("elapsed_s"), row.real("flowtime_gap")});
    }
  }
  return plotted;
}

}  // namespace sipplab::bench
