// Opening: fresh files, old files, files that are something else.
#include "db/database.hpp"

#include <sqlite3.h>

#include <cstdlib>
#include <fstream>

#include "db/migrate.hpp"
#include "db/sqlite/statement.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

class OpenDatabase : public test::DatabaseTest {
 protected:
  /// Expects that both ways of opening refuse the file and leave it as it is.
  void expect_refused(ErrorKind kind, const std::string& words) {
    const std::string before = test::bytes_of(file);
    for (const auto& result : {Database::open(file), Database::open_read_only(file)}) {
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().kind, kind);
      EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
      EXPECT_EQ(result.error().message.find(file.string()), 0U) << result.error().message;
      EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
    }
    EXPECT_EQ(test::bytes_of(file), before);
  }
};

TEST_F(OpenDatabase, a_missing_file_becomes_a_history) {
  test::must(Database::open(file));
  EXPECT_EQ(test::ask(file, "PRAGMA user_version"), std::to_string(Database::latest_schema_version()));
  EXPECT_EQ(test::ask(file, "PRAGMA application_id"), std::to_string(kApplicationId));
  EXPECT_EQ(test::ask(file, "PRAGMA journal_mode"), "wal");
  test::expect_sound(file);
}

TEST_F(OpenDatabase, an_empty_file_becomes_a_history) {
  std::ofstream{file};
  test::must(Database::open(file));
  EXPECT_EQ(test::ask(file, "SELECT count(*) FROM v_runs"), "0");
}

TEST_F(OpenDatabase, opening_twice_changes_nothing) {
  test::must(Database::open(file));
  const std::string schema = test::ask(file, "SELECT group_concat(sql) FROM sqlite_schema");
  const std::string before = test::bytes_of(file);
  test::must(Database::open(file));
  EXPECT_EQ(test::ask(file, "SELECT group_concat(sql) FROM sqlite_schema"), schema);
  EXPECT_EQ(test::bytes_of(file), before);
}

TEST_F(OpenDatabase, every_table_is_strict) {
  test::must(Database::open(file));
  EXPECT_EQ(test::ask(file,
                      "SELECT count(*) FROM pragma_table_list WHERE type = 'table' AND NOT strict "
                      "AND schema = 'main' AND name NOT LIKE 'sqlite%'"),
            "0");
}

TEST_F(OpenDatabase, a_newer_schema_is_refused) {
  test::must(Database::open(file));
  {
    auto connection = test::must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    // The first one that this program must not touch.
    test::must(connection.execute(
        "PRAGMA user_version = " + std::to_string(Database::latest_schema_version() + 1), "ageing"));
  }
  expect_refused(ErrorKind::kNewerSchema,
                 "expected at most " + std::to_string(Database::latest_schema_version()));
}

TEST_F(OpenDatabase, a_schema_older_than_the_first_release_is_refused) {
  test::must(Database::open(file));
  {
    auto connection = test::must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    test::must(connection.execute("PRAGMA user_version = 8", "ageing"));
  }
  expect_refused(ErrorKind::kOlderSchema, "schema version 8, expected at least 9");
}

TEST_F(OpenDatabase, a_file_that_is_no_database_is_refused) {
  std::ofstream{file} << std::string(5000, 'x');
  expect_refused(ErrorKind::kNotADatabase, "not a database");
}

TEST_F(OpenDatabase, a_short_text_file_is_refused) {
  std::ofstream{file} << "width 32\n";
  expect_refused(ErrorKind::kNotADatabase, "not a database");
}

TEST_F(OpenDatabase, a_database_of_another_program_is_refused) {
  {
    auto connection = test::must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    test::must(connection.execute("CREATE TABLE bookmark (url TEXT)", "making another program's table"));
  }
  expect_refused(ErrorKind::kNotADatabase, "database of another program");
}

TEST_F(OpenDatabase, a_directory_is_refused) {
  for (const auto& result : {Database::open(folder), Database::open_read_only(folder)}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().message, folder.string() + ": a directory, expected a database file");
  }
}

TEST_F(OpenDatabase, a_missing_folder_is_named) {
  const auto result = Database::open(folder / "none" / "x.db");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("no folder " + (folder / "none").string()), std::string::npos);
}

TEST_F(OpenDatabase, reading_makes_no_file) {
  const auto result = Database::open_read_only(file);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kNotFound);
  EXPECT_FALSE(std::filesystem::exists(file));
}

