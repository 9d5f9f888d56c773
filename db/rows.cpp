// Insert a row or find it: one statement each, which ends in the row's key.
#include "db/rows.hpp"

#include <fmt/core.h>
#include <sqlite3.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

namespace sipplab::db {
namespace {

/// What a statement that ends in RETURNING id returns.
Result<std::int64_t> key_of(sqlite::Statement& statement) {
  SIPPLAB_TRY(statement.step());
  const std::int64_t id = statement.integer(0);
  SIPPLAB_TRY(statement.run());
  return id;
}

// RETURNING answers for a row that was there only when the conflict changes it, so
// each statement sets a column to what it is.
template <class... Values>
Result<std::int64_t> upsert(sqlite::Connection& connection, std::string_view sql, std::string_view doing,
                            const Values&... values) {
  auto statement = SIPPLAB_TRY(sqlite::Statement::prepare(connection, sql, doing, values...));
  return key_of(statement);
}

}  // namespace

std::optional<std::string> null_if_empty(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return text;
}

Value value_of(sqlite3_stmt* row, int column) {
  const auto bytes = [&](const void* data) {
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
    return data == nullptr ? std::string{} : std::string{static_cast<const char*>(data), size};
  };
  switch (sqlite3_column_type(row, column)) {
    case SQLITE_INTEGER:
      return static_cast<std::int64_t>(sqlite3_column_int64(row, column));
    case SQLITE_FLOAT:
      return sqlite3_column_double(row, column);
    case SQLITE_TEXT:
      return bytes(sqlite3_column_text(row, column));
    case SQLITE_BLOB:
      return Blob{bytes(sqlite3_column_blob(row, column))};
    default:
      return Null{};
  }
}

Result<Table> rest_of(sqlite::Statement statement) {
  Table table;
  const int count = sqlite3_column_count(statement.raw());
  for (int i = 0; i < count; ++i) table.columns.emplace_back(sqlite3_column_name(statement.raw(), i));
  SIPPLAB_TRY(statement.for_each([&] {
    std::vector<Value>& values = table.rows.emplace_back();
    for (int i = 0; i < count; ++i) values.push_back(value_of(statement.raw(), i));
  }));
  return table;
}

std::int64_t to_count(std::uint64_t value) {
  return static_cast<std::int64_t>(std::min(value, kNoCountLimit));
}

std::int64_t to_bits(std::uint64_t value) { return static_cast<std::int64_t>(value); }

void detail::bind(sqlite::Statement& statement, int index, const Value& value) {
  const auto bind = [&statement, index](const auto& bound) {
    using Bound = std::decay_t<decltype(bound)>;
    if constexpr (std::is_same_v<Bound, Null> || std::is_same_v<Bound, Blob>) {
      statement.bind_at(index, std::nullopt);
    } else {
      statement.bind_at(index, bound);
    }
  };
  std::visit(bind, value);
}

Result<std::int64_t> commit_id(sqlite::Connection& connection, const CommitInfo& commit) {
  // A shallow clone does not know the counts; a full one fills them in.
  const auto id = SIPPLAB_TRY(
      upsert(connection,
             "INSERT INTO commit_ (hash, committed_utc, subject, first_parent_hash, ancestor_count, "
             "first_parent_count) VALUES (?, ?, ?, ?, ?, ?) "
             "ON CONFLICT (hash) DO UPDATE SET "
             "ancestor_count = max(ancestor_count, excluded.ancestor_count), "
             "first_parent_count = max(first_parent_count, excluded.first_parent_count) RETURNING id",
             "writing a commit", commit.hash, commit.committed_utc, commit.subject, commit.first_parent,
             commit.ancestor_count, commit.first_parent_count));
  std::vector<std::string> parents;
  if (!commit.first_parent.empty()) parents.push_back(commit.first_parent);
  parents.insert(parents.end(), commit.later_parents.begin(), commit.later_parents.end());
  for (std::size_t position = 0; position < parents.size(); ++position) {
    SIPPLAB_TRY(sqlite::run(
        connection, "INSERT OR IGNORE INTO commit_parent (commit_id, position, parent_hash) VALUES (?, ?, ?)",
        "writing the parents of a commit", id, static_cast<std::int64_t>(position), parents[position]));
  }
  return id;
}

Result<std::int64_t> machine_id(sqlite::Connection& connection, const MachineInfo& machine) {
  return upsert(connection,
                "INSERT INTO machine (fingerprint, host, cpu_model, cores, memory_bytes, kernel) "
                "VALUES (?, ?, ?, ?, ?, ?) "
                "ON CONFLICT (fingerprint) DO UPDATE SET host = host RETURNING id",
                "writing a machine", fingerprint(machine), machine.host, machine.cpu_model, machine.cores,
                machine.memory_bytes, machine.kernel);
}

Result<std::int64_t> build_id(sqlite::Connection& connection, const BuildInfo& build) {
  return upsert(connection,
                "INSERT INTO build (compiler, compiler_version, flags, build_type, assertions, sanitizers, "
                "binary_hash, dirty) VALUES (?, ?, ?, ?, ?, ?, ?, ?) "
                "ON CONFLICT DO UPDATE SET dirty = dirty RETURNING id",
                "writing a build", build.compiler, build.compiler_version, build.flags, build.build_type,
                build.assertions, build.sanitizers, build.binary_hash, build.dirty);
}

Result<std::optional<std::int64_t>> commit_id(sqlite::Connection& connection,
                                              const std::optional<CommitInfo>& commit) {
  if (!commit) return std::optional<std::int64_t>{};
  const auto id = SIPPLAB_TRY(commit_id(connection, *commit));
  return std::optional<std::int64_t>{id};
}

Result<std::optional<std::int64_t>> insert_run(sqlite::Connection& connection, const RunOrigin& origin,
                                               const RunRow& run) {
  const auto commit = SIPPLAB_TRY(commit_id(connection, origin.commit));
  const auto machine = SIPPLAB_TRY(machine_id(connection, origin.machine));
  const auto build = SIPPLAB_TRY(build_id(connection, origin.build));
  SIPPLAB_TRY(sqlite::run(
      connection,
      "INSERT INTO run (uuid, kind, suite, started_utc, outcome, commit_id, machine_id, build_id, branch, "
      "command_line, options, seed, time_limit_s, writer, shard, planned, status, ended_utc) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?17, "
      "iif(?16 IS NULL, 'running', 'finished'), iif(?16 IS NULL, NULL, ifnull("
      "strftime('%Y-%m-%dT%H:%M:%fZ', ?4, printf('+%.3f seconds', ?16 / 1e9)), ?4))) "
      "ON CONFLICT (uuid) DO NOTHING",
      "listing a run", run.uuid, run.kind, run.suite, run.started_utc, run.outcome, commit, machine, build,
      origin.branch, run.command_line, run.options, to_bits(run.seed), run.time_limit_s, run.writer,
      run.shard, run.wall_time_ns, run.planned));
  if (connection.changes() == 0) return std::optional<std::int64_t>{};
  return std::optional<std::int64_t>{connection.last_insert_rowid()};
}

Result<Done> settle_sweep(sqlite::Connection& connection, std::int64_t run_id) {
  constexpr const char* kSettling = "settling a sweep";
  // Parts that came together: finished is what has all of its plannings.
  SIPPLAB_TRY(
      sqlite::run(connection,
                  "UPDATE run SET shard = '', status = CASE WHEN status = 'running' AND origin = '' "
                  "THEN status WHEN planned <= (SELECT sum(result_count) FROM cell WHERE run_id = run.id) "
                  "THEN 'finished' ELSE 'aborted' END "
                  "WHERE id = ? AND planned IS NOT NULL AND (SELECT count(DISTINCT shard) FROM attempt "
                  "WHERE run_id = run.id) > 1",
                  kSettling, run_id));
  // The fingerprint is of this run alone.
  SIPPLAB_TRY(sqlite::run(
      connection,
      "WITH used AS (SELECT DISTINCT machine.* FROM attempt JOIN machine ON machine.id = machine_id "
      "WHERE run_id = ?1) "
      "INSERT INTO machine (fingerprint, host, cpu_model, cores, memory_bytes, kernel) "
      "SELECT substr(replace(uuid, '-', ''), 1, 16), "
      "(SELECT group_concat(host, ', ') FROM (SELECT DISTINCT host FROM used ORDER BY host)), "
      "(SELECT count(*) FROM used) || ' machines: ' || "
      "(SELECT group_concat(cpu_model, ', ') FROM (SELECT DISTINCT cpu_model FROM used ORDER BY cpu_model)), "
      "(SELECT max(cores) FROM used), (SELECT max(memory_bytes) FROM used), "
      "(SELECT group_concat(kernel, ', ') FROM (SELECT DISTINCT kernel FROM used ORDER BY kernel)) "
      "FROM run WHERE id = ?1 AND (SELECT count(*) FROM used) > 1 "
      "ON CONFLICT (fingerprint) DO UPDATE SET host = excluded.host, cpu_model = excluded.cpu_model, "
      "cores = excluded.cores, memory_bytes = excluded.memory_bytes, kernel = excluded.kernel",
      kSettling, run_id));
  return sqlite::run(connection,
                     "UPDATE run SET machine_id = machine.id FROM machine WHERE run.id = ? AND "
                     "machine.fingerprint = substr(replace(run.uuid, '-', ''), 1, 16)",
                     kSettling, run_id);
}

Result<std::set<std::string>> case_columns(sqlite::Connection& connection) {
  auto select = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection, "SELECT name FROM pragma_table_info('case_')", "reading the columns of cases"));
  std::set<std::string> columns;
  SIPPLAB_TRY(select.for_each([&] { columns.insert(select.text(0)); }));
  return columns;
}

