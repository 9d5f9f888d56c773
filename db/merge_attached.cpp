// Merging follows the schema: tables, keys and references are read from SQLite, so that a new
// table is merged without a line here.
#include "db/merge_attached.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <string_view>

#include "db/migrate.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"
#include "db/summaries.hpp"

namespace sipplab::db {
namespace {

namespace fs = std::filesystem;
using sqlite::Connection;
using sqlite::Statement;

/// Counts results: what is merged into `result` is in it already.
constexpr std::string_view kKeptByTriggers = "instance_summary";

Result<std::vector<std::vector<std::string>>> rows_of(Connection& connection, const std::string& sql,
                                                      int columns) {
  return SIPPLAB_TRY(Statement::prepare(connection, sql, kMerging)).collect([columns](const Statement& row) {
    std::vector<std::string> texts;
    for (int i = 0; i < columns; ++i) texts.push_back(row.text(i));
    return texts;
  });
}

Result<TableShape> shape_of(Connection& connection, const std::string& table) {
  TableShape shape;
  shape.name = table;
  const auto columns = SIPPLAB_TRY(rows_of(
      connection, fmt::format("SELECT name, type, pk FROM pragma_table_info('{}') ORDER BY cid", table), 3));
  for (const auto& column : columns) {
    if (column[0] == "id" && column[1] == "INTEGER" && column[2] == "1") {
      shape.has_key = true;
    } else {
      shape.columns.push_back(column[0]);
    }
  }
  const auto indexes = SIPPLAB_TRY(rows_of(
      connection,
      fmt::format(
          "SELECT name FROM pragma_index_list('{}') WHERE \"unique\" AND NOT partial ORDER BY seq DESC",
          table),
      1));
  for (const auto& index : indexes) {
    const auto parts = SIPPLAB_TRY(rows_of(
        connection, fmt::format("SELECT name FROM pragma_index_info('{}') ORDER BY seqno", index[0]), 1));
    shape.unique.emplace_back();
    for (const auto& part : parts) shape.unique.back().push_back(part[0]);
  }
  const auto references =
      SIPPLAB_TRY(rows_of(connection,
                          fmt::format("SELECT \"from\", \"table\", ifnull(\"to\", 'id') FROM "
                                      "pragma_foreign_key_list('{}') ORDER BY id, seq",
                                      table),
                          3));
  for (const auto& reference : references)
    shape.references.push_back({reference[0], reference[1], reference[2]});
  return shape;
}

class Merge {
 public:
  Merge(Connection& connection, std::vector<TableShape> tables, std::string origin)
      : connection_(connection), tables_(std::move(tables)), origin_(std::move(origin)) {}

  Result<MergeReport> run() {
    // An attempt is written together with its results: where it is as it was, so are they.
    SIPPLAB_TRY(empty_table("temp.changed", "(id INTEGER PRIMARY KEY, run_id INTEGER)"));
    SIPPLAB_TRY(
        run("INSERT INTO temp.changed SELECT s.id, s.run_id FROM shard.attempt AS s WHERE NOT EXISTS "
            "(SELECT 1 FROM main.attempt AS d WHERE d.uuid = s.uuid "
            "AND (d.ended_utc, d.status, d.cpu_time_ns) = (s.ended_utc, s.status, s.cpu_time_ns))"));
    SIPPLAB_TRY(empty_table("temp.fresh",
                            "(cell_id INTEGER, instance_id INTEGER, position INTEGER, repetition INTEGER, "
                            "PRIMARY KEY (cell_id, instance_id, position, repetition)) WITHOUT ROWID"));
    SIPPLAB_TRY(find_filled_tables());
    for (const TableShape& table : tables_) {
      if (table.name == kKeptByTriggers) continue;
      if (table.has_key)
        SIPPLAB_TRY(empty_table(key_map(table), "(old INTEGER PRIMARY KEY, new INTEGER NOT NULL)"));
      if (filled_.contains(table.name)) SIPPLAB_TRY(merge_table(table));
    }
    SIPPLAB_TRY(bring_up_to_date());
    SIPPLAB_TRY(settle());
    return std::move(report_);
  }

