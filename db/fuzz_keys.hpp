// Keys of what the rows of one campaign share. Internal to db/.
#pragma once

#include <cstdint>
#include <optional>

#include "db/error.hpp"
#include "db/fuzz_runs.hpp"
#include "db/sqlite/connection.hpp"

namespace sipplab::db {

struct FuzzKeys {
  std::optional<std::int64_t> commit;
  std::int64_t machine = 0;
  std::int64_t build = 0;
};

/// To be called within a write transaction.
Result<FuzzKeys> fuzz_keys(sqlite::Connection& connection, const FuzzOrigin& origin);

}  // namespace sipplab::db
