// Sides and pairs, read from the tables: a comparison needs rows, not aggregates.
#include "db/comparisons.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "db/queries.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr std::string_view kReadingRuns = "looking for what to compare";
constexpr std::size_t kShortHash = 8;

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == '-';
  });
}

std::string counted_runs(std::size_t runs) {
  return fmt::format("({} {})", runs, runs == 1 ? "run" : "runs");
}

Error not_found(const Database& database, std::string_view text) {
  return {ErrorKind::kNotFound,
          fmt::format("{}: nothing that counts is called {}, expected a run, a commit or a branch that "
                      "`sipplab runs` lists",
                      database.path().string(), text)};
}

/// Keys of the runs that `where` (with one parameter) leaves, oldest first.
Result<std::vector<std::int64_t>> run_ids(Database& database, const char* where, const std::string& value) {
  return SIPPLAB_TRY(Statement::prepare(
                         database.connection(),
                         fmt::format("SELECT run.id FROM run JOIN build ON build.id = run.build_id "
                                     "LEFT JOIN commit_ ON commit_.id = run.commit_id "
                                     "WHERE run.kind IN ('sweep', 'report') AND run.excluded_reason IS NULL "
                                     "AND {} ORDER BY run.started_utc, run.id",
                                     where),
                         kReadingRuns, value))
      .collect([](const Statement& row) { return row.integer(0); });
}

/// Hashes of commits with runs that count, at most two: the beginning may fit several.
Result<std::vector<std::string>> commits(Database& database, const char* where, const std::string& value) {
  return SIPPLAB_TRY(
             Statement::prepare(
                 database.connection(),
                 fmt::format("SELECT commit_.hash FROM run JOIN commit_ ON commit_.id = run.commit_id "
                             "WHERE run.kind IN ('sweep', 'report') AND run.excluded_reason IS NULL AND {} "
                             "GROUP BY commit_.id "
                             "ORDER BY commit_.ancestor_count DESC, commit_.committed_utc DESC LIMIT 2",
                             where),
                 kReadingRuns, value))
      .collect([](const Statement& row) { return row.text(0); });
}

using Sides = std::vector<ComparisonSide>;

Result<Sides> as_run(Database& database, const std::string& text) {
  constexpr std::size_t kShortestPrefix = 4;
  if (text != "latest" && (text.size() < kShortestPrefix || !is_hexadecimal(text))) return Sides{};
  const auto uuid = resolve_run(database, text);
  if (!uuid) {
    if (uuid.error().kind == ErrorKind::kNotFound) return Sides{};
    return Unexpected{uuid.error()};
  }
  auto ids = SIPPLAB_TRY(run_ids(database, "run.uuid = ?", *uuid));
  if (ids.empty()) {
    const auto report = show_run(database, *uuid);
    if (report && !report->run.excluded_reason) return Sides{};  // of a kind without cases
    return Unexpected{Error{ErrorKind::kNotFound,
                            fmt::format("{}: run {} is excluded, expected one that counts (`sipplab runs "
                                        "--include` takes an exclusion back)",
                                        database.path().string(), uuid->substr(0, kShortHash))}};
  }
  ComparisonSide side{"run " + uuid->substr(0, kShortHash), std::nullopt, std::move(ids)};
  const auto hashes = SIPPLAB_TRY(commits(database, "run.uuid = ?", *uuid));
  if (!hashes.empty()) {
    side.commit_hash = hashes.front();
    side.title += " of commit " + hashes.front().substr(0, kShortHash);
  }
  return Sides{std::move(side)};
}

/// The runs of builds of just this commit; if there is none, those with uncommitted changes.
Result<Sides> of_commit(Database& database, const std::string& hash, const std::string& title) {
  auto clean = SIPPLAB_TRY(run_ids(database, "build.dirty = 0 AND commit_.hash = ?", hash));
  auto dirty = SIPPLAB_TRY(run_ids(database, "build.dirty = 1 AND commit_.hash = ?", hash));
  if (clean.empty()) {
    return Sides{{title + "+ (uncommitted changes) " + counted_runs(dirty.size()), hash, std::move(dirty)}};
  }
  std::string name = title + " " + counted_runs(clean.size());
  if (!dirty.empty()) name += fmt::format(" without {} of uncommitted changes", dirty.size());
  return Sides{{std::move(name), hash, std::move(clean)}};
}