 private:
  /// Most files fill a third of the tables, and compiling SQL is most of what a small one takes.
  Result<Done> find_filled_tables() {
    std::string sql;
    for (const TableShape& table : tables_) {
      sql += fmt::format("{}EXISTS (SELECT 1 FROM shard.\"{}\")", sql.empty() ? "SELECT " : ", ", table.name);
    }
    auto select = SIPPLAB_TRY(Statement::prepare(connection_, sql, kMerging));
    SIPPLAB_TRY(select.step());
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      if (select.integer(static_cast<int>(i)) != 0) filled_.insert(tables_[i].name);
    }
    return Done{};
  }

  static std::string key_map(const TableShape& table) { return fmt::format("temp.\"key_{}\"", table.name); }

  const TableShape* find(const std::string& name) const {
    const auto found = std::find_if(tables_.begin(), tables_.end(),
                                    [&name](const TableShape& table) { return table.name == name; });
    return found == tables_.end() ? nullptr : &*found;
  }

  /// The table whose integer key the column holds, followed through composite references.
  std::optional<std::string> target_of(const TableShape& table, const std::string& column) const {
    for (const Reference& reference : table.references) {
      if (reference.column != column) continue;
      const TableShape* parent = find(reference.parent);
      if (parent == nullptr) continue;
      if (reference.parent_column == "id" && parent->has_key) return parent->name;
      if (auto further = target_of(*parent, reference.parent_column)) return further;
    }
    return std::nullopt;
  }

  /// Rows of the source with keys of the destination: expressions and joins.
  struct Source {
    std::vector<std::string> expressions;  ///< of each column of the table
    std::string from;

    const std::string& expression(const TableShape& table, const std::string& column) const {
      const auto at = std::find(table.columns.begin(), table.columns.end(), column) - table.columns.begin();
      return expressions[static_cast<std::size_t>(at)];
    }
  };
  Source source_of(const TableShape& table) const {
    Source source;
    source.from = fmt::format("shard.\"{}\" AS s", table.name);
    for (const std::string& column : table.columns) {
      const auto target = target_of(table, column);
      if (target) {
        const std::string map = "m_" + column;
        source.from +=
            fmt::format(" LEFT JOIN temp.\"key_{}\" AS {} ON {}.old = s.\"{}\"", *target, map, map, column);
        source.expressions.push_back(map + ".new");
      } else if (column == "origin") {
        source.expressions.push_back("iif(s.origin = '', ?1, s.origin)");
      } else {
        source.expressions.push_back(fmt::format("s.\"{}\"", column));
      }
    }
    return source;
  }

  Result<Done> merge_table(const TableShape& table) {
    const Source source = source_of(table);
    std::string columns;
    std::string expressions;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      columns += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", table.columns[i]);
      expressions += (i == 0 ? "" : ", ") + source.expressions[i];
    }
    std::string condition = "true";
    if (table.name == "cell") {
      last_cell_ = SIPPLAB_TRY(connection_.query_int("SELECT ifnull(max(id), 0) FROM main.cell", kMerging));
    }
    // Results of a cell that is new come with it; of one that is not, those of attempts with news may be
    // missing. Millions of others need not be looked up.
    if (table.name == "result") {
      SIPPLAB_TRY(run(fmt::format(
          "INSERT INTO temp.fresh SELECT m_cell_id.new AS cell_id, m_instance_id.new AS instance_id, "
          "s.position, s.repetition FROM {} WHERE m_cell_id.new <= {} AND s.attempt_id IN (SELECT id FROM "
          "temp.changed) AND NOT EXISTS (SELECT 1 FROM main.result AS d WHERE d.cell_id = m_cell_id.new AND "
          "d.instance_id = m_instance_id.new AND d.position = s.position AND d.repetition = s.repetition)",
          source.from, last_cell_)));
    }
    if (is_of_a_planning(table)) {
      condition = fmt::format(
          "(m_cell_id.new > {} OR EXISTS (SELECT 1 FROM temp.fresh WHERE fresh.cell_id = m_cell_id.new AND "
          "fresh.instance_id = m_instance_id.new AND fresh.position = s.position AND "
          "fresh.repetition = s.repetition))",
          last_cell_);
    }
    if (table.name == "cell_summary") {
      condition = fmt::format(
          "NOT EXISTS (SELECT 1 FROM main.cell AS d WHERE (d.case_id, d.run_id) = (m_case_id.new, "
          "m_run_id.new) "
          "AND d.id <= {})",
          last_cell_);
    }
    const std::string sql =
        fmt::format("INSERT INTO main.\"{}\" ({}) SELECT {} FROM {} WHERE {}{} ON CONFLICT DO NOTHING",
                    table.name, columns, expressions, source.from, condition, order_of(table, source));
    SIPPLAB_TRY(run(sql));
    const std::int64_t added = connection_.changes();
    if (added > 0) report_.added.emplace_back(table.name, added);
    return table.has_key ? map_keys(table, source) : Result<Done>{Done{}};
  }

