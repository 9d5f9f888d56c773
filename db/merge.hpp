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
  /// Files that could not be merged, and why: what they hold is not in the history.
  std::vector<Error> refused;

  std::int64_t rows_of(const std::string& table) const;
};

/// Adds what `sources` have and `database` has not, and makes the summaries. A row is known
/// by the columns of any unique index of its table: a run by its UUID, a case by its parameters.
/// Doing it again adds nothing. Parts of one sweep become one run; a planning that several of them hold
/// stays as it came first. If both have a run, its later state stays, and the later of its exclusion and
/// inclusion; rows of results are never changed.
/// New runs get the name of the file as their origin, unless they have one.
/// A file is merged completely or not at all, small ones many in one transaction. The error, if the history
/// itself fails: what was committed stays.
Result<MergeReport> merge_into(Database& database, const std::vector<std::filesystem::path>& sources);

/// The same of one file; that it is refused is an error.
Result<MergeReport> merge_into(Database& database, const std::filesystem::path& source);

}  // namespace sipplab::db