Result<Sides> as_commit(Database& database, const std::string& text) {
  constexpr std::size_t kShortestPrefix = 4;
  if (text.size() < kShortestPrefix || !is_hexadecimal(text)) return Sides{};
  const auto hashes = SIPPLAB_TRY(commits(database, "commit_.hash LIKE ? || '%'", text));
  if (hashes.empty()) return Sides{};
  if (hashes.size() > 1) {
    return Unexpected{
        Error{ErrorKind::kBadInput, fmt::format("{}: {} fits more than one commit, expected more digits",
                                                database.path().string(), text)}};
  }
  return of_commit(database, hashes.front(), "commit " + hashes.front().substr(0, kShortHash));
}

Result<Sides> as_branch(Database& database, const std::string& text) {
  const auto hashes = SIPPLAB_TRY(commits(database, "run.branch = ?", text));
  if (hashes.empty()) return Sides{};
  return of_commit(database, hashes.front(),
                   fmt::format("branch {} at {}", text, hashes.front().substr(0, kShortHash)));
}

/// A cell of one side: the newest that finished the case.
struct CellKey {
  std::int64_t cell = 0;
  std::string run;
  std::string machine;
  std::string program;
  CaseInfo parameters;
  std::set<std::int64_t> instances;
};

Result<std::set<std::int64_t>> instances_of(Database& database, std::int64_t cell) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(), "SELECT DISTINCT instance_id FROM result WHERE cell_id = ?", kReadingRuns));
  const auto ids =
      SIPPLAB_TRY(select.bind(cell).collect([](const Statement& row) { return row.integer(0); }));
  return std::set<std::int64_t>(ids.begin(), ids.end());
}

/// By case.
using Cells = std::map<std::int64_t, CellKey>;

Result<Cells> newest_cells(Database& database, const ComparisonSide& side) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT cell.id, run.uuid, machine.fingerprint, build.binary_hash, case_.* FROM cell "
      "JOIN run ON run.id = cell.run_id JOIN machine ON machine.id = run.machine_id "
      "JOIN build ON build.id = run.build_id JOIN case_ ON case_.id = cell.case_id WHERE cell.run_id = ?",
      kReadingRuns));
  constexpr int kCaseColumn = 4;
  Cells cells;
  for (const std::int64_t run : side.run_ids) {
    select.bind(run);
    SIPPLAB_TRY(select.for_each([&] {
      cells[select.integer(kCaseColumn)] = {select.integer(0),
                                            select.text(1),
                                            select.text(2),
                                            select.text(3),
                                            read_case(select, kCaseColumn),
                                            {}};
    }));
    select.reset();
  }
  return cells;
}

bool differ_in_planner_alone(const CellKey& a, const CellKey& b) {
  CaseInfo of_a = a.parameters;
  of_a.planner = b.parameters.planner;
  return of_a == b.parameters;
}

/// Rules that a plan has to keep, whoever makes it.
bool share_instances_and_rules(const CellKey& a, const CellKey& b) {
  if (a.parameters.robots != b.parameters.robots) return false;
  for (const char* rule : {"turns", "wait_before_move_s", "inflate_distance_cells", "inflate_time_s"}) {
    if (a.parameters.option(rule) != b.parameters.option(rule)) return false;
  }
  return std::any_of(a.instances.begin(), a.instances.end(),
                     [&](std::int64_t instance) { return b.instances.contains(instance); });
}

using CellPairs = std::vector<std::pair<const CellKey*, const CellKey*>>;

