// What the views say, column by column: one that is called as a column of a table is that column, and every
// other one has its formula here, in other words than in the schema.
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "db/columns.hpp"
#include "db/queries.hpp"
#include "db/statistics/sqlite_functions.hpp"
#include "db/summaries.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::history_views_laws {
namespace {

using Formulas = std::map<std::string, std::string>;

/// What a view is to say.
struct ViewLaw {
  std::string base;   ///< FROM what: a row for each row of the view
  Texts tables;       ///< of the base, in the order in which a name is looked up
  Texts keys;         ///< columns of the view that tell its rows apart; they have formulas, or are found
  Formulas formulas;  ///< of what is not called like a column
};

// --- formulas that several views share ----------------------------------------------

const std::string kOrigin =
    " JOIN machine ON machine.id = run.machine_id JOIN build ON build.id = run.build_id "
    "LEFT JOIN commit_ ON commit_.id = run.commit_id";
const std::string kOfCell =
    "cell JOIN run ON run.id = cell.run_id JOIN case_ ON case_.id = cell.case_id" + kOrigin;
const std::string kOfResult =
    "result JOIN instance ON instance.id = result.instance_id JOIN cell ON cell.id = result.cell_id "
    "JOIN run ON run.id = cell.run_id JOIN case_ ON case_.id = cell.case_id" +
    kOrigin;
const std::string kCounts = " WHERE run.excluded_reason IS NULL";

std::string unless_largest(const std::string& column) {
  return "CASE WHEN " + column + " < 9223372036854775807 THEN " + column + " END";
}
const std::string kStatus = "substr('solved failed limit  invalid', 1 + 7 * #.status, 7)";
std::string status_of(const std::string& table) {
  std::string text = "trim(" + kStatus + ")";
  text.replace(text.find('#'), 1, table);
  return text;
}

/// Of the results of a cell: `what` over those that `where` leaves.
std::string over(const std::string& what, const std::string& where = "1") {
  return "(SELECT " + what + " FROM result AS r WHERE r.cell_id = cell.id AND " + where + ")";
}
std::string mean(const std::string& column, const std::string& where = "1") {
  return over("total(" + column + ") / nullif(count(" + column + "), 0)", where);
}
const std::string kSolved = "r.status = 0";
/// Unsolved ones are longer than all.
const std::string kTimeToSolve =
    "nullif(" + over("median(iif(r.status = 0, r.planning_time_ns / 1e9, 9e999))") + ", 9e999)";
const std::string kPar2 =
    "nullif(" +
    over("total(iif(r.status = 0, r.planning_time_ns / 1e9, 2 * case_.time_limit_s)) / count(*)") +
    ", 9e999)";

Formulas named_after_rows() {
  return {{"run", "run.uuid"},
          {"instance", "instance.name"},
          {"instance_hash", "instance.content_hash"},
          {"case_id", "case_.id"},
          {"commit_hash", "commit_.hash"},
          {"commit_subject", "commit_.subject"},
          {"machine", "machine.fingerprint"},
          {"max_expansions", unless_largest("case_.max_expansions")},
          {"max_restarts", unless_largest("case_.max_restarts")}};
}
Formulas with(Formulas more) {
  Formulas all = named_after_rows();
  for (auto& [name, formula] : more) all[name] = std::move(formula);
  return all;
}

std::string bound(const std::string& column) {
  return "(SELECT b." + column +
         " FROM instance_bound AS b WHERE b.instance_id = instance.id AND "
         "b.any_angle = case_.any_angle AND (case_.any_angle = 1 OR b.connectedness = case_.connectedness))";
}
std::string gap(const std::string& cost, const std::string& least) {
  return "CASE WHEN " + cost + " IS NOT NULL AND " + least + " IS NOT NULL THEN max(0.0, (" + cost + " - " +
         least + ") / " + cost + ") END";
}

const Formulas kOfAllResults =
    with({{"status", status_of("result")},
          {"plan_hash",
           "CASE WHEN typeof(result.plan_hash) = 'integer' THEN printf('%08x%08x', (result.plan_hash >> 32) "
           "& 4294967295, result.plan_hash & 4294967295) END"},
          {"limit_struck", "result.limit_struck"},
          {"sum_of_costs", "result.flowtime_s"},
          {"flowtime_bound_s", bound("flowtime_bound_s")},
          {"makespan_bound_s", bound("makespan_bound_s")},
          {"flowtime_gap", gap("result.flowtime_s", bound("flowtime_bound_s"))},
          {"makespan_gap", gap("result.makespan_s", bound("makespan_bound_s"))}});
const Texts kTablesOfResult = {"result", "case_", "cell", "run", "machine", "build", "commit_"};

const Formulas kOfAllCells =
    with({{"results", over("count(*)")},
          {"solved", over("count(*)", kSolved)},
          {"failed", over("count(*)", "r.status = 1")},
          {"limited", over("count(*)", "r.status = 2")},
          {"invalid", over("count(*)", "r.status = 3")},
          {"success_rate", over("total(r.status = 0) / count(*)")},
          {"mean_planning_time_s", mean("r.planning_time_ns / 1e9")},
          {"median_planning_time_s", over("median(r.planning_time_ns / 1e9)")},
          {"max_planning_time_s", over("max(r.planning_time_ns) / 1e9")},
          {"par2_time_s", kPar2},
          {"mean_makespan_s", mean("r.makespan_s", kSolved)},
          {"median_makespan_s", over("median(r.makespan_s)", kSolved)},
          {"mean_flowtime_s", mean("r.flowtime_s", kSolved)},
          {"median_flowtime_s", over("median(r.flowtime_s)", kSolved)},
          {"mean_sum_of_costs", mean("r.flowtime_s", kSolved)},
          {"mean_tries", mean("r.tries")},
          {"mean_expansions", mean("r.expansions")},
          {"mean_generations", mean("r.generations")},
          {"mean_solved_time_s", mean("r.planning_time_ns / 1e9", kSolved)},
          {"median_solved_time_s", over("median(r.planning_time_ns / 1e9)", kSolved)},
          {"median_time_to_solve_s", kTimeToSolve}});

/// Columns of a summary, of a trend by their metric.
std::string trend_value() {
  const std::pair<const char*, const char*> metrics[] = {{"success", "success_rate"},
                                                         {"runtime", "median_time_to_solve_s"},
                                                         {"mean-runtime", "mean_solved_time_s"},
                                                         {"max-runtime", "max_planning_time_s"},
                                                         {"par2", "par2_time_s"},
                                                         {"makespan", "mean_makespan_s"},
                                                         {"flowtime", "mean_flowtime_s"},
                                                         {"tries", "mean_tries"},
                                                         {"expansions", "mean_expansions"},
                                                         {"generations", "mean_generations"}};
  std::string text = "CASE names.name";
  for (const auto& [metric, column] : metrics) {
    text += " WHEN '" + std::string(metric) + "' THEN " + kOfAllCells.at(column);
  }
  return text + " END";
}

std::string count_of(const std::string& from) { return "(SELECT count(*) FROM " + from + ")"; }

std::map<std::string, ViewLaw> make_laws() {
  std::map<std::string, ViewLaw> laws;
  laws["v_all_results"] = {kOfResult,
                           kTablesOfResult,
                           {"run", "case_id", "instance_hash", "position", "repetition"},
                           kOfAllResults};
  laws["v_results"] = laws["v_all_results"];
  laws["v_results"].base += kCounts;
  laws["v_slowest"] = laws["v_results"];
  laws["v_all_run_cells"] = {
      kOfCell, {"case_", "cell", "run", "machine", "build", "commit_"}, {"run", "case_id"}, kOfAllCells};
  laws["v_run_cells"] = laws["v_all_run_cells"];
  laws["v_run_cells"].base += kCounts;
  laws["v_recomputed_cells"] = {kOfCell, {"cell"}, {"cell_id"}, kOfAllCells};
  laws["v_recomputed_cells"].formulas["cell_id"] = "cell.id";
  laws["v_trends"] = {
      "(SELECT 'success' AS name UNION SELECT 'runtime' UNION SELECT 'mean-runtime' UNION SELECT "
      "'max-runtime' "
      "UNION SELECT 'par2' UNION SELECT 'makespan' UNION SELECT 'flowtime' UNION SELECT 'tries' "
      "UNION SELECT 'expansions' UNION SELECT 'generations') AS names JOIN " +
          kOfCell + kCounts,
      {"case_", "cell", "run", "machine", "build", "commit_"},
      {"metric", "run", "case_id"},
      with({{"metric", "names.name"},
            {"results", kOfAllCells.at("results")},
            {"solved", kOfAllCells.at("solved")},
            {"value", trend_value()}})};
  laws["v_work"] = {kOfCell + kCounts + " AND " + over("count(*)") + " > 0",
                    {"case_", "cell", "run"},
                    {"run", "case_id"},
                    with({{"results", kOfAllCells.at("results")},
                          {"solved", kOfAllCells.at("solved")},
                          {"mean_tries", mean("r.tries")},
                          {"mean_expansions", mean("r.expansions")},
                          {"mean_generations", mean("r.generations")},
                          {"mean_instructions", mean("r.instructions")},
                          {"mean_planning_time_s", mean("r.planning_time_ns / 1e9")},
                          {"mean_cpu_time_s", mean("r.cpu_time_ns / 1e9")},
                          {"peak_memory_bytes", over("max(r.peak_memory_bytes)")}})};
  const std::string by_maker = "r.made_by IS maker.made_by";
  laws["v_plan_makers"] = {
      "(SELECT DISTINCT cell_id, made_by FROM result) AS maker JOIN cell ON cell.id = maker.cell_id "
      "JOIN run ON run.id = cell.run_id JOIN case_ ON case_.id = cell.case_id" +
          kOrigin + kCounts,
      {"maker", "case_", "run"},
      {"run", "case_id", "made_by"},
      with({{"results", over("count(*)", by_maker)},
            {"solved", over("count(*)", kSolved + " AND " + by_maker)},
            {"mean_planning_time_s", mean("r.planning_time_ns / 1e9", by_maker)},
            {"max_planning_time_s", over("max(r.planning_time_ns) / 1e9", by_maker)},
            {"mean_makespan_s", mean("r.makespan_s", kSolved + " AND " + by_maker)},
            {"mean_flowtime_s", mean("r.flowtime_s", kSolved + " AND " + by_maker)},
            {"least_ssi_kept_s", over("min(r.ssi_kept_s)", by_maker)}})};
  const std::string by_machine =
      "(SELECT a.machine_id FROM attempt AS a WHERE a.id = r.attempt_id) = machine.id";
  laws["v_machine_cells"] = {
      "cell JOIN run ON run.id = cell.run_id JOIN case_ ON case_.id = cell.case_id JOIN machine "
      "ON machine.id IN (SELECT a.machine_id FROM attempt AS a JOIN result AS r ON r.attempt_id = a.id WHERE "
      "r.cell_id = cell.id)" +
          kCounts,
      {"case_", "machine", "run"},
      {"run", "case_id", "machine"},
      with({{"results", over("count(*)", by_machine)},
            {"solved", over("count(*)", kSolved + " AND " + by_machine)},
            {"mean_planning_time_s", mean("r.planning_time_ns / 1e9", by_machine)},
            {"max_planning_time_s", over("max(r.planning_time_ns) / 1e9", by_machine)}})};
  const std::string here =
      "FROM result AS r JOIN cell AS c ON c.id = r.cell_id JOIN run AS n ON n.id = c.run_id WHERE "
      "r.instance_id = instance.id AND c.case_id = case_.id AND n.excluded_reason IS NULL";
  laws["v_instances"] = {
      "case_ JOIN instance ON EXISTS (SELECT 1 " + here + ")",
      {"case_", "instance"},
      {"case_id", "instance_hash"},
      with({{"robots", "case_.robots"},
            {"results", "(SELECT count(*) " + here + ")"},
            {"solved", "(SELECT count(*) " + here + " AND r.status = 0)"},
            {"success_rate", "(SELECT total(r.status = 0) / count(*) " + here + ")"},
            {"mean_solved_time_s",
             "(SELECT total(r.planning_time_ns / 1e9) / nullif(count(*), 0) " + here + " AND r.status = 0)"},
            {"flowtime_bound_s", bound("flowtime_bound_s")},
            {"makespan_bound_s", bound("makespan_bound_s")}})};
  laws["v_recomputed_instances"] = {
      "case_ JOIN instance ON EXISTS (SELECT 1 FROM result AS r JOIN cell AS c ON c.id = r.cell_id "
      "WHERE r.instance_id = instance.id AND c.case_id = case_.id)",
      {},
      {"case_id", "instance_id"},
      {{"case_id", "case_.id"},
       {"instance_id", "instance.id"},
       {"results", "(SELECT count(*) " + here + ")"},
       {"solved", "(SELECT count(*) " + here + " AND r.status = 0)"},
       {"solved_time_ns",
        "(SELECT CAST(total(r.planning_time_ns) AS INTEGER) " + here + " AND r.status = 0)"}}};
  const std::string same_planning =
      "x.cell_id = result.cell_id AND x.instance_id = result.instance_id AND "
      "x.position = result.position AND x.repetition = result.repetition";
  const std::string of_planning = " JOIN result ON " + same_planning +
                                  " JOIN instance ON instance.id = result.instance_id "
                                  "JOIN cell ON cell.id = result.cell_id JOIN run ON run.id = cell.run_id "
                                  "JOIN case_ ON case_.id = cell.case_id";
  const Texts planning_key = {"run",      "environment", "robots",    "planner",
                              "instance", "position",    "repetition"};
  laws["v_progress"] = {
      "progress AS x" + of_planning + kCounts,
      {"x", "case_", "run"},
      {"run", "case_id", "instance_hash", "position", "repetition", "step"},
      with({{"elapsed_s", "x.elapsed_ns / 1e9"},
            {"flowtime_gap", gap("x.flowtime_s", "x.flowtime_bound_s")},
            {"makespan_gap", gap("x.makespan_s", "x.makespan_bound_s")},
            {"until_s",
             "ifnull((SELECT min(y.elapsed_ns) / 1e9 FROM progress AS y WHERE y.cell_id = x.cell_id AND "
             "y.instance_id = x.instance_id AND y.position = x.position AND y.repetition = x.repetition "
             "AND y.step > x.step), 9e999)"}})};
  laws["v_retimed"] = {
      "retiming AS x" + of_planning + kCounts,
      {"x", "result", "case_", "run"},
      planning_key,
      with(
          {{"status", "iif(x.executable = 0, 'not_executable', iif(result.status = 0, 'solved', 'invalid'))"},
           {"retime_s", "x.retime_ns / 1e9"}})};
  laws["v_reported"] = {
      "reported AS x" + of_planning + kCounts, {"x", "case_", "run"}, planning_key, with({})};
  laws["v_reported"].keys.push_back("name");
  laws["v_best_known"] = {
      "best_known LEFT JOIN (SELECT run.uuid AS uuid, case_.planner AS planner, x.unit_step_cost AS cost, "
      "case_.robots AS robots, "
      "instance.name AS name FROM retiming AS x" +
          of_planning + kCounts +
          " AND x.unit_step_cost IS NOT NULL) AS ours "
          "ON ours.robots = best_known.agents AND instr(ours.name, best_known.map_name || '-' || "
          "best_known.scen_type || '-' "
          "|| best_known.type_id || '.scen') > 0",
      {"best_known"},
      {},
      {{"run", "ours.uuid"},
       {"planner", "ours.planner"},
       {"unit_step_cost", "ours.cost"},
       {"above_best_known", "ours.cost - best_known.solution_cost"}}};
  Formulas of_flips = {{"base_run", "bn.uuid"},
                       {"head_run", "hn.uuid"},
                       {"case_id", "case_.id"},
                       {"instance", "instance.name"},
                       {"instance_hash", "instance.content_hash"},
                       {"direction", "iif(h.status = 0, 'gained', 'lost')"},
                       {"base_status", status_of("b")},
                       {"head_status", status_of("h")},
                       {"base_planning_time_s", "b.planning_time_ns / 1e9"},
                       {"head_planning_time_s", "h.planning_time_ns / 1e9"},
                       {"position", "b.position"},
                       {"repetition", "b.repetition"},
                       {"base_commit", "(SELECT k.hash FROM commit_ AS k WHERE k.id = bn.commit_id)"},
                       {"head_commit", "(SELECT k.hash FROM commit_ AS k WHERE k.id = hn.commit_id)"}};
  laws["v_flips"] = {
      "result AS b JOIN result AS h ON h.instance_id = b.instance_id AND h.position = b.position AND "
      "h.repetition = b.repetition AND (h.status = 0) + (b.status = 0) = 1 JOIN cell AS bc ON bc.id = "
      "b.cell_id "
      "JOIN cell AS hc ON hc.id = h.cell_id AND hc.case_id = bc.case_id AND hc.run_id <> bc.run_id "
      "JOIN run AS bn ON bn.id = bc.run_id AND bn.excluded_reason IS NULL JOIN run AS hn ON hn.id = "
      "hc.run_id "
      "AND hn.excluded_reason IS NULL JOIN case_ ON case_.id = bc.case_id JOIN instance ON instance.id = "
      "b.instance_id",
      {"case_"},
      {"base_run", "head_run", "case_id", "instance_hash", "position", "repetition"},
      of_flips};
  const std::string any_run = "run" + kOrigin;
  const std::string cells = "cell AS c WHERE c.run_id = run.id";
  const std::string results = "result AS r JOIN cell AS c ON c.id = r.cell_id WHERE c.run_id = run.id";
  laws["v_runs"] = {any_run,
                    {"run", "machine", "build", "commit_"},
                    {"run"},
                    with({{"cases", count_of(cells)},
                          {"results", count_of(results)},
                          {"solved", count_of(results + " AND r.status = 0")},
                          {"invalid", count_of(results + " AND r.status = 3")},
                          {"measurements", count_of("measurement AS m WHERE m.run_id = run.id")},
                          {"max_machine_load", "(SELECT max(c.machine_load) FROM " + cells + ")"}})};
  laws["v_sweeps"] = {
      "run WHERE run.kind = 'sweep'",
      {"run"},
      {"run"},
      {{"run", "run.uuid"},
       {"results", count_of(results)},
       {"missing", "run.planned - " + count_of(results)},
       {"attempts", count_of("attempt AS a WHERE a.run_id = run.id")},
       {"machines", "(SELECT count(DISTINCT a.machine_id) FROM attempt AS a WHERE a.run_id = run.id)"},
       {"cpu_time_s", "(SELECT total(a.cpu_time_ns) / 1e9 FROM attempt AS a WHERE a.run_id = run.id)"}}};
  laws["v_attempts"] = {
      "attempt JOIN run ON run.id = attempt.run_id JOIN machine ON machine.id = attempt.machine_id",
      {"attempt", "machine"},
      {"attempt"},
      {{"run", "run.uuid"},
       {"attempt", "attempt.uuid"},
       {"machine", "machine.fingerprint"},
       {"wall_time_s", "(julianday(attempt.ended_utc) - julianday(attempt.started_utc)) * 24 * 3600"}}};
  laws["v_cases"] = {"case_", {"case_"}, {"case_id"}, {{"case_id", "case_.id"}}};
  const auto runs_of_commit = [](const std::string& kinds) {
    return count_of("run AS n WHERE n.commit_id = commit_.id AND n.excluded_reason IS NULL AND n.kind IN (" +
                    kinds + ")");
  };
  laws["v_commits"] = {"commit_",
                       {"commit_"},
                       {"commit_hash"},
                       {{"commit_hash", "commit_.hash"},
                        {"parents",
                         "nullif(trim(ifnull((SELECT p.parent_hash FROM commit_parent AS p WHERE p.commit_id "
                         "= commit_.id AND p.position = 0), '') || ' ' || "
                         "ifnull((SELECT p.parent_hash FROM commit_parent AS p WHERE p.commit_id = "
                         "commit_.id AND p.position = 1), '')), '')"},
                        {"runs", runs_of_commit("'sweep', 'report'")},
                        {"property_runs", runs_of_commit("'property'")}}};
  laws["v_all_measurements"] = {"measurement JOIN run ON run.id = measurement.run_id" + kOrigin,
                                {"measurement", "run", "machine", "commit_"},
                                {"run", "benchmark", "repetition"},
                                with({{"context", "run.options"},
                                      {"counters",
                                       "ifnull((SELECT '{\"' || k.counter || '\":' || k.value || '}' FROM "
                                       "measurement_counter AS k WHERE "
                                       "k.run_id = run.id AND k.benchmark = measurement.benchmark AND "
                                       "k.repetition = measurement.repetition), '{}')"}})};
  laws["v_measurements"] = laws["v_all_measurements"];
  laws["v_measurements"].base += kCounts;
  const std::string of_property = "property_run JOIN run ON run.id = property_run.run_id" + kOrigin;
  laws["v_property_runs"] = {
      of_property,
      {"property_run", "run", "machine", "build", "commit_"},
      {"id"},
      with({{"property_run", "run.uuid"}, {"room", "run.suite"}, {"status", "run.outcome"}})};
  laws["v_property_latest"] = laws["v_property_runs"];
  laws["v_property_latest"].base += kCounts +
                                    " AND property_run.mutant = '' AND NOT EXISTS (SELECT 1 FROM "
                                    "property_run AS p JOIN run AS n ON n.id = p.run_id WHERE "
                                    "n.suite = run.suite AND p.title = property_run.title AND p.mutant = '' "
                                    "AND n.excluded_reason IS NULL AND "
                                    "(n.started_utc, p.id) > (run.started_utc, property_run.id))";
  laws["v_property_classes"] = {
      "property_class JOIN property_run ON property_run.id = property_class.property_run_id JOIN run ON "
      "run.id = property_run.run_id" +
          kCounts,
      {"property_class", "property_run", "run"},
      {"id", "class"},
      {{"id", "property_run.id"},
       {"property_run", "run.uuid"},
       {"room", "run.suite"},
       {"share", "property_class.cases * 1.0 / property_run.cases"}}};
  const std::string group =
      "property_run AS p JOIN run AS n ON n.id = p.run_id WHERE p.mutant = '' AND n.excluded_reason IS NULL "
      "AND "
      "n.commit_id IS g.commit_id AND n.suite = g.suite AND p.title = g.title";
  const auto total_of = [&](const std::string& what, const std::string& also = "1") {
    return "(SELECT " + what + " FROM " + group + " AND " + also + ")";
  };
  laws["v_property_totals"] = {
      "(SELECT DISTINCT run.commit_id AS commit_id, run.suite AS suite, property_run.title AS title FROM "
      "property_run JOIN run ON run.id = property_run.run_id" +
          kCounts + " AND property_run.mutant = '') AS g LEFT JOIN commit_ ON commit_.id = g.commit_id",
      {"g", "commit_"},
      {"commit_hash", "room", "title"},
      {{"commit_hash", "commit_.hash"},
       {"room", "g.suite"},
       {"runs", total_of("count(*)")},
       {"cases", total_of("sum(p.cases)")},
       {"discards", total_of("sum(p.discards)")},
       {"failed", total_of("count(*)", "n.outcome = 'failed'")},
       {"gave_up", total_of("count(*)", "n.outcome = 'gave_up'")},
       {"crashed", total_of("count(*)", "n.outcome = 'crashed'")},
       {"wall_time_s", total_of("sum(p.wall_time_ns / 1e9)")},
       {"first_utc", total_of("min(n.started_utc)")},
       {"last_utc", total_of("max(n.started_utc)")}}};
  const std::string of_gate = "gate_run JOIN run ON run.id = gate_run.run_id" + kOrigin +
                              " JOIN build AS bb ON bb.id = gate_run.base_build_id LEFT JOIN commit_ AS bk "
                              "ON bk.id = gate_run.base_commit_id";
  const auto all_cells = [](const std::string& column) {
    return "(SELECT k." + column +
           " FROM gate_cell AS k WHERE k.gate_run_id = gate_run.id AND k.position = 0)";
  };
  laws["v_gate_runs"] = {of_gate,
                         {"gate_run", "run", "machine"},
                         {"gate_run"},
                         with({{"gate_run", "run.uuid"},
                               {"verdict", "run.outcome"},
                               {"base_commit_hash", "bk.hash"},
                               {"head_commit_hash", "commit_.hash"},
                               {"head_commit_subject", "commit_.subject"},
                               {"head_ancestor_count", "commit_.ancestor_count"},
                               {"base_binary_hash", "bb.binary_hash"},
                               {"head_binary_hash", "build.binary_hash"},
                               {"base_compiler", "printf('%s %s', bb.compiler, bb.compiler_version)"},
                               {"head_compiler", "printf('%s %s', build.compiler, build.compiler_version)"},
                               {"head_dirty", "build.dirty"},
                               {"slowdown", all_cells("slowdown")},
                               {"detectable", all_cells("detectable")}})};
  laws["v_all_gate_cells"] = {
      "gate_cell JOIN gate_run ON gate_run.id = gate_cell.gate_run_id JOIN run ON run.id = gate_run.run_id "
      "LEFT JOIN case_ ON case_.id = gate_cell.case_id",
      {"gate_cell", "gate_run", "case_", "run"},
      {"gate_run", "case_id"},
      {{"gate_run", "run.uuid"}, {"pairs", count_of("gate_pair AS k WHERE k.gate_cell_id = gate_cell.id")}}};
  laws["v_gate_cells"] = laws["v_all_gate_cells"];
  laws["v_gate_cells"].base += kCounts;
  laws["v_gate_differences"] = {
      "gate_difference JOIN gate_run ON gate_run.id = gate_difference.gate_run_id JOIN run ON run.id = "
      "gate_run.run_id "
      "JOIN case_ ON case_.id = gate_difference.case_id JOIN instance ON instance.id = "
      "gate_difference.instance_id" +
          kCounts,
      {"gate_difference", "case_", "run"},
      {"gate_run", "case_id", "instance_hash", "what"},
      with({{"gate_run", "run.uuid"}})};
  const std::string of_fuzz = "fuzz_run JOIN run ON run.id = fuzz_run.run_id" + kOrigin;
  const auto rate = [](const std::string& time) {
    return "CASE WHEN " + time + " > 0 THEN fuzz_run.executions / (" + time + " / 1e9) END";
  };
  laws["v_fuzz_runs"] = {of_fuzz,
                         {"fuzz_run", "run", "machine", "build", "commit_"},
                         {"id"},
                         with({{"fuzz_run", "run.uuid"},
                               {"target", "run.suite"},
                               {"status", "run.outcome"},
                               {"executions_per_s", rate("fuzz_run.wall_time_ns")},
                               {"executions_per_cpu_s", rate("fuzz_run.cpu_time_ns")}})};
  laws["v_fuzz_counts"] = {
      "fuzz_count JOIN fuzz_run ON fuzz_run.id = fuzz_count.fuzz_run_id JOIN run ON run.id = "
      "fuzz_run.run_id" +
          kCounts,
      {"fuzz_count", "fuzz_run", "run"},
      {"id", "kind", "name"},
      {{"id", "fuzz_run.id"},
       {"fuzz_run", "run.uuid"},
       {"target", "run.suite"},
       {"per_input",
        "fuzz_count.count * 1.0 / (SELECT k.count FROM fuzz_count AS k WHERE k.fuzz_run_id = fuzz_run.id AND "
        "k.kind = 'event' AND k.name = 'inputs')"}}};
  const std::string of_campaign =
      " FROM fuzz_run AS f JOIN run AS n ON n.id = f.run_id WHERE f.campaign = g.campaign AND "
      "n.excluded_reason IS NULL";
  const std::string lines =
      " FROM fuzz_coverage AS k WHERE k.campaign = g.campaign AND k.file LIKE g.room || '/%'";
  const std::string first_commit = "(SELECT min(n.commit_id)" + of_campaign + ")";
  laws["v_fuzz_coverage"] = {
      "(SELECT DISTINCT campaign, 'planner/' || part.value AS room FROM fuzz_coverage JOIN (SELECT 'grid' AS "
      "value UNION SELECT 'search') AS part) AS g "
      "WHERE EXISTS (SELECT 1" +
          of_campaign + ")",
      {"g"},
      {"campaign", "room"},
      {{"started_utc", "(SELECT min(n.started_utc)" + of_campaign + ")"},
       {"commit_hash", "(SELECT k.hash FROM commit_ AS k WHERE k.id = " + first_commit + ")"},
       {"ancestor_count", "(SELECT k.ancestor_count FROM commit_ AS k WHERE k.id = " + first_commit + ")"},
       {"lines", "(SELECT sum(k.lines)" + lines + ")"},
       {"covered_lines", "(SELECT sum(k.covered_lines)" + lines + ")"},
       {"share", "(SELECT total(k.covered_lines) / sum(k.lines)" + lines + ")"}}};
  const auto commit_hash = [](const std::string& which) {
    return "(SELECT k.hash FROM commit_ AS k WHERE k.id = finding." + which + "_commit_id)";
  };
  laws["v_findings"] = {"finding",
                        {"finding"},
                        {"id"},
                        {{"first_commit", commit_hash("first")},
                         {"last_commit", commit_hash("last")},
                         {"fixed_commit", commit_hash("fixed")},
                         {"input_bytes", "length(finding.input)"},
                         {"minimal_bytes", "length(finding.minimal)"}}};
  return laws;
}

const std::map<std::string, ViewLaw>& laws() {
  static const std::map<std::string, ViewLaw> made = make_laws();
  return made;
}

// --- asking -------------------------------------------------------------------------

Texts columns_of(Database& database, const std::string& name) {
  return texts_of(database, "SELECT name FROM pragma_table_info('" + name + "') ORDER BY cid");
}

/// The columns of "x" and the like, which stand for a table under another name.
Texts columns_of_alias(Database& database, const std::string& alias, const std::string& base) {
  const std::size_t at = base.find(" AS " + alias + " ");
  if (at == std::string::npos || base[at - 1] == ')') {
    if (alias == "maker") return {"made_by"};
    if (alias == "g") return {"campaign", "room", "title"};
    return columns_of(database, alias);
  }
  const std::size_t begin = base.rfind(' ', at - 1) == std::string::npos ? 0 : base.rfind(' ', at - 1) + 1;
  return columns_of(database, base.substr(begin, at - begin));
}

/// What a column is to be, if a table has one of that name: its own, or in seconds what the table has in ns.
std::string formula_of(Database& database, const ViewLaw& law, const std::string& column) {
  const auto own = law.formulas.find(column);
  if (own != law.formulas.end()) return own->second;
  const std::string in_ns = column.size() > 2 ? column.substr(0, column.size() - 2) + "_ns" : column;
  for (const std::string& table : law.tables) {
    const Texts columns = columns_of_alias(database, table, law.base);
    if (std::find(columns.begin(), columns.end(), column) != columns.end()) return table + "." + column;
    if (column.size() > 2 && column.substr(column.size() - 2) == "_s" &&
        std::find(columns.begin(), columns.end(), in_ns) != columns.end()) {
      return table + "." + in_ns + " / 1e9";
    }
  }
  return "";
}

/// Made once: the schema is the same in all histories.
const std::map<std::string, Formulas>& all_formulas(Database& database) {
  static std::map<std::string, Formulas> formulas;
  if (!formulas.empty()) return formulas;
  for (const std::string& view : views_of(database)) {
    RC_LOG() << view << '\n';
    RC_ASSERT(laws().count(view) == 1U);
    for (const std::string& column : columns_of(database, view)) {
      const std::string formula = formula_of(database, laws().at(view), column);
      RC_LOG() << view << '.' << column << ", expected a column of that name in a table, or a formula\n";
      RC_ASSERT(!formula.empty());
      formulas[view][column] = formula;
    }
  }
  return formulas;
}

bool are_close(const Value& a, const Value& b) {
  const auto number = [](const Value& value) -> std::optional<double> {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value)) return *real;
    return std::nullopt;
  };
  const auto x = number(a);
  const auto y = number(b);
  if (!x || !y) return a == b;
  constexpr double kRounding = 1e-9;
  // Days since 4714 BC, in which julianday() counts, are known to 40 microseconds.
  constexpr double kRoundingOfDays = 1e-4;
  return *x == *y || std::abs(*x - *y) <= kRounding * std::max(std::abs(*x), std::abs(*y)) ||
         std::abs(*x - *y) < kRoundingOfDays * (std::abs(*x) < 1 && std::abs(*y) < 1 ? 0.01 : 0);
}

