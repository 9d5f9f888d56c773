// The schema that comes after ours: the first one that this program must not touch.
#include <string>

#include "db/database.hpp"
#include "db/migrate.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

class NextSchema : public test::DatabaseTest {};

TEST_F(NextSchema, is_refused_by_readers_and_writers) {
  test::must(Database::open(file));
  const int next = Database::latest_schema_version() + 1;
  {
    auto connection = test::must(sqlite::Connection::open(file, sqlite::OpenMode::kReadWrite));
    test::must(connection.execute("PRAGMA user_version = " + std::to_string(next), "ageing"));
  }
  for (const auto& result : {Database::open(file), Database::open_read_only(file)}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::kNewerSchema) << result.error().message;
  }
}

}  // namespace
}  // namespace sipplab::db