  /// Of a planning that two files hold, all that is said comes from one of them.
  static bool is_of_a_planning(const TableShape& table) {
    constexpr std::string_view kPlanning[] = {"cell_id", "instance_id", "position", "repetition"};
    return std::all_of(std::begin(kPlanning), std::end(kPlanning), [&table](std::string_view column) {
      return std::find(table.columns.begin(), table.columns.end(), column) != table.columns.end();
    });
  }

  /// In which the pages of the destination lie.
  static std::string order_of(const TableShape& table, const Source& source) {
    if (table.has_key) return " ORDER BY s.id";
    std::string order;
    if (table.unique.empty()) return order;
    for (const std::string& column : table.unique.front()) {
      order += fmt::format("{} {}", order.empty() ? " ORDER BY" : ",", source.expression(table, column));
    }
    return order;
  }

  /// Which key a row of the source has here.
  Result<Done> map_keys(const TableShape& table, const Source& source) {
    for (const auto& key : table.unique) {
      std::string same;
      for (const std::string& column : key) {
        same += fmt::format("{}d.\"{}\" = {}", same.empty() ? "" : " AND ", column,
                            source.expression(table, column));
      }
      // CROSS JOIN: each row of the source looks for itself through the index.
      SIPPLAB_TRY(run(
          fmt::format("INSERT OR IGNORE INTO {} SELECT s.id, d.id FROM {} CROSS JOIN main.\"{}\" AS d ON {}",
                      key_map(table), source.from, table.name, same)));
    }
    return Done{};
  }