std::size_t files_in(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

TEST_F(OpenDatabase, reading_leaves_no_file_beside_it) {
  test::must(Database::open(file));
  ASSERT_EQ(files_in(folder), 1U);
  {
    auto first = test::must(Database::open_read_only(file));
    auto second = test::must(Database::open_read_only(file));
    EXPECT_GT(files_in(folder), 1U);  // else this test shows nothing
  }
  EXPECT_EQ(files_in(folder), 1U);
}

TEST_F(OpenDatabase, a_reader_leaves_the_log_of_a_writer_alone) {
  auto writer = test::must(Database::open(file));
  test::must(
      writer.connection().execute("PRAGMA wal_autocheckpoint = 0; UPDATE run SET suite = suite", "writing"));
  { auto reader = test::must(Database::open_read_only(file)); }
  EXPECT_TRUE(std::filesystem::exists(file.string() + "-wal"));
  test::must(
      writer.connection().execute("CREATE TABLE more (x INTEGER) STRICT; DROP TABLE more", "writing on"));
}

TEST_F(OpenDatabase, reading_an_empty_file_is_an_error) {
  std::ofstream{file};
  const auto result = Database::open_read_only(file);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("an empty file, expected a history"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(file), 0U);
}

TEST_F(OpenDatabase, what_is_opened_for_reading_cannot_be_written) {
  test::must(Database::open(file));
  auto database = test::must(Database::open_read_only(file));
  EXPECT_FALSE(database.connection().execute("DELETE FROM run", "writing"));
}

TEST_F(OpenDatabase, foreign_keys_are_enforced) {
  auto database = test::must(Database::open(file));
  const auto result = database.connection().execute(
      "INSERT INTO cell (run_id, case_id, finished_utc, result_count) VALUES (1, 1, '', 0)",
      "writing an orphan");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("FOREIGN KEY"), std::string::npos);
}

class Statements : public OpenDatabase {
 protected:
  sqlite::Statement prepare(Database& database, const std::string& sql) {
    return test::must(sqlite::Statement::prepare(database.connection(), sql, "testing"));
  }
};

TEST_F(Statements, one_that_was_used_before_is_used_again_and_remembers_nothing) {
  Database database = test::must(Database::open(file));
  sqlite3_stmt* first = nullptr;
  {
    auto statement = prepare(database, "SELECT ?1 UNION ALL SELECT 2");
    first = statement.raw();
    EXPECT_TRUE(test::must(statement.bind(1).step()));  // in the middle of its rows
  }
  auto statement = prepare(database, "SELECT ?1 UNION ALL SELECT 2");
  EXPECT_EQ(statement.raw(), first);
  EXPECT_TRUE(test::must(statement.step()));
  EXPECT_TRUE(statement.is_null(0)) << "a value of its last use";
  EXPECT_NE(prepare(database, "SELECT ?1 UNION ALL SELECT 2").raw(), first) << "that one is in use";
}

TEST_F(Statements, one_that_waits_holds_no_lock_and_follows_the_schema) {
  Database database = test::must(Database::open(file));
  const char* all = "SELECT * FROM run";
  const int columns = sqlite3_column_count(prepare(database, all).raw());
  Database other = test::must(Database::open(file));
  test::must(other.connection().execute("ALTER TABLE run ADD COLUMN mood TEXT", "testing"));
  auto statement = prepare(database, all);
  test::must(statement.step());
  EXPECT_EQ(sqlite3_column_count(statement.raw()), columns + 1);
}

TEST_F(Statements, few_of_many_different_ones_wait) {
  Database database = test::must(Database::open(file));
  for (int number = 0; number < 1000; ++number) prepare(database, "SELECT " + std::to_string(number));
  int waiting = 0;
  for (sqlite3_stmt* each = nullptr;
       (each = sqlite3_next_stmt(database.connection().raw(), each)) != nullptr;) {
    ++waiting;
  }
  EXPECT_GT(waiting, 10);
  EXPECT_LE(waiting, 64);
}

TEST(DatabasePath, option_before_environment_before_working_directory) {
  ASSERT_EQ(setenv("SIPPLAB_DB", "/elsewhere/h.db", 1), 0);
  EXPECT_EQ(database_path("mine.db"), "mine.db");
  EXPECT_EQ(database_path(std::nullopt), "/elsewhere/h.db");
  ASSERT_EQ(setenv("SIPPLAB_DB", "", 1), 0);
  EXPECT_EQ(database_path(std::nullopt), "sipplab.db");
  ASSERT_EQ(unsetenv("SIPPLAB_DB"), 0);
  EXPECT_EQ(database_path(std::nullopt), "sipplab.db");
}

}  // namespace
}  // namespace sipplab::db
