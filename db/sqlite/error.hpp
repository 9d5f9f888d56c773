// Bad news from the database, as one line for a person.
#pragma once

#include <string>

#include "planner/core/try.hpp"
#include "sipplab/error.hpp"

namespace sipplab::db {

/// What a caller may want to tell apart; the message says the rest.
enum class ErrorKind {
  kNotFound,      ///< no such file, run or column
  kNotADatabase,  ///< the file is something else, or another program's database
  kNewerSchema,   ///< written by a newer sipplab
  kOlderSchema,   ///< older than the first schema that migrations know
  kCannotOpen,    ///< permission, a directory, an I/O error while opening
  kBusy,          ///< another process held the lock for longer than kBusyTimeout
  kFull,          ///< no space left for the database
  kBadQuery,      ///< SQL that does not parse, or that would write
  kBadInput,      ///< a value that the schema does not admit
  kInternal,      ///< anything else that SQLite reports
};

struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string message;  ///< one line: `file: what, expected what`, without line break
};

template <class T>
using Result = Expected<T, Error>;

/// Success without a value.
struct Done {};

}  // namespace sipplab::db
