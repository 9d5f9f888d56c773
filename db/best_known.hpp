// Best known costs of MovingAI's scenarios in unit steps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.hpp"

namespace sipplab::db {

struct BestKnownRow {
  std::string map_name;
  std::string scen_type;
  std::int64_t type_id = 0;
  std::int64_t agents = 0;
  std::int64_t lower_cost = 0;  ///< 0: none
  std::int64_t solution_cost = 0;
};

/// Adds rows, all or none. Of what is known already the least cost and the greatest bound stay.
Result<Done> record_best_known(Database& database, const std::vector<BestKnownRow>& rows);

}  // namespace sipplab::db
