// A case with a value in each column that the newest schema has.
#pragma once

#include "db/migrate.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db::test {

inline CaseInfo read_plain_case() {
  auto connection = sqlite::Connection::open_in_memory().value();
  migrate(connection, migrations()).value();
  const char* insert = R"(
      INSERT INTO case_ (environment, map_spec, instance_set, robots, ssi_s, planner, initial_order, reschedule,
        any_angle, connectedness, radius_cells, speed_cells_per_s, time_limit_s, max_expansions, max_restarts, seed)
      VALUES ('warehouse', 'warehouse', 'generated/seed:1', 64, 5, 'sipplab', 'shortest', 'deterministic',
        1, 2, 0.5, 1, 300, 9223372036854775807, 9223372036854775807, 1))";
  connection.execute(insert, "making a case").value();
  auto select = sqlite::Statement::prepare(connection, "SELECT * FROM case_", "reading a case").value();
  select.step().value();
  return read_case(select, 0);
}

/// Made once: migrating takes longer than most tests.
inline const CaseInfo& plain_case() {
  static const CaseInfo made = read_plain_case();
  return made;
}

}  // namespace sipplab::db::test
