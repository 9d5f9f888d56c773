// A write transaction that is undone unless it is committed.
#pragma once

#include <utility>

#include "db/sqlite/connection.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db::sqlite {

/// Takes the write lock when it begins (BEGIN IMMEDIATE): a transaction that read
/// first and wrote later could not wait for another writer, it could only fail.
class Transaction {
 public:
  static Result<Transaction> begin(Connection& connection);

  Transaction(Transaction&& other) noexcept : connection_(std::exchange(other.connection_, nullptr)) {}
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();

  /// After an error everything is undone.
  Result<Done> commit();

 private:
  explicit Transaction(Connection& connection) : connection_(&connection) {}

  Connection* connection_;
};

}  // namespace sipplab::db::sqlite
