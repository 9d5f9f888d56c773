#include "db/findings.hpp"

#include <fmt/core.h>

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr const char* kWritingFinding = "writing a finding";
constexpr const char* kReadingFindings = "reading findings";
constexpr const char* kSelect =
    "SELECT v_findings.*, (SELECT input FROM finding WHERE finding.id = v_findings.id) AS input FROM "
    "v_findings";

StoredFinding read_finding(const Statement& row) {
  StoredFinding stored;
  read_row(row, [&stored](auto visit) { StoredFinding::columns(stored, visit); });
  return stored;
}

/// What a sighting makes of a state, and the event that it is.
std::string state_after(const std::string& state, bool breaks) {
  if (!breaks) return "fixed";
  return state == "fixed" || state == "regressed" ? "regressed" : "reproduced";
}

Result<Done> add_event(sqlite::Connection& connection, std::int64_t id, const std::string& event,
                       const std::string& now_utc, std::optional<std::int64_t> commit,
                       std::optional<std::int64_t> fuzz_run) {
  return sqlite::run(
      connection,
      "INSERT OR IGNORE INTO finding_event (finding_id, happened_utc, event, commit_id, fuzz_run_id) "
      "VALUES (?, ?, ?, ?, ?)",
      kWritingFinding, id, now_utc, event, commit, fuzz_run);
}

Result<Done> insert_finding(sqlite::Connection& connection, const Finding& finding,
                            std::optional<std::int64_t> commit, const std::string& now_utc) {
  SIPPLAB_TRY(insert_row(connection, "finding", kWritingFinding, [&](auto visit) {
    visit("signature", finding.signature());
    visit("state", "new");
    visit("first_utc", now_utc);
    visit("last_utc", now_utc);
    visit("first_commit_id", commit);
    visit("last_commit_id", commit);
    visit("times_found", 1);
    Finding::columns(finding, visit);
  }));
  return Done{};
}

/// Moves a finding that is there on to its next state.
Result<Done> note_sighting(sqlite::Connection& connection, const StoredFinding& stored, bool breaks,
                           bool found, std::optional<std::int64_t> commit,
                           std::optional<std::int64_t> fuzz_run, const std::string& now_utc) {
  const std::string state = state_after(stored.state, breaks);
  SIPPLAB_TRY(sqlite::run(connection,
                          "UPDATE finding SET state = ?2, times_found = times_found + ?3, "
                          "last_utc = CASE WHEN ?4 THEN ?5 ELSE last_utc END, "
                          "last_commit_id = CASE WHEN ?4 THEN ?6 ELSE last_commit_id END, "
                          "fixed_commit_id = CASE WHEN ?4 THEN NULL WHEN state = 'fixed' THEN "
                          "fixed_commit_id ELSE ?6 END WHERE id = ?1",
                          kWritingFinding, stored.id, state, found ? 1 : 0, breaks, now_utc, commit));
  // That it still holds is no news; that it still breaks shows in its last time and commit.
  if (state == stored.state) return Done{};
  return add_event(connection, stored.id, state, now_utc, commit, fuzz_run);
}

Result<std::optional<StoredFinding>> find_by_signature(sqlite::Connection& connection,
                                                       const Finding& finding) {
  auto select = SIPPLAB_TRY(Statement::prepare(connection,
                                               fmt::format("{} WHERE target = ? AND signature = ?", kSelect),
                                               kReadingFindings, finding.target, finding.signature()));
  const auto row = SIPPLAB_TRY(select.step());
  if (!row) return std::optional<StoredFinding>();
  return std::optional<StoredFinding>(read_finding(select));
}

Result<Done> keep_smaller(sqlite::Connection& connection, const StoredFinding& stored,
                          const Finding& finding) {
  if (finding.minimal.size() >= stored.finding.minimal.size()) return Done{};
  return sqlite::run(connection,
                     "UPDATE finding SET minimal = CAST(?2 AS BLOB), robots = ?3, cells = ?4 WHERE id = ?1",
                     kWritingFinding, stored.id, finding.minimal, finding.robots, finding.cells);
}

}  // namespace

Result<StoredFinding> record_finding(Database& database, const RunOrigin& origin, const Finding& finding,
                                     std::optional<std::int64_t> fuzz_run, const std::string& now_utc) {
  auto& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  const auto commit = SIPPLAB_TRY(commit_id(connection, origin.commit));
  const auto known = SIPPLAB_TRY(find_by_signature(connection, finding));
  std::int64_t id = 0;
  if (known.has_value()) {
    id = known->id;
    SIPPLAB_TRY(note_sighting(connection, *known, true, true, commit, fuzz_run, now_utc));
    SIPPLAB_TRY(keep_smaller(connection, *known, finding));
  } else {
    SIPPLAB_TRY(insert_finding(connection, finding, commit, now_utc));
    id = connection.last_insert_rowid();
    SIPPLAB_TRY(add_event(connection, id, "found", now_utc, commit, fuzz_run));
  }
  SIPPLAB_TRY(transaction.commit());
  return find_finding(database, id);
}

Result<StoredFinding> record_minimal(Database& database, std::int64_t id, const Finding& finding) {
  const auto stored = find_finding(database, id);
  if (!stored) return stored;
  if (auto done = keep_smaller(database.connection(), *stored, finding); !done)
    return Unexpected{done.error()};
  return find_finding(database, id);
}

Result<StoredFinding> record_replay(Database& database, const RunOrigin& origin, std::int64_t id, bool breaks,
                                    const std::string& now_utc) {
  auto& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  const auto commit = SIPPLAB_TRY(commit_id(connection, origin.commit));
  const auto stored = SIPPLAB_TRY(find_finding(database, id));
  SIPPLAB_TRY(note_sighting(connection, stored, breaks, false, commit, std::nullopt, now_utc));
  SIPPLAB_TRY(transaction.commit());
  return find_finding(database, id);
}

Result<std::vector<StoredFinding>> list_findings(Database& database, bool open_only) {
  return SIPPLAB_TRY(
             Statement::prepare(database.connection(),
                                fmt::format("{} WHERE NOT ? OR state <> 'fixed' ORDER BY id", kSelect),
                                kReadingFindings, open_only))
      .collect(read_finding);
}

Result<StoredFinding> find_finding(Database& database, std::int64_t id) {
  auto select = SIPPLAB_TRY(Statement::prepare(database.connection(), fmt::format("{} WHERE id = ?", kSelect),
                                               kReadingFindings, id));
  const auto row = SIPPLAB_TRY(select.step());
  if (row) return read_finding(select);
  return Unexpected{Error{ErrorKind::kNotFound,
                          fmt::format("{}: no finding {}, expected one that `sipplab findings list` shows",
                                      database.path().string(), id)}};
}

Result<Table> finding_events(Database& database, std::int64_t id) {
  return rest_of(SIPPLAB_TRY(
      Statement::prepare(database.connection(),
                         "SELECT event, happened_utc, commit_.hash AS commit_hash FROM finding_event "
                         "LEFT JOIN commit_ ON commit_.id = commit_id "
                         "WHERE finding_id = ? ORDER BY happened_utc",
                         kReadingFindings, id)));
}

}  // namespace sipplab::db
