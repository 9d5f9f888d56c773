// Many files into one history: see merge.hpp.
#include "db/merge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "db/merge_attached.hpp"
#include "db/migrate.hpp"

namespace sipplab::db {
namespace {

namespace fs = std::filesystem;
using sqlite::Connection;

/// Many files merged into one history. Each of a thousand parts of a sweep has rows for pages all over it; in
/// memory they come together first, and are written many files in one transaction, in the order of the pages.
class MergeOfFiles {
 public:
  MergeOfFiles(Database& database, std::vector<TableShape> tables)
      : database_(database), tables_(std::move(tables)) {}

  Result<Done> add(const fs::path& source) {
    std::error_code code;
    if (fs::equivalent(source, database_.path(), code)) {
      refuse({ErrorKind::kBadInput,
              fmt::format("{}: merged into itself, expected another file", source.string())});
      return Done{};
    }
    const bool is_large = fs::file_size(source, code) > kLargeFileBytes && !code;
    if (is_large) SIPPLAB_TRY(write());
    if (!is_large && !gathered_) SIPPLAB_TRY(begin_gathering());
    auto report = merge_file(source, is_large);
    if (!report) {
      // A large one is written to the disk of the history at once.
      if (is_large && report.error().kind == ErrorKind::kFull) return Unexpected{report.error()};
      refuse(report.error());
    } else if (is_large) {
      count(*report);
    }
    if (is_large || SIPPLAB_TRY(gathered_bytes()) < kGatheredBytes) return Done{};
    return write();
  }

  /// What was gathered; REQUIRES to be called at the end.
  Result<Done> write() {
    if (!gathered_) return Done{};
    Connection& connection = database_.connection();
    SIPPLAB_TRY(connection.attach_copy(*gathered_, "shard", kMerging));
    count(SIPPLAB_TRY(merge_attached(connection, tables_, "", true)));
    gathered_.reset();
    return Done{};
  }

  /// What was done, tables in the order of the schema.
  MergeReport& report() {
    const auto place = [this](const auto& table) {
      return std::find_if(tables_.begin(), tables_.end(),
                          [&table](const TableShape& shape) { return shape.name == table.first; });
    };
    std::sort(report_.added.begin(), report_.added.end(),
              [&place](const auto& a, const auto& b) { return place(a) < place(b); });
    return report_;
  }

 private:
  /// Larger ones are merged as they are: gathering them is not worth the memory.
  static constexpr std::uintmax_t kLargeFileBytes = 8 << 20;
  /// About 800,000 results: some seconds of merging.
  static constexpr std::int64_t kGatheredBytes = 64 << 20;

  Result<Done> begin_gathering() {
    auto connection = SIPPLAB_TRY(Connection::open_in_memory());
    SIPPLAB_TRY(migrate(connection, migrations()));
    // Whoever counts results counts them in the history.
    SIPPLAB_TRY(connection.execute(
        "DROP TRIGGER result_counts; PRAGMA foreign_keys = ON; PRAGMA temp_store = MEMORY", kMerging));
    gathered_ = std::move(connection);
    return Done{};
  }

  Result<std::int64_t> gathered_bytes() {
    return gathered_->query_int("SELECT page_count * page_size FROM pragma_page_count, pragma_page_size",
                                kMerging);
  }

  Result<MergeReport> merge_file(const fs::path& source, bool is_large) {
    Connection& destination = is_large ? database_.connection() : *gathered_;
    auto report = [&]() -> Result<MergeReport> {
      SIPPLAB_TRY(attach(destination, source));
      return merge_attached(destination, tables_, source.string(), is_large);
    }();
    if (report || report.error().message.rfind(source.string(), 0) == 0) return report;
    // What is wrong is wrong with the source, unless the disk of the history is full.
    Error error = report.error();
    const std::string destination_name = destination.name() + ": ";
    if (error.kind != ErrorKind::kFull && error.message.rfind(destination_name, 0) == 0) {
      error.message.erase(0, destination_name.size());
    }
    error.message = fmt::format("{}: not merged: {}", source.string(), error.message);
    return Unexpected{std::move(error)};
  }

  void refuse(Error error) { report_.refused.push_back(std::move(error)); }

  void count(const MergeReport& more) {
    for (const auto& [table, rows] : more.added) {
      const auto found = std::find_if(report_.added.begin(), report_.added.end(),
                                      [&name = table](const auto& one) { return one.first == name; });
      if (found == report_.added.end()) {
        report_.added.emplace_back(table, rows);
      } else {
        found->second += rows;
      }
    }
  }

  Database& database_;
  std::vector<TableShape> tables_;
  MergeReport report_;
  std::optional<Connection> gathered_;
};

}  // namespace

std::int64_t MergeReport::rows_of(const std::string& table) const {
  for (const auto& [name, rows] : added) {
    if (name == table) return rows;
  }
  return 0;
}

Result<MergeReport> merge_into(Database& database, const std::vector<fs::path>& sources) {
  MergeOfFiles merge(database, SIPPLAB_TRY(tables_of(database.connection())));
  for (const fs::path& source : sources) SIPPLAB_TRY(merge.add(source));
  SIPPLAB_TRY(merge.write());
  return std::move(merge.report());
}

Result<MergeReport> merge_into(Database& database, const fs::path& source) {
  auto report = SIPPLAB_TRY(merge_into(database, std::vector{source}));
  if (!report.refused.empty()) return Unexpected{report.refused.front()};
  return report;
}

}  // namespace sipplab::db
