// Migrations: applied once and as a whole, never edited, and no row is lost on the way from schema 9.
#include "db/migrate.hpp"

#include <cstdint>
#include <map>
#include <set>

#include "db/merge.hpp"
#include "db/queries.hpp"
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

TEST_F(Migrations, a_step_that_leaves_orphans_is_undone) {
  auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
  must(connection.execute("PRAGMA foreign_keys = ON", "asking for foreign keys"));
  const Migration steps[] = {
      {1, "0001_one",
       "CREATE TABLE one (id INTEGER PRIMARY KEY); INSERT INTO one VALUES (7); "
       "CREATE TABLE two (one_id INTEGER REFERENCES one); INSERT INTO two VALUES (7);"},
      {2, "0002_orphans", "DROP TABLE one; CREATE TABLE one (id INTEGER PRIMARY KEY);"}};
  const auto result = migrate(connection, steps);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("1 rows point to rows that are not there"), std::string::npos)
      << result.error().message;
  EXPECT_EQ(must(connection.query_int("SELECT count(*) FROM one", "asking")), 1);
  EXPECT_EQ(must(connection.query_int("PRAGMA foreign_keys", "asking")), 1);
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
  const std::map<int, std::uint64_t> released = {
      {9, 0x3a642aab45d8d43e},  {10, 0x15550d08521d0194}, {11, 0x8c4ef970db956e9b}, {12, 0x6896b0d9752fbfc9},
      {13, 0x8ec36830ccfe2123}, {14, 0x608fe8131c15595d}, {15, 0x747fd8b08948cb00}, {16, 0x173efd20f006843c}};
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
                  name + "') WHERE name <> 'planner'");  // taken apart by version 12
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

/// What stands today where the rows of a table or view of schema 9 were, if it is not of that name and form.
const std::map<std::string, std::string> kToday = {
    {"run", "run WHERE kind IN ('sweep', 'report')"},
    {"v_runs", "v_runs WHERE kind IN ('sweep', 'report')"},
    {"v_results", "v_all_results"},
    {"v_run_cells", "v_all_run_cells"},
    {"property_run",
     "(SELECT property_run.*, uuid, started_utc, suite AS room, commit_id, machine_id, build_id, branch, "
     "seed, "
     "outcome AS status, origin FROM property_run JOIN run ON run.id = run_id)"},
    {"gate_run",
     "(SELECT gate_run.*, uuid, started_utc, suite, machine_id, build_id AS head_build_id, commit_id AS "
     "head_commit_id, seed, outcome AS verdict, origin FROM gate_run JOIN run ON run.id = run_id)"},
    {"fuzz_run",
     "(SELECT fuzz_run.*, uuid, started_utc, suite AS target, outcome AS status, seed, commit_id, "
     "machine_id, "
     "build_id, branch, origin FROM fuzz_run JOIN run ON run.id = run_id)"},
};

/// Views that have no excluded run since version 14.
const std::set<std::string> kLeaveOutExcluded = {"v_slowest", "v_trends", "v_plan_makers", "v_work"};

TEST_F(FirstRelease, loses_no_row_of_any_table_or_view) {
  struct Held {
    std::string row;
    std::multiset<std::string> rows;
  };
  std::map<std::string, Held> before;
  for (const char* type : {"table", "view"}) {
    for (const std::string& name : names(type)) {
      const std::string row = row_of(name);
      const bool leaves_out = kLeaveOutExcluded.contains(name);
      before[name] = {row, rows(row, leaves_out ? name + " WHERE run NOT IN (SELECT uuid FROM run WHERE "
                                                         "excluded_reason IS NOT NULL)"
                                                : name)};
      EXPECT_FALSE(before[name].rows.empty() && type == std::string{"table"}) << "no row in " << name;
    }
  }
  ASSERT_GT(before.size(), 40U);

  must(Database::open(file));
  for (const auto& [name, held] : before) {
    const auto today = kToday.find(name);
    EXPECT_EQ(rows(held.row, today == kToday.end() ? name : today->second), held.rows) << name;
  }
  test::expect_sound(file);
}

