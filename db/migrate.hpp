// Brings a history to the schema of this program, one numbered step at a time.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "db/embedded_text.hpp"
#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// Stands in the file's header (PRAGMA application_id) and tells a history from the
/// databases of other programs: "SIPP" in ASCII.
inline constexpr std::int64_t kApplicationId = 0x53495050;

/// One file of db/migrations.
struct Migration {
  int version;  ///< user_version after it
  std::string_view name;
  std::string_view sql;
};

/// All of them, by version without gaps. The first creates the schema of the first release,
/// and nothing older is read.
std::span<const Migration> migrations();

/// The files, by name.
std::span<const EmbeddedText> migration_files();

/// What the header of a file says, before anything is changed.
struct SchemaState {
  bool fresh = false;  ///< empty file, nothing in it yet
  int version = 0;
};

/// Reads the header. An error when the file is no database, belongs to another
/// program, or has a schema that `steps` cannot bring to their last version.
Result<SchemaState> inspect(sqlite::Connection& connection, std::span<const Migration> steps);

/// Applies the steps that are missing, each in a transaction of its own that also
/// sets user_version. Does nothing on a file that is up to date. Safe when several
/// processes do it at once. Foreign keys are checked at the end of each step, not within.
Result<Done> migrate(sqlite::Connection& connection, std::span<const Migration> steps);

}  // namespace sipplab::db
