// Migrations: applied once and as a whole, never edited, and no row is lost on the way from schema 9.
#include "db/migrate.hpp"

#include <cstdint>
#include <map>
#include <set>

#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::must;

class Migrations : public test::DatabaseTest {};

constexpr Migration kSteps[] = {
    {1, "0001_one", "CREATE TABLE one (x INTEGER) STRICT;"},
    {2, "0002_two", "ALTER TABLE one ADD COLUMN y TEXT; INSERT INTO one VALUES (1, 'a');"},
    {3, "0003_wrong", "CREATE TABLE three (x INTEGER); SELECT nonsense FROM nowhere;"}};

TEST_F(Migrations, steps_that_are_missing_are_applied_once) {
  auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
  must(migrate(connection, std::span{kSteps}.first(1)));
  EXPECT_EQ(must(connection.query_int("PRAGMA user_version", "asking")), 1);
  must(migrate(connection, std::span{kSteps}.first(2)));
  must(migrate(connection, std::span{kSteps}.first(2)));
  EXPECT_EQ(must(connection.query_int("SELECT count(*) FROM one", "asking")), 1);
  EXPECT_EQ(must(connection.query_int("PRAGMA user_version", "asking")), 2);
}

TEST_F(Migrations, a_step_that_fails_is_undone_as_a_whole) {
  auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
  const auto result = migrate(connection, kSteps);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("0003_wrong"), std::string::npos) << result.error().message;
  EXPECT_EQ(must(connection.query_int("PRAGMA user_version", "asking")), 2);
  EXPECT_EQ(must(connection.query_int("SELECT count(*) FROM sqlite_schema WHERE name = 'three'", "asking")),
            0);
}

/// 64-bit FNV-1a.
std::uint64_t digest(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char letter : text) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
  return hash;
}

// A new migration adds a line; a line that is here stays as it is. Histories of users have these
// schemas, and doctor compares the text of each statement.
TEST_F(Migrations, those_that_were_released_do_not_change) {
  const std::map<int, std::uint64_t> released = {{9, 0x3a642aab45d8d43e}};
  int expected = released.begin()->first;
  for (const Migration& step : migrations()) {
    EXPECT_EQ(step.version, expected++) << step.name;
    const auto known = released.find(step.version);
    ASSERT_NE(known, released.end()) << step.name;
    EXPECT_EQ(digest(step.sql), known->second) << step.name;
  }
  EXPECT_EQ(migrations().size(), released.size());
}

class FirstRelease : public Migrations {
 protected:
  FirstRelease() {
    auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    must(migrate(connection, migrations().first(1)));
    must(connection.execute(
        test::bytes_of(std::filesystem::path{SIPPLAB_DB_FOLDER} / "tests/schema_9_rows.sql"),
        "writing the rows of schema 9"));
  }

  std::multiset<std::string> names(const std::string& type) {
    return texts("SELECT name FROM sqlite_schema WHERE name NOT LIKE 'sqlite_%' AND type = '" + type + "'");
  }

  /// SQL of a row of a table or view, as a list of literals.
  std::string row_of(const std::string& name) {
    return test::ask(
        file, "SELECT group_concat('quote(' || name || ')', ' || '', '' || ') FROM pragma_table_info('" +
                  name + "')");
  }

  std::multiset<std::string> rows(const std::string& row, const std::string& name) {
    return texts("SELECT " + row + " FROM " + name);
  }

 private:
  std::multiset<std::string> texts(const std::string& sql) {
    auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    auto select = must(sqlite::Statement::prepare(connection, sql, "asking"));
    std::multiset<std::string> found;
    while (must(select.step())) found.insert(select.text(0));
    return found;
  }
};

TEST_F(FirstRelease, loses_no_row_of_any_table_or_view) {
  struct Held {
    std::string row;
    std::multiset<std::string> rows;
  };
  std::map<std::string, Held> before;
  for (const char* type : {"table", "view"}) {
    for (const std::string& name : names(type)) {
      const std::string row = row_of(name);
      before[name] = {row, rows(row, name)};
      EXPECT_FALSE(before[name].rows.empty() && type == std::string{"table"}) << "no row in " << name;
    }
  }
  ASSERT_GT(before.size(), 40U);

  must(Database::open(file));
  for (const auto& [name, held] : before) EXPECT_EQ(rows(held.row, name), held.rows) << name;
  test::expect_sound(file);
}

TEST_F(FirstRelease, becomes_what_a_new_file_is) {
  const auto schema = [](const std::filesystem::path& path) {
    return test::ask(path,
                     "SELECT group_concat(type || name || ifnull(sql, ''), char(10)) FROM "
                     "(SELECT * FROM sqlite_schema ORDER BY type, name)");
  };
  must(Database::open(file));
  must(Database::open(folder / "new.db"));
  EXPECT_EQ(schema(file), schema(folder / "new.db"));
  EXPECT_EQ(test::ask(file, "PRAGMA user_version"), std::to_string(Database::latest_schema_version()));
}

}  // namespace
}  // namespace sipplab::db
