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
  if (with_results) {
    const auto table = SIPPLAB_TRY(
        db::run_sql(path,
                    "SELECT case_id, instance_hash || '/' || position || '/' || repetition AS instance, "
                    "status = 'solved' AS solved, planning_time_s, flowtime_s, makespan_s "
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
    // v_progress has no excluded runs; one that is named is drawn, as by the other pictures.
    const auto table = SIPPLAB_TRY(db::run_sql(
        path,
        "SELECT case_id, content_hash || '/' || position || '/' || repetition AS instance, "
        "elapsed_ns / 1e9 AS elapsed_s, "
        "iif(flowtime_s > flowtime_bound_s, 1 - flowtime_bound_s / flowtime_s, 0.0) AS flowtime_gap "
        "FROM progress JOIN cell ON cell.id = cell_id JOIN run ON run.id = run_id "
        "JOIN instance ON instance.id = instance_id WHERE run.uuid = :run "
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
