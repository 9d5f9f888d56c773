// SQL from users: typed answers, and nothing that writes.
#include <limits>

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::must;

class RunSql : public test::DatabaseTest {
 protected:
  RunSql() {
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run()));
    test::record_case(recorder, test::sample_case(64), 3);
    must(recorder.finish(RunStatus::kFinished));
  }

  void expect_refused(const std::string& sql, const std::string& words) {
    const std::string before = test::bytes_of(file);
    const auto result = run_sql(file, sql);
    ASSERT_FALSE(result) << sql;
    EXPECT_EQ(result.error().kind, ErrorKind::kBadQuery) << sql;
    EXPECT_NE(result.error().message.find(words), std::string::npos) << sql << ": " << result.error().message;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << sql;
    EXPECT_EQ(test::bytes_of(file), before) << sql;
  }
};

TEST_F(RunSql, values_keep_their_types) {
  const Table table =
      must(run_sql(file,
                   "SELECT 1 AS i, 2.5 AS r, 'x' AS t, NULL AS n, x'00ff' AS b, 9e999 AS inf, "
                   "-9223372036854775808 AS least, 'a' || char(0) || 'b' AS zero"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"i", "r", "t", "n", "b", "inf", "least", "zero"}));
  const std::vector<Value> expected{std::int64_t{1},
                                    2.5,
                                    std::string{"x"},
                                    Null{},
                                    Blob{std::string("\0\xff", 2)},
                                    std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<std::int64_t>::min(),
                                    std::string("a\0b", 3)};
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0], expected);
}

TEST_F(RunSql, reading_is_allowed) {
  for (const char* sql :
       {"SELECT * FROM v_runs", "SELECT * FROM v_run_cells;", "SELECT * FROM v_results -- all of it\n;",
        "SELECT * FROM v_slowest LIMIT 1 /* one */", "SELECT * FROM v_flips",
        "WITH t AS (SELECT 1) SELECT * FROM t",
        "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n WHERE i < 3) SELECT * FROM n",
        "VALUES (1)", "EXPLAIN QUERY PLAN SELECT * FROM v_runs", "PRAGMA user_version",
        "PRAGMA table_info(run)", "PRAGMA integrity_check", "PRAGMA foreign_key_check",
        "SELECT name FROM pragma_table_list", "SELECT value FROM json_each('[1, 2]')",
        "SELECT json_object('a', 1)", "SELECT sql FROM sqlite_schema"}) {
    const auto result = run_sql(file, sql);
    EXPECT_TRUE(result) << sql << ": " << (result ? "" : result.error().message);
  }
}

TEST_F(RunSql, writing_is_refused) {
  expect_refused("INSERT INTO instance (content_hash) VALUES ('x')", "INSERT is refused");
  expect_refused("UPDATE run SET suite = 'x'", "UPDATE is refused");
  expect_refused("DELETE FROM result", "DELETE is refused");
  expect_refused("WITH t AS (SELECT 1) DELETE FROM result", "DELETE is refused");
  expect_refused("UPDATE sqlite_schema SET sql = ''", "may not be modified");
  expect_refused("CREATE TABLE x (y)", "refused");
  expect_refused("CREATE TEMP TABLE x (y)", "refused");
  expect_refused("DROP VIEW v_runs", "refused");
  expect_refused("ALTER TABLE run ADD COLUMN x", "refused");
  expect_refused("ATTACH 'other.db' AS other", "ATTACH is refused");
  expect_refused("VACUUM INTO 'copy.db'", "refused");
  expect_refused("BEGIN IMMEDIATE", "refused");
  expect_refused("REINDEX", "refused");
  expect_refused("PRAGMA user_version = 7", "PRAGMA");
  expect_refused("PRAGMA journal_mode = DELETE", "PRAGMA");
  expect_refused("PRAGMA query_only = OFF", "PRAGMA");
  expect_refused("PRAGMA writable_schema(1)", "PRAGMA");
  expect_refused("PRAGMA wal_checkpoint", "PRAGMA");
  expect_refused("SELECT load_extension('x')", "refused");
  EXPECT_FALSE(std::filesystem::exists(folder / "copy.db"));
}

TEST_F(RunSql, one_statement_at_a_time) {
  expect_refused("SELECT 1; SELECT 2", "more than one statement");
  expect_refused("SELECT 1; DELETE FROM run", "more than one statement");
  expect_refused("SELECT 1; nonsense", "more than one statement");
  EXPECT_TRUE(run_sql(file, "SELECT 1;; -- end\n ; "));
}

TEST_F(RunSql, mistakes_are_named) {
  expect_refused("", "an empty statement");
  expect_refused(" -- nothing\n", "an empty statement");
  expect_refused("SELEC 1", "syntax error");
  expect_refused("SELECT nonsense FROM v_runs", "no such column: nonsense");
  expect_refused("SELECT * FROM nowhere", "no such table: nowhere");
}

TEST_F(RunSql, a_missing_file_is_an_error) {
  const auto result = run_sql(folder / "none.db", "SELECT 1");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kNotFound);
}

}  // namespace
}  // namespace sipplab::db
