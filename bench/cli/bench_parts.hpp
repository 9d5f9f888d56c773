// Parts of a sweep: what of it this process is to do, what is there already, and how it splits into tasks.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "bench/cli/bench_arguments.hpp"
#include "bench/sweep/expand.hpp"
#include "db/database.hpp"
#include "db/recorder.hpp"
#include "sipplab/error.hpp"

namespace sipplab::cli {

/// Deals out what this process is to do: all, or a shard of it.
Expected<db::Done, std::string> deal_out(const BenchArguments& arguments, const db::RunInfo& info,
                                         bench::ExpandedSweep& cases);

/// The run to go on with, of which the cases lose what it holds; none: a new one begins.
db::Result<std::optional<db::EarlierRun>> take_up(const BenchArguments& arguments, db::Database& database,
                                                  const db::RunInfo& info, bench::ExpandedSweep& sweep);

/// Splits the sweep into tasks, and says how they are run. Returns the exit code.
int plan_tasks(const BenchArguments& arguments, const db::RunInfo& info, const bench::ExpandedSweep& cases);

}  // namespace sipplab::cli