  /// What may have changed in rows that both have.
  Result<Done> bring_up_to_date() {
    constexpr std::string_view kUpdates[] = {
        "UPDATE main.commit_ SET ancestor_count = max(commit_.ancestor_count, s.ancestor_count), "
        "first_parent_count = max(commit_.first_parent_count, s.first_parent_count) "
        "FROM shard.commit_ AS s WHERE s.hash = commit_.hash AND (s.ancestor_count > commit_.ancestor_count "
        "OR s.first_parent_count > commit_.first_parent_count)",
        "UPDATE main.run SET status = s.status, "
        "ended_utc = max(ifnull(run.ended_utc, s.ended_utc), s.ended_utc) FROM shard.run AS s "
        "WHERE s.uuid = run.uuid AND s.status <> run.status AND (s.status = 'finished' OR run.status = "
        "'running')",
        "UPDATE main.run SET excluded_reason = s.excluded_reason, excluded_utc = s.excluded_utc, "
        "included_utc = s.included_utc FROM shard.run AS s WHERE s.uuid = run.uuid AND "
        "max(ifnull(s.excluded_utc, ''), ifnull(s.included_utc, '')) > "
        "max(ifnull(run.excluded_utc, ''), ifnull(run.included_utc, ''))",
        "UPDATE main.finding SET last_utc = s.last_utc, "
        "last_commit_id = (SELECT new FROM temp.key_commit_ WHERE old = s.last_commit_id) "
        "FROM shard.finding AS s WHERE s.target = finding.target AND s.signature = finding.signature "
        "AND s.last_utc > finding.last_utc",
        "UPDATE main.finding SET first_utc = s.first_utc, "
        "first_commit_id = (SELECT new FROM temp.key_commit_ WHERE old = s.first_commit_id) "
        "FROM shard.finding AS s WHERE s.target = finding.target AND s.signature = finding.signature "
        "AND s.first_utc < finding.first_utc",
        "UPDATE main.instance_bound SET flowtime_bound_s = max(instance_bound.flowtime_bound_s, "
        "s.flowtime_bound_s), makespan_bound_s = max(instance_bound.makespan_bound_s, s.makespan_bound_s) "
        "FROM shard.instance_bound AS s JOIN temp.key_instance AS m ON m.old = s.instance_id "
        "WHERE m.new = instance_bound.instance_id AND s.any_angle = instance_bound.any_angle "
        "AND s.connectedness = instance_bound.connectedness "
        "AND (s.flowtime_bound_s > instance_bound.flowtime_bound_s "
        "OR s.makespan_bound_s > instance_bound.makespan_bound_s)",
        "UPDATE main.finding SET minimal = s.minimal, robots = s.robots, cells = s.cells "
        "FROM shard.finding AS s WHERE s.target = finding.target AND s.signature = finding.signature "
        "AND length(s.minimal) < length(finding.minimal)",
        "UPDATE main.best_known SET lower_cost = max(best_known.lower_cost, s.lower_cost), "
        "solution_cost = min(best_known.solution_cost, s.solution_cost) FROM shard.best_known AS s "
        "WHERE s.map_name = best_known.map_name AND s.scen_type = best_known.scen_type "
        "AND s.type_id = best_known.type_id AND s.agents = best_known.agents",
        // Not the sum of both: merging a file twice is to change nothing.
        "UPDATE main.finding SET times_found = s.times_found "
        "FROM shard.finding AS s WHERE s.target = finding.target AND s.signature = finding.signature "
        "AND s.times_found > finding.times_found",
        // The state follows from the events of both lives and from when it was last seen to break.
        "UPDATE main.finding SET "
        "state = CASE WHEN life.fixed_utc IS NULL THEN iif(life.reproduced, 'reproduced', 'new') "
        "WHEN finding.last_utc > life.fixed_utc THEN 'regressed' ELSE 'fixed' END, "
        "fixed_commit_id = CASE WHEN finding.last_utc <= life.fixed_utc THEN (SELECT commit_id "
        "FROM main.finding_event WHERE finding_id = finding.id AND event = 'fixed' "
        "AND happened_utc = life.fixed_utc) END "
        "FROM (SELECT finding_id, max(iif(event = 'fixed', happened_utc, NULL)) AS fixed_utc, "
        "max(event = 'reproduced') AS reproduced FROM main.finding_event GROUP BY finding_id) AS life "
        "WHERE life.finding_id = finding.id AND EXISTS (SELECT 1 FROM shard.finding AS s "
        "WHERE s.target = finding.target AND s.signature = finding.signature)",
    };
    constexpr std::size_t kName = std::string_view("UPDATE main.").size();
    for (const std::string_view sql : kUpdates) {
      if (!filled_.contains(sql.substr(kName, sql.find(' ', kName) - kName))) continue;
      SIPPLAB_TRY(connection_.execute(std::string(sql), kMerging));
    }
    return Done{};
  }

