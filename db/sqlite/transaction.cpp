// BEGIN IMMEDIATE, COMMIT, and ROLLBACK for all other ways out.
#include "db/sqlite/transaction.hpp"

#include <sqlite3.h>

namespace sipplab::db::sqlite {

Result<Transaction> Transaction::begin(Connection& connection) {
  SIPPLAB_TRY(connection.execute("BEGIN IMMEDIATE", "beginning to write"));
  return Transaction{connection};
}

Transaction::~Transaction() {
  // A full disk or an I/O error may have rolled it back already.
  if (connection_ == nullptr || sqlite3_get_autocommit(connection_->raw()) != 0) return;
  sqlite3_exec(connection_->raw(), "ROLLBACK", nullptr, nullptr, nullptr);
}

Result<Done> Transaction::commit() {
  SIPPLAB_TRY(connection_->execute("COMMIT", "committing"));
  connection_ = nullptr;
  return Done{};
}

}  // namespace sipplab::db::sqlite
