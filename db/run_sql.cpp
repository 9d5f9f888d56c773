// One statement that reads, guarded three times: the file is open read-only, an
// authorizer refuses whatever is not reading, and query_only stands behind both.
#include <fmt/core.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>

#include "db/queries.hpp"
#include "db/rows.hpp"
#include "db/sqlite/handle.hpp"
#include "db/statistics/sqlite_functions.hpp"
#include "planner/core/number.hpp"

namespace sipplab::db {
namespace {

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using StatementPtr = std::unique_ptr<sqlite3_stmt, Finalize>;

/// PRAGMAs that tell something; their argument says about what.
constexpr std::array<std::string_view, 10> kTelling{
    "collation_list", "foreign_key_check", "foreign_key_list", "index_info", "index_list",
    "index_xinfo",    "integrity_check",   "quick_check",      "table_info", "table_xinfo"};
/// PRAGMAs whose argument would set something.
constexpr std::array<std::string_view, 12> kTellingWithoutArgument{
    "application_id", "compile_options", "database_list", "encoding",       "freelist_count", "function_list",
    "journal_mode",   "page_count",      "page_size",     "schema_version", "table_list",     "user_version"};

bool is_telling_pragma(std::string_view pragma, const char* argument) {
  const auto has = [&](const auto& list) {
    return std::find(list.begin(), list.end(), pragma) != list.end();
  };
  return has(kTelling) || (argument == nullptr && has(kTellingWithoutArgument));
}

/// What the refused part of a statement would do, in a word or two.
std::string_view action_name(int action) {
  switch (action) {
    case SQLITE_INSERT:
      return "INSERT";
    case SQLITE_UPDATE:
      return "UPDATE";
    case SQLITE_DELETE:
      return "DELETE";
    case SQLITE_ATTACH:
      return "ATTACH";
    case SQLITE_DETACH:
      return "DETACH";
    case SQLITE_TRANSACTION:
    case SQLITE_SAVEPOINT:
      return "a transaction";
    case SQLITE_PRAGMA:
      return "a PRAGMA that sets something";
    case SQLITE_FUNCTION:
      return "loading an extension";
    case SQLITE_REINDEX:
    case SQLITE_ANALYZE:
      return "REINDEX or ANALYZE";
    default:
      return "CREATE, ALTER or DROP";
  }
}

/// Context: a std::string that receives the name of what is refused.
int allow_reading(void* refused, int action, const char* first, const char* second, const char*,
                  const char*) {
  bool allowed = false;
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
    case SQLITE_RECURSIVE:
      allowed = true;
      break;
    case SQLITE_FUNCTION:
      allowed = second == nullptr || std::string_view{second} != "load_extension";
      break;
    case SQLITE_PRAGMA:
      allowed = first != nullptr && is_telling_pragma(first, second);
      break;
    case SQLITE_UPDATE:
      // SQLite says this while it declares the columns of pragma_table_list, json_each
      // and their like. A real UPDATE of the schema is refused by SQLite itself.
      allowed = first != nullptr && std::string_view{first} == "sqlite_master";
      break;
    default:
      break;
  }
  if (allowed) return SQLITE_OK;
  auto* name = static_cast<std::string*>(refused);
  if (name->empty()) *name = action_name(action);
  return SQLITE_DENY;
}

Error bad_query(const std::string& file, std::string_view what) {
  return {ErrorKind::kBadQuery, fmt::format("{}: {}", file, what)};
}

Error refusal(const std::string& file, std::string_view refused) {
  return bad_query(
      file, fmt::format("{} is refused, expected a statement that only reads, such as SELECT", refused));
}

/// Whether anything but blanks, comments and semicolons is left.
bool has_statement(sqlite3* db, const char* text) {
  while (*text != '\0') {
    sqlite3_stmt* next = nullptr;
    const char* tail = nullptr;
    const int code = sqlite3_prepare_v2(db, text, -1, &next, &tail);
    const StatementPtr owner{next};
    if (code != SQLITE_OK || next != nullptr) return true;
    if (tail == nullptr || tail == text) return false;
    text = tail;
  }
  return false;
}

Result<Table> read_rows(const sqlite::Handle& handle, sqlite3_stmt* statement) {
  Table table;
  const int count = sqlite3_column_count(statement);
  for (int i = 0; i < count; ++i) table.columns.emplace_back(sqlite3_column_name(statement, i));
  for (;;) {
    const int code = sqlite3_step(statement);
    if (code == SQLITE_DONE) return table;
    // Such as a function that does not take its arguments: the query's fault.
    if (code == SQLITE_ERROR) return Unexpected{bad_query(handle.name, sqlite3_errmsg(handle.db))};
    if (code != SQLITE_ROW) return Unexpected{sqlite::describe(handle, code, "running the query")};
    std::vector<Value> row;
    row.reserve(table.columns.size());
    for (int i = 0; i < count; ++i) row.push_back(value_of(statement, i));
    table.rows.push_back(std::move(row));
  }
}

using Parameters = std::vector<std::pair<std::string, std::string>>;

/// :run and :other as UUIDs; what is not asked for may be missing from the history.
Result<std::string> run_parameter(Database& database, std::string_view name, const Parameters& given) {
  std::string run = "latest";
  for (const auto& [key, value] : given) {
    if (key == name) return resolve_run(database, value);
    if (key == "run") run = value;
  }
  const auto uuid = resolve_run(database, run);
  if (!uuid || name == "run") return uuid;
  const auto before = SIPPLAB_TRY(run_before(database, *uuid));
  if (before) return *before;
  return Unexpected{
      Error{ErrorKind::kNotFound,
            fmt::format("{}: no run of the same suite before {}, expected one, or --param other=RUN",
                        database.path().string(), *uuid)}};
}

void bind_text_or_number(sqlite3_stmt* statement, int index, const std::string& text) {
  const auto real = parse_number<double>(text);
  if (const auto whole = parse_number<std::int64_t>(text)) {
    sqlite3_bind_int64(statement, index, *whole);
  } else if (real && !std::isnan(*real)) {
    sqlite3_bind_double(statement, index, *real);
  } else {
    sqlite3_bind_text(statement, index, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
}

Result<Done> bind_parameters(Database& database, sqlite3_stmt* statement, const Parameters& given) {
  const std::string file = database.path().string();
  for (const auto& [key, value] : given) {
    if (sqlite3_bind_parameter_index(statement, (":" + key).c_str()) == 0) {
      return Unexpected{bad_query(
          file, fmt::format("parameter {}, expected one that stands as :{} in the query", key, key))};
    }
  }
  for (int index = 1; index <= sqlite3_bind_parameter_count(statement); ++index) {
    const char* raw_name = sqlite3_bind_parameter_name(statement, index);
    const std::string name = raw_name == nullptr ? "?" : raw_name + 1;
    const auto found = std::find_if(given.begin(), given.end(),
                                    [&name](const auto& parameter) { return parameter.first == name; });
    if (name == "run" || name == "other") {
      const auto uuid = SIPPLAB_TRY(run_parameter(database, name, given));
      sqlite3_bind_text(statement, index, uuid.data(), static_cast<int>(uuid.size()), SQLITE_TRANSIENT);
    } else if (found != given.end()) {
      bind_text_or_number(statement, index, found->second);
    } else {
      if (raw_name == nullptr || raw_name[0] != ':') {
        return Unexpected{bad_query(file, fmt::format("parameter {}, expected one that begins with a colon",
                                                      raw_name == nullptr ? "?" : raw_name))};
      }
      return Unexpected{bad_query(file, fmt::format("no value for :{0}, expected --param {0}=VALUE", name))};
    }
  }
  return Done{};
}

}  // namespace

Result<Table> run_sql(const std::filesystem::path& path, const std::string& sql,
                      const Parameters& parameters) {
  auto database = SIPPLAB_TRY(Database::open_read_only(path));
  auto& connection = database.connection();
  SIPPLAB_TRY(connection.execute("PRAGMA query_only = ON", "preparing it for reading"));
  sqlite3* db = connection.raw();
  if (const int code = statistics::register_functions(db); code != SQLITE_OK) {
    return Unexpected{sqlite::describe(connection.handle(), code, "adding the statistics functions")};
  }
  // Read now: a query with a mistake that is the first to need the schema ends with SQLITE_SCHEMA.
  SIPPLAB_TRY(connection.query_int("SELECT count(*) FROM sqlite_schema", "reading the schema"));
  std::string refused;
  sqlite3_set_authorizer(db, allow_reading, &refused);

  sqlite3_stmt* prepared = nullptr;
  const char* tail = nullptr;
  const int code = sqlite::retry_while_busy(
      connection.handle(), [&] { return sqlite3_prepare_v2(db, sql.c_str(), -1, &prepared, &tail); });
  const StatementPtr statement{prepared};
  const std::string& file = connection.name();
  if (!refused.empty()) return Unexpected{refusal(file, refused)};
  if (code == SQLITE_ERROR) return Unexpected{bad_query(file, sqlite3_errmsg(db))};
  if (code != SQLITE_OK) return Unexpected{sqlite::describe(connection.handle(), code, "reading the query")};
  if (statement == nullptr) {
    return Unexpected{bad_query(file, "an empty statement, expected one such as SELECT * FROM v_runs")};
  }
  if (sqlite3_stmt_readonly(statement.get()) == 0)
    return Unexpected{refusal(file, "a statement that writes")};
  if (has_statement(db, tail)) {
    return Unexpected{bad_query(file, "more than one statement, expected a single one")};
  }
  SIPPLAB_TRY(bind_parameters(database, statement.get(), parameters));
  return read_rows(connection.handle(), statement.get());
}

}  // namespace sipplab::db