Result<std::int64_t> case_id(sqlite::Connection& connection, const CaseInfo& parameters) {
  const auto columns = SIPPLAB_TRY(case_columns(connection));
  nlohmann::json others = nlohmann::json::object();
  for (const auto& [name, value] : parameters.options) {
    if (columns.contains(name)) continue;
    std::visit(
        [&json = others[name]](const auto& kept) {
          if constexpr (std::is_constructible_v<nlohmann::json, decltype(kept)>) json = kept;
        },
        value);
  }
  const auto each = [&](const auto& visit) {
    CaseInfo::columns(parameters, visit);
    for (const auto& [name, value] : parameters.options) {
      if (columns.contains(name)) visit(name, value);
    }
    visit("options", others.dump());
  };
  auto insert = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection, insert_sql("case_", each) + " ON CONFLICT DO UPDATE SET robots = robots RETURNING id",
      "writing a case"));
  return key_of(bind_row(insert, each));
}

Result<InstanceKeys> InstanceKeys::prepare(sqlite::Connection& connection) {
  auto select = SIPPLAB_TRY(sqlite::Statement::prepare(
      connection, "SELECT id FROM instance WHERE content_hash = ?", "looking up an instance"));
  auto insert = SIPPLAB_TRY(
      sqlite::Statement::prepare(connection,
                                 "INSERT INTO instance (content_hash, map_hash, name, robots, "
                                 "width_cells, height_cells, blocked_cells) VALUES (?, ?, ?, ?, ?, ?, ?)",
                                 "writing an instance"));
  return InstanceKeys{&connection, std::move(select), std::move(insert)};
}