std::string shown(const Value& value) { return format_csv({{"x"}, {{value}}}).substr(3); }

void views_say_what_their_columns_mean() {
  const NewHistory history;
  record_some_of_everything(history.path());
  Database database = history.open();
  RC_ASSERT(statistics::register_functions(database.connection().raw()) == SQLITE_OK);
  for (const std::string& run : all_runs(database)) {
    if (any_whole(0, 3) == 0) must(exclude_run(database, run, "noise"));
  }
  for (const auto& [view, formulas] : all_formulas(database)) {
    std::string said;
    std::string meant;
    std::string order;
    int place = 0;
    for (const auto& [column, formula] : formulas) {
      said += (said.empty() ? "" : ", ") + ("\"" + column + "\"");
      meant += (meant.empty() ? "" : ", ") + formula + " AS c" + std::to_string(place);
      const auto& keys = laws().at(view).keys;
      if (keys.empty() || std::find(keys.begin(), keys.end(), column) != keys.end()) {
        order += (order.empty() ? "" : ", ") + std::to_string(place + 1);
      }
      ++place;
    }
    const Table answer = rows_of(database, "SELECT " + said + " FROM " + view + " ORDER BY " + order);
    const Table expected =
        rows_of(database, "SELECT " + meant + " FROM " + laws().at(view).base + " ORDER BY " + order);
    RC_LOG() << view << ": " << answer.rows.size() << " rows, expected " << expected.rows.size() << '\n';
    RC_ASSERT(answer.rows.size() == expected.rows.size());
    for (std::size_t row = 0; row < answer.rows.size(); ++row) {
      auto column = formulas.begin();
      for (std::size_t i = 0; i < answer.columns.size(); ++i, ++column) {
        if (are_close(answer.rows[row][i], expected.rows[row][i])) continue;
        RC_LOG() << view << '.' << column->first << " in row " << row << ": " << shown(answer.rows[row][i])
                 << ", expected " << shown(expected.rows[row][i]) << '\n';
        RC_FAIL("a view says something else");
      }
    }
  }
  RC_ASSERT(must(count_stale_summaries(database.connection())) == 0);
}

