// The statistics for any sqlite3 shell: `.load ./sipplab_sqlite`. SQLite derives the
// name of the entry point from the letters of the file's name.
#include <sqlite3ext.h>
SQLITE_EXTENSION_INIT1

#include "db/statistics/sqlite_functions.hpp"

extern "C" __attribute__((visibility("default"))) int sqlite3_sipplabsqlite_init(
    sqlite3* connection, char**, const sqlite3_api_routines* api) {
  SQLITE_EXTENSION_INIT2(api)
  return sipplab::db::statistics::register_functions(connection);
}