/// Takes those of both sides out that have just one partner there.
template <class AreAlike>
void pair_unique(std::vector<const CellKey*>& base, std::vector<const CellKey*>& head,
                 const AreAlike& are_alike, CellPairs& pairs) {
  const auto only = [](const std::vector<const CellKey*>& cells, const auto& is_partner) {
    const auto found = std::find_if(cells.begin(), cells.end(), is_partner);
    const bool is_only = found != cells.end() && std::none_of(found + 1, cells.end(), is_partner);
    return is_only ? *found : nullptr;
  };
  CellPairs found;
  for (const CellKey* cell : base) {
    const CellKey* partner = only(head, [&](const CellKey* other) { return are_alike(*cell, *other); });
    if (partner && only(base, [&](const CellKey* other) { return are_alike(*other, *partner); })) {
      found.emplace_back(cell, partner);
    }
  }
  for (const auto& [cell, partner] : found) {
    std::erase(base, cell);
    std::erase(head, partner);
    pairs.emplace_back(cell, partner);
  }
}

/// Which cell of the base is compared with which of the head; see paired_cells().
Result<CellPairs> pairs_of(Database& database, Cells& base, Cells& head) {
  CellPairs pairs;
  std::vector<const CellKey*> base_alone;
  std::vector<const CellKey*> head_alone;
  for (auto& [key, cell] : base) {
    const auto partner = head.find(key);
    if (partner != head.end()) {
      pairs.emplace_back(&cell, &partner->second);
    } else {
      base_alone.push_back(&cell);
    }
  }
  for (auto& [key, cell] : head) {
    if (!base.contains(key)) head_alone.push_back(&cell);
  }
  pair_unique(base_alone, head_alone, differ_in_planner_alone, pairs);
  if (base_alone.empty() || head_alone.empty()) return pairs;
  for (Cells* side : {&base, &head}) {
    for (auto& [key, cell] : *side) {
      auto instances = instances_of(database, cell.cell);
      if (!instances) return Unexpected{instances.error()};
      cell.instances = std::move(*instances);
    }
  }
  pair_unique(base_alone, head_alone, share_instances_and_rules, pairs);
  return pairs;
}

constexpr const char* kResultColumns =
    "{0}.status, {0}.planning_time_ns, {0}.makespan_s, {0}.flowtime_s, {0}.tries, {0}.expansions, "
    "{0}.generations, {0}.plan_hash, {0}.limit_struck, {0}.message, {0}.instructions, "
    "{0}.peak_memory_bytes";
constexpr int kResultColumnCount = 12;

ResultRow read_result(const Statement& row, int column) {
  ResultRow result;
  result.status = static_cast<ResultStatus>(row.integer(column++));
  result.planning_time_ns = row.integer(column++);
  result.makespan_s = row.optional_real(column++);
  result.flowtime_s = row.optional_real(column++);
  result.tries = static_cast<std::uint64_t>(row.integer(column++));
  result.expansions = static_cast<std::uint64_t>(row.integer(column++));
  result.generations = static_cast<std::uint64_t>(row.integer(column++));
  if (!row.is_null(column)) result.plan_hash = static_cast<std::uint64_t>(row.integer(column));
  ++column;
  result.limit = row.optional_text(column++).value_or("");
  result.message = row.optional_text(column++).value_or("");
  if (!row.is_null(column)) result.instructions = row.integer(column);
  ++column;
  if (!row.is_null(column)) result.peak_memory_bytes = row.integer(column);
  return result;
}

Result<std::int64_t> result_count(Database& database, std::int64_t cell) {
  return database.connection().query_int(fmt::format("SELECT count(*) FROM result WHERE cell_id = {}", cell),
                                         kReadingRuns);
}

