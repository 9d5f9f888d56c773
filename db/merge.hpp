// Brings the rows of one history into another: shards of a sweep, the files of other machines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

struct MergeReport {
  /// Rows that were new, for each table that got some, in the order of the schema.
  std::vector<std::pair<std::string, std::int64_t>> added;

  std::int64_t rows_of(const std::string& table) const;
};

/// Adds what `source` has and `database` has not, in one transaction. A row is known by the
/// columns of any unique index of its table: a run by its UUID, a case by its parameters.
/// Doing it again adds nothing. If both have a run, its later state stays,
/// and the later of its exclusion and inclusion; rows of results are never changed.
/// New runs get the name of the file as their origin, unless they have one.
Result<MergeReport> merge_into(Database& database, const std::filesystem::path& source);

}  // namespace sipplab::db
