// One check of one property: a row of the history, and a line of the log that property_tests/ writes.
// Headers of the standard library alone, so that programs without a database can include it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "db/column_tags.hpp"

namespace sipplab::db {

/// Names and units are those of the SQL columns and of the log's keys.
struct PropertyRun {
  std::string uuid;  ///< a line that is recorded twice is stored once
  std::string started_utc;
  std::string room;  ///< whose property it is: `properties ROOM`
  std::string title;
  std::uint64_t seed = 0;
  std::int64_t max_success = 0;  ///< cases that were asked for
  /// "passed", "failed", "gave_up" (too many discards) or "crashed". In the log "started" stands
  /// in a first line; a run of which there is no second line with the same UUID has crashed.
  std::string status;
  std::int64_t cases = 0;     ///< tested, the failing one included
  std::int64_t discards = 0;  ///< drawn, but the property says nothing about them
  std::int64_t shrinks = 0;   ///< steps from the first counterexample to the smallest
  std::int64_t shrink_tries = 0;
  std::int64_t wall_time_ns = 0;
  std::map<std::string, std::int64_t> classes;  ///< name to cases in it

  // Of a failure; empty if there is none.
  std::string message;         ///< what did not hold, or why it gave up
  std::string reproduce;       ///< value of RC_PARAMS that leads to the counterexample
  std::string counterexample;  ///< everything that was drawn, as rapidcheck prints it
  std::string plan_case;       ///< in the text of planner/io/case_codec.hpp
  std::optional<std::int64_t> case_robots;
  std::optional<std::int64_t> case_cells;

  /// What every run has, whatever its kind.
  template <class Self, class Visit>
  static void origin_columns(Self& self, Visit&& visit) {
    visit("uuid", self.uuid);
    visit("started_utc", self.started_utc);
    visit("room", self.room);
    visit("seed", self.seed);
    visit("status", self.status);
  }

  /// What properties have.
  template <class Self, class Visit>
  static void columns(Self& self, Visit&& visit) {
    visit("title", self.title);
    visit("max_success", self.max_success);
    visit("cases", self.cases);
    visit("discards", self.discards);
    visit("shrinks", self.shrinks);
    visit("shrink_tries", self.shrink_tries);
    visit("wall_time_ns", self.wall_time_ns);
    visit("message", MaybeEmpty{self.message});
    visit("reproduce", MaybeEmpty{self.reproduce});
    visit("counterexample", MaybeEmpty{self.counterexample});
    visit("plan_case", MaybeEmpty{self.plan_case});
    visit("case_robots", self.case_robots);
    visit("case_cells", self.case_cells);
  }
};

}  // namespace sipplab::db