Result<Done> read_pairs(Database& database, std::int64_t base, std::int64_t head, PairedCell& cell) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      // Positions may differ between folders; of equal files in one folder the first goes with the first.
      fmt::format(
          "WITH numbered AS (SELECT *, row_number() OVER (PARTITION BY cell_id, instance_id, repetition "
          "  ORDER BY position) AS occurrence FROM result WHERE cell_id IN (?1, ?2)) "
          "SELECT instance.name, instance.content_hash, base.position, base.repetition, {}, {} "
          "FROM numbered AS base JOIN numbered AS head ON head.cell_id = ?2 "
          "  AND head.instance_id = base.instance_id AND head.occurrence = base.occurrence "
          "  AND head.repetition = base.repetition "
          "JOIN instance ON instance.id = base.instance_id "
          "WHERE base.cell_id = ?1 ORDER BY base.position, base.repetition",
          fmt::format(kResultColumns, "base"), fmt::format(kResultColumns, "head")),
      kReadingRuns, base, head));
  constexpr int kBaseColumn = 4;
  constexpr int kHeadColumn = kBaseColumn + kResultColumnCount;
  for (;;) {
    const auto row = SIPPLAB_TRY(select.step());
    if (!row) break;
    PairedResult pair{select.text(0), select.text(1), read_result(select, kBaseColumn),
                      read_result(select, kHeadColumn)};
    pair.base.position = pair.head.position = select.integer(2);
    pair.base.repetition = pair.head.repetition = select.integer(3);
    cell.results.push_back(std::move(pair));
  }
  const auto base_count = SIPPLAB_TRY(result_count(database, base));
  const auto head_count = SIPPLAB_TRY(result_count(database, head));
  cell.base_only = static_cast<std::size_t>(base_count) - cell.results.size();
  cell.head_only = static_cast<std::size_t>(head_count) - cell.results.size();
  return Done{};
}

}  // namespace

Result<ComparisonSide> resolve_side(Database& database, std::string_view text) {
  struct Reading {
    std::string_view prefix;
    Result<Sides> (*read)(Database&, const std::string&);
  };
  constexpr Reading kReadings[] = {{"run:", as_run}, {"commit:", as_commit}, {"branch:", as_branch}};
  const auto said = std::find_if(std::begin(kReadings), std::end(kReadings), [text](const Reading& reading) {
    return text.substr(0, reading.prefix.size()) == reading.prefix;
  });
  Sides found;
  for (const Reading& reading : kReadings) {
    if (said != std::end(kReadings) && said->prefix != reading.prefix) continue;
    const std::string_view name = said == std::end(kReadings) ? text : text.substr(said->prefix.size());
    auto sides = SIPPLAB_TRY(reading.read(database, std::string(name)));
    found.insert(found.end(), sides.begin(), sides.end());
  }
  if (found.empty()) return Unexpected{not_found(database, text)};
  if (found.size() > 1) {
    return Unexpected{Error{ErrorKind::kBadInput,
                            fmt::format("{}: {} fits {} and {}, expected run:, commit: or branch: before it",
                                        database.path().string(), text, found[0].title, found[1].title)}};
  }
  return found.front();
}

Result<std::vector<PairedCell>> paired_cells(Database& database, const ComparisonSide& base,
                                             const ComparisonSide& head) {
  auto base_cells = SIPPLAB_TRY(newest_cells(database, base));
  auto head_cells = SIPPLAB_TRY(newest_cells(database, head));
  const auto pairs = SIPPLAB_TRY(pairs_of(database, base_cells, head_cells));
  std::vector<PairedCell> cells;
  for (const auto& [of_base, of_head] : pairs) {
    PairedCell cell;
    cell.parameters = of_head->parameters;
    if (of_base->parameters != of_head->parameters) cell.base_planner = of_base->parameters.planner;
    cell.base_run = of_base->run;
    cell.head_run = of_head->run;
    cell.same_machine = of_base->machine == of_head->machine;
    cell.same_program = of_base->program == of_head->program && !of_base->program.empty();
    SIPPLAB_TRY(read_pairs(database, of_base->cell, of_head->cell, cell));
    cells.push_back(std::move(cell));
  }
  std::stable_sort(cells.begin(), cells.end(), [](const PairedCell& a, const PairedCell& b) {
    const CaseInfo& x = a.parameters;
    const CaseInfo& y = b.parameters;
    return std::tie(x.environment, x.planner, x.option("initial_order"), x.option("reschedule"),
                    x.option("ssi_s"), x.robots,
                    x.options) < std::tie(y.environment, y.planner, y.option("initial_order"),
                                          y.option("reschedule"), y.option("ssi_s"), y.robots, y.options);
  });
  return cells;
}

}  // namespace sipplab::db
