#include "db/best_known.hpp"

#include "db/identity.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {

Result<Done> record_best_known(Database& database, const std::vector<BestKnownRow>& rows) {
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(database.connection()));
  const std::string now = utc_now();
  for (const BestKnownRow& row : rows) {
    SIPPLAB_TRY(sqlite::run(database.connection(),
                            "INSERT INTO best_known (map_name, scen_type, type_id, agents, lower_cost, "
                            "solution_cost, imported_utc) VALUES (?, ?, ?, ?, ?, ?, ?) "
                            "ON CONFLICT DO UPDATE SET lower_cost = max(lower_cost, excluded.lower_cost), "
                            "solution_cost = min(solution_cost, excluded.solution_cost), "
                            "imported_utc = excluded.imported_utc",
                            "writing best known costs", row.map_name, row.scen_type, row.type_id, row.agents,
                            row.lower_cost, row.solution_cost, now));
  }
  return transaction.commit();
}

}  // namespace sipplab::db
