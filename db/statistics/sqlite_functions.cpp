// Aggregates over SQLite's C interface. Compiled twice: into the library, and into the
// loadable extension, which reaches SQLite through a table that the loading program
// passes in.
#ifdef SIPPLAB_SQLITE_EXTENSION
#include <sqlite3ext.h>
SQLITE_EXTENSION_INIT3
#else
#include <sqlite3.h>
#endif

#include <array>
#include <cmath>
#include <new>
#include <optional>
#include <vector>

#include "db/statistics/sqlite_functions.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::db::statistics {
namespace {

/// Three is the most that any of the functions takes.
using Arguments = std::array<double, 3>;

/// An outcome, or why there is none; NULL if both are missing.
struct Outcome {
  std::optional<double> value;
  const char* error = nullptr;
};

/// Reads one row of numbers. False for a row with a NULL in it.
bool read_row(sqlite3_context* context, int count, sqlite3_value** values, Arguments& row) {
  for (int i = 0; i < count; ++i) {
    switch (sqlite3_value_numeric_type(values[i])) {
      case SQLITE_NULL:
        return false;
      case SQLITE_INTEGER:
      case SQLITE_FLOAT:
        row[static_cast<std::size_t>(i)] = sqlite3_value_double(values[i]);
        break;
      default:
        sqlite3_result_error(context, "statistics need numbers, not text or blobs", -1);
        return false;
    }
  }
  return true;
}

/// SQLite keeps the state of an aggregate as raw bytes that begin as zeros.
struct Rows {
  std::vector<Arguments>* rows;
};

void step(sqlite3_context* context, int count, sqlite3_value** values) {
  auto* state = static_cast<Rows*>(sqlite3_aggregate_context(context, sizeof(Rows)));
  if (state == nullptr) return sqlite3_result_error_nomem(context);
  Arguments row{};
  if (!read_row(context, count, values, row)) return;
  try {
    if (state->rows == nullptr) state->rows = new std::vector<Arguments>;
    state->rows->push_back(row);
  } catch (const std::bad_alloc&) {
    sqlite3_result_error_nomem(context);
  }
}

/// Called once for each aggregate, after errors too, so the rows are freed here.
template <Outcome (*compute)(const std::vector<Arguments>&)>
void finish(sqlite3_context* context) {
  auto* state = static_cast<Rows*>(sqlite3_aggregate_context(context, 0));
  if (state == nullptr || state->rows == nullptr) return sqlite3_result_null(context);
  try {
    const Outcome outcome = compute(*state->rows);
    if (outcome.error != nullptr) {
      sqlite3_result_error(context, outcome.error, -1);
    } else if (outcome.value) {
      sqlite3_result_double(context, *outcome.value);
    } else {
      sqlite3_result_null(context);
    }
  } catch (const std::bad_alloc&) {
    sqlite3_result_error_nomem(context);
  }
  delete state->rows;
  state->rows = nullptr;
}

std::vector<double> first_column(const std::vector<Arguments>& rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const Arguments& row : rows) values.push_back(row[0]);
  return values;
}

Outcome median_of(const std::vector<Arguments>& rows) { return {median(first_column(rows)), nullptr}; }

Outcome quantile_of(const std::vector<Arguments>& rows) {
  const double p = rows.front()[1];
  if (!(p >= 0 && p <= 1)) return {std::nullopt, "quantile(x, p): p is a fraction in [0, 1]"};
  for (const Arguments& row : rows) {
    if (row[1] != p) return {std::nullopt, "quantile(x, p): p is the same for all rows"};
  }
  return {quantile(first_column(rows), p), nullptr};
}

Outcome geomean_of(const std::vector<Arguments>& rows) {
  const auto mean = geometric_mean(first_column(rows));
  if (!mean) return {std::nullopt, "geomean(x): every x is greater than 0"};
  return {mean, nullptr};
}

Outcome sign_test_of(const std::vector<Arguments>& rows) {
  std::uint64_t wins = 0;
  std::uint64_t losses = 0;
  for (const Arguments& row : rows) {
    if (row[0] > 0) ++wins;
    if (row[0] < 0) ++losses;
  }
  return {sign_test(wins, losses), nullptr};
}

Outcome wilcoxon_of(const std::vector<Arguments>& rows) { return {wilcoxon(first_column(rows)), nullptr}; }

Outcome mcnemar_of(const std::vector<Arguments>& rows) {
  std::uint64_t lost = 0;
  std::uint64_t gained = 0;
  for (const Arguments& row : rows) {
    const bool before = row[0] != 0;
    const bool after = row[1] != 0;
    if (before && !after) ++lost;
    if (!before && after) ++gained;
  }
  return {mcnemar(lost, gained), nullptr};
}

ConfidenceInterval wilson_of(const std::vector<Arguments>& rows) {
  double held = 0;
  for (const Arguments& row : rows) held += row[0] != 0 ? 1 : 0;
  return wilson_interval(held, static_cast<double>(rows.size()));
}
Outcome wilson_low_of(const std::vector<Arguments>& rows) { return {wilson_of(rows).low, nullptr}; }
Outcome wilson_high_of(const std::vector<Arguments>& rows) { return {wilson_of(rows).high, nullptr}; }

Outcome par2_of(const std::vector<Arguments>& rows) {
  std::vector<TimedResult> results;
  results.reserve(rows.size());
  for (const Arguments& row : rows) results.push_back({row[0] != 0, row[1], row[2]});
  return {par2(results), nullptr};
}

struct Function {
  const char* name;
  int arguments;
  void (*finish)(sqlite3_context*);
};
constexpr Function kFunctions[] = {
    {"median", 1, finish<median_of>},
    {"quantile", 2, finish<quantile_of>},
    {"geomean", 1, finish<geomean_of>},
    {"sign_test", 1, finish<sign_test_of>},
    {"wilcoxon", 1, finish<wilcoxon_of>},
    {"mcnemar", 2, finish<mcnemar_of>},
    {"par2", 3, finish<par2_of>},
    {"wilson_low", 1, finish<wilson_low_of>},
    {"wilson_high", 1, finish<wilson_high_of>},
};

}  // namespace

int register_functions(sqlite3* connection) {
  for (const Function& function : kFunctions) {
    const int code = sqlite3_create_function_v2(connection, function.name, function.arguments,
                                                SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS,
                                                nullptr, nullptr, step, function.finish, nullptr);
    if (code != SQLITE_OK) return code;
  }
  return SQLITE_OK;
}

}  // namespace sipplab::db::statistics
