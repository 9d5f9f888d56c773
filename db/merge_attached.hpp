// One step of merging: the rows of a history that is attached as `shard`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "db/merge.hpp"
#include "db/sqlite/connection.hpp"

namespace sipplab::db {

inline constexpr const char* kMerging = "merging";

struct Reference {
  std::string column;
  std::string parent;
  std::string parent_column;
};

struct TableShape {
  std::string name;
  std::vector<std::string> columns;  ///< without the integer key
  bool has_key = false;              ///< an integer key named id, of which merging makes a new one
  std::vector<std::vector<std::string>> unique;
  std::vector<Reference> references;
};

/// All tables, parents before children.
Result<std::vector<TableShape>> tables_of(sqlite::Connection& connection);

/// Attaches a file of any known schema as `shard`: on read-only media without locks, as
/// Database::open_read_only.
Result<Done> attach(sqlite::Connection& connection, const std::filesystem::path& source);

/// Merges what is attached, in one transaction, and detaches it. A history gets its summaries.
Result<MergeReport> merge_attached(sqlite::Connection& connection, const std::vector<TableShape>& tables,
                                   const std::string& origin, bool is_history);

}  // namespace sipplab::db