void slowest_come_first() {
  const NewHistory history;
  record(history.path(), any_sweep());
  Database database = history.open();
  double last = std::numeric_limits<double>::infinity();
  for (const auto& row : rows_of(database, "SELECT planning_time_s FROM v_slowest").rows) {
    RC_ASSERT(std::get<double>(row[0]) <= last);
    last = std::get<double>(row[0]);
  }
}

/// Of all results of an instance by the moves of its case the greatest bounds, whoever found them.
void bounds_are_the_greatest() {
  const NewHistory history;
  std::map<std::tuple<std::string, std::int64_t, std::int64_t>, std::pair<double, double>> greatest;
  const auto sweeps = any_whole(1, 3);
  for (std::int64_t i = 0; i < sweeps; ++i) {
    const Sweep sweep = any_sweep();
    record(history.path(), sweep);
    std::set<std::pair<std::size_t, std::string>> met;
    for (const Planned& planned : sweep.plannings) {
      if (!planned.row.flowtime_bound_s) continue;
      const auto any_angle = std::get<std::int64_t>(planned.parameters.option("any_angle"));
      const auto connectedness =
          any_angle != 0 ? 0 : std::get<std::int64_t>(planned.parameters.option("connectedness"));
      auto& [flowtime_s, makespan_s] = greatest[{planned.instance.content_hash, any_angle, connectedness}];
      flowtime_s = std::max(flowtime_s, *planned.row.flowtime_bound_s);
      makespan_s = std::max(makespan_s, *planned.row.makespan_bound_s);
    }
  }
  Database database = history.open();
  const Table table =
      rows_of(database,
              "SELECT content_hash, any_angle, connectedness, flowtime_bound_s, makespan_bound_s "
              "FROM instance_bound JOIN instance ON instance.id = instance_id");
  RC_ASSERT(table.rows.size() == greatest.size());
  for (const auto& row : table.rows) {
    const auto& [flowtime_s, makespan_s] = greatest.at(
        {std::get<std::string>(row[0]), std::get<std::int64_t>(row[1]), std::get<std::int64_t>(row[2])});
    RC_ASSERT(std::get<double>(row[3]) == flowtime_s);
    RC_ASSERT(std::get<double>(row[4]) == makespan_s);
  }
}

const PropertyRoom room("history_views", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("every column of every view is what it is called, or its formula",
                     views_say_what_their_columns_mean, kWholeHistories);
  passed &= property("the slowest results come first", slowest_come_first, kWholeHistories);
  passed &= property("bounds of an instance are the greatest that were found", bounds_are_the_greatest,
                     kWholeHistories);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::history_views_laws