TEST_F(FirstRelease, has_all_its_runs_in_one_list) {
  auto database = must(Database::open(file));
  std::map<std::string, int> listed;
  RunFilter filter;
  filter.kind = "all";
  filter.include_excluded = true;
  filter.limit = 0;
  for (const RunSummary& run : must(list_runs(database, filter))) {
    ++listed[run.kind + ' ' + run.status + ' ' + run.outcome];
    EXPECT_EQ(run.ended_utc.has_value(), run.status != "running") << run.uuid;
    EXPECT_LE(run.started_utc, run.ended_utc.value_or(run.started_utc)) << run.uuid;
    EXPECT_EQ(must(resolve_run(database, run.uuid.substr(0, 8))), run.uuid);
    const RunReport report = must(show_run(database, run.uuid));
    EXPECT_EQ(report.details.rows.empty(), run.kind == "sweep") << run.kind;
    const std::string text = format_run_report(report, OutputFormat::kTable);
    if (run.kind == "fuzz") {
      EXPECT_NE(text.find("\nedges                 559\n"), std::string::npos) << text;
    }
  }
  EXPECT_EQ(listed, (std::map<std::string, int>{{"sweep finished ", 5},
                                                {"sweep running ", 1},
                                                {"report finished ", 1},
                                                {"property finished passed", 1},
                                                {"property finished failed", 3},
                                                {"property finished gave_up", 1},
                                                {"property finished crashed", 1},
                                                {"fuzz finished findings", 1},
                                                {"gate finished inconclusive", 1},
                                                {"gate finished regressed", 1}}));
}

TEST_F(FirstRelease, merges_into_a_new_file_once) {
  auto database = must(Database::open(folder / "new.db"));
  EXPECT_EQ(must(merge_into(database, file)).rows_of("run"), 16);
  EXPECT_TRUE(must(merge_into(database, file)).added.empty());
  test::expect_sound(folder / "new.db");
}

TEST_F(FirstRelease, planners_are_taken_apart) {
  const auto add = [this](const std::string& planner, int any_angle, int connectedness) {
    auto connection = must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    must(connection.execute("INSERT INTO case_ SELECT 1000 + count(*), 'e', 'm', 'i', 1, 5.0, '" + planner +
                                "', 'fifo', 'none', " + std::to_string(any_angle) + ", " +
                                std::to_string(connectedness) + ", 0.5, 1.0, 300.0, 9, 9, 1 FROM case_",
                            "adding a case"));
  };
  const struct {
    const char* planner;
    int any_angle, connectedness;
    const char* label;
    const char* columns;
  } cases[] = {
      {"aa-sipp", 1, 2, "sipplab", "1.0|0|0.0|0.0|0.0|prioritized|none|0|none|flowtime"},
      {"sipp+turns", 0, 3, "sipplab any-angle:no connectedness:3 turns:yes",
       "1.0|1|0.0|0.0|0.0|prioritized|none|0|none|flowtime"},
      {"aa-sipp+weight:1.05+wait:0.5+distance:0.25+time:2+complete", 1, 2,
       "sipplab weight:1.05 wait-before-move:0.5 inflate-distance:0.25 inflate-time:2 fallback:complete",
       "1.05|0|0.5|0.25|2.0|prioritized|complete|0|none|flowtime"},
      {"aa-sipp+improve:300i,flowtime", 1, 2, "sipplab improve:300i",
       "1.0|0|0.0|0.0|0.0|prioritized|none|0|300i|flowtime"},
      {"aa-sipp+complete+best,1:20", 1, 2, "sipplab fallback:complete best:yes objective:1:20",
       "1.0|0|0.0|0.0|0.0|prioritized|complete|1|none|1:20"},
      {"complete+best:0.5s,makespan", 0, 2,
       "sipplab any-angle:no method:complete best:yes improve:0.5s objective:makespan",
       "1.0|0|0.0|0.0|0.0|complete|none|1|0.5s|makespan"},
      {"cmd:mine+best,x", 1, 2, "cmd:mine+best,x", "1.0|0|0.0|0.0|0.0|prioritized|none|0|none|flowtime"},
  };
  for (const auto& one : cases) add(one.planner, one.any_angle, one.connectedness);
  must(Database::open(file));
  std::string id = test::ask(file, "SELECT CAST(min(id) AS TEXT) FROM case_ WHERE environment = 'e'");
  for (const auto& one : cases) {
    const std::string from = " FROM case_ WHERE id = " + id;
    EXPECT_EQ(test::ask(file, "SELECT planner" + from), one.label);
    EXPECT_EQ(
        test::ask(
            file,
            "SELECT weight || '|' || turns || '|' || wait_before_move_s || '|' || inflate_distance_cells "
            "|| '|' || inflate_time_s || '|' || method || '|' || fallback || '|' || best || '|' || "
            "improve || '|' || objective" +
                from),
        one.columns);
    id = std::to_string(std::stoi(id) + 1);
  }
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