Result<std::int64_t> InstanceKeys::key(const InstanceInfo& instance) {
  const auto row = SIPPLAB_TRY(select_.bind(instance.content_hash).step());
  const std::int64_t known = row ? select_.integer(0) : 0;
  select_.reset();
  if (row) return known;
  SIPPLAB_TRY(insert_
                  .bind(instance.content_hash, instance.map_hash, instance.name, instance.robots,
                        instance.width_cells, instance.height_cells, instance.blocked_cells)
                  .run());
  return connection_->last_insert_rowid();
}

CaseInfo read_case(const sqlite::Statement& row, int column) {
  CaseInfo parameters;
  std::set<std::string_view> plain{"id", "options"};
  read_row(row, [&](const auto& visit) {
    CaseInfo::columns(parameters, [&](std::string_view name, auto& value) {
      plain.insert(name);
      visit(name, value);
    });
  });
  for (; column < sqlite3_column_count(row.raw()); ++column) {
    const std::string name = sqlite3_column_name(row.raw(), column);
    if (!plain.contains(name)) parameters.options[name] = value_of(row.raw(), column);
    if (name != "options") continue;
    const auto others = nlohmann::json::parse(row.text(column), nullptr, false);
    for (const auto& [option, value] : others.items()) {
      Value& kept = parameters.options[option];
      if (value.is_number_integer()) kept = value.get<std::int64_t>();
      if (value.is_number_float()) kept = value.get<double>();
      if (value.is_string()) kept = value.get<std::string>();
    }
  }
  return parameters;
}

}  // namespace sipplab::db
