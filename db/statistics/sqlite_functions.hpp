// The statistics as SQL aggregates:
//
//     median(x)   quantile(x, p)   geomean(x)
//     sign_test(difference)   wilcoxon(difference)     p values, two-sided
//     mcnemar(base_solved, head_solved)                p value, two-sided
//     par2(solved, time_s, limit_s)                    mean time, unsolved as 2 * limit
//     wilson_low(solved)   wilson_high(solved)         95 % interval of the share that is not 0
//
// Rows with a NULL argument are left out. No rows: NULL, but for mcnemar, which is 1
// as long as there is a pair. A text or blob instead of a number, a p outside
// [0, 1] or a geomean of something that is not > 0 is an error that says so.
#pragma once

struct sqlite3;

namespace sipplab::db::statistics {

/// Adds them to a connection. Returns an SQLite result code.
int register_functions(sqlite3* connection);

}  // namespace sipplab::db::statistics