  /// Runs and cells that were here and got results: what is said of them together.
  Result<Done> settle() {
    constexpr const char* kUpdates[] = {
        "UPDATE main.attempt SET ended_utc = s.ended_utc, status = s.status, cpu_time_ns = s.cpu_time_ns, "
        "peak_memory_bytes = s.peak_memory_bytes FROM shard.attempt AS s "
        "WHERE s.uuid = attempt.uuid AND s.ended_utc >= attempt.ended_utc AND s.id IN (SELECT id FROM "
        "temp.changed)",
        "UPDATE main.cell SET result_count = cell.result_count + n, finished_utc = max(cell.finished_utc, "
        "s.finished_utc) "
        "FROM (SELECT cell_id, count(*) AS n FROM temp.fresh GROUP BY cell_id) AS more, "
        "temp.key_cell AS m JOIN shard.cell AS s ON s.id = m.old WHERE more.cell_id = cell.id AND m.new = "
        "cell.id",
        // Made again by summarise_cells().
        "DELETE FROM main.cell_summary WHERE (case_id, run_id) IN "
        "(SELECT case_id, run_id FROM main.cell WHERE id IN (SELECT cell_id FROM temp.fresh))",
        "UPDATE main.run SET started_utc = min(run.started_utc, s.started_utc), "
        "ended_utc = max(ifnull(run.ended_utc, s.ended_utc), ifnull(s.ended_utc, run.ended_utc)) "
        "FROM shard.run AS s WHERE s.uuid = run.uuid AND s.id IN (SELECT run_id FROM temp.changed)",
    };
    for (const char* sql : kUpdates) SIPPLAB_TRY(connection_.execute(sql, kMerging));
    auto select = SIPPLAB_TRY(Statement::prepare(
        connection_,
        "SELECT new FROM temp.key_run WHERE old IN (SELECT run_id FROM temp.changed) ORDER BY new",
        kMerging));
    const auto runs = SIPPLAB_TRY(select.collect([](const Statement& row) { return row.integer(0); }));
    for (const std::int64_t run : runs) SIPPLAB_TRY(settle_sweep(connection_, run));
    return Done{};
  }

  /// Of this merge; it may be there from the one before.
  Result<Done> empty_table(const std::string& name, const char* definition) {
    SIPPLAB_TRY(
        connection_.execute(fmt::format("CREATE TABLE IF NOT EXISTS {} {}", name, definition), kMerging));
    return connection_.execute("DELETE FROM " + name, kMerging);
  }

  Result<Done> run(const std::string& sql) {
    auto statement = SIPPLAB_TRY(Statement::prepare(connection_, sql, kMerging));
    if (sql.find("?1") != std::string::npos) statement.bind(origin_);
    return statement.run();
  }

  Connection& connection_;
  std::vector<TableShape> tables_;
  std::string origin_;
  std::set<std::string, std::less<>> filled_;  ///< tables of the source that have rows
  std::int64_t last_cell_ = 0;
  MergeReport report_;
};

}  // namespace

Result<std::vector<TableShape>> tables_of(Connection& connection) {
  const auto names = SIPPLAB_TRY(
      rows_of(connection,
              "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%' "
              "ORDER BY rowid",
              1));
  std::vector<TableShape> waiting;
  for (const auto& name : names) {
    waiting.push_back(SIPPLAB_TRY(shape_of(connection, name[0])));
  }
  std::vector<TableShape> ordered;
  std::set<std::string> placed;
  while (!waiting.empty()) {
    const auto ready = std::find_if(waiting.begin(), waiting.end(), [&placed](const TableShape& shape) {
      return std::all_of(shape.references.begin(), shape.references.end(), [&](const Reference& reference) {
        return reference.parent == shape.name || placed.count(reference.parent) == 1;
      });
    });
    const auto next = ready == waiting.end() ? waiting.begin() : ready;
    placed.insert(next->name);
    ordered.push_back(std::move(*next));
    waiting.erase(next);
  }
  return ordered;
}

Result<Done> attach(Connection& connection, const fs::path& source) {
  {
    // Says what is wrong with it, and brings it to this version.
    const auto readable = SIPPLAB_TRY(Database::open_read_only(source));
    if (readable.is_immutable()) {
      return sqlite::run(connection, "ATTACH ? AS shard", "opening what is merged",
                         sqlite::immutable_uri(source.string()));
    }
  }
  // A file of no folder, and names that SQLite takes for something else.
  return sqlite::run(connection, "ATTACH ? AS shard", "opening what is merged",
                     fs::absolute(source).string());
}

Result<MergeReport> merge_attached(Connection& connection, const std::vector<TableShape>& tables,
                                   const std::string& origin, bool is_history) {
  auto report = [&]() -> Result<MergeReport> {
    auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
    auto merged = SIPPLAB_TRY(Merge(connection, tables, origin).run());
    if (is_history) SIPPLAB_TRY(summarise_cells(connection));
    SIPPLAB_TRY(transaction.commit());
    return merged;
  }();
  // A file that stays attached is in the way of the next one.
  const auto detached = connection.execute("DETACH shard", kMerging);
  if (report && !detached) return Unexpected{detached.error()};
  return report;
}

}  // namespace sipplab::db
