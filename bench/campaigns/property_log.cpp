// Lines of JSON to plain rows; everything that the history would refuse is refused
// here, with the number of its line.
#include "bench/campaigns/property_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

namespace sipplab::bench {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kUuidLength = 36;
/// The line that a property logs before its first case.
constexpr const char* kStarted = "started";

/// Takes typed fields out of one object and remembers the first that is wrong.
class Fields {
 public:
  explicit Fields(const Json& json) : json_(json) {}

  void take(const char* key, std::string& text) {
    const auto field = json_.find(key);
    const bool right = field != json_.end() && field->is_string();
    if (right) text = field->get<std::string>();
    require(right, key, "a text");
  }
  void take(const char* key, const db::MaybeEmpty<std::string>& text) { take(key, text.text); }

  void take(const char* key, std::int64_t& count) {
    const auto field = json_.find(key);
    const bool right = field != json_.end() && is_count(*field);
    if (right) count = field->get<std::int64_t>();
    require(right, key, "a count");
  }

  void take(const char* key, std::optional<std::int64_t>& count) {
    if (json_.contains(key)) take(key, count.emplace());
  }

  void take(const char* key, std::uint64_t& seed) {
    const auto field = json_.find(key);
    const bool right = field != json_.end() && field->is_number_unsigned();
    if (right) seed = field->get<std::uint64_t>();
    require(right, key, "a number of 64 bits without sign");
  }

  std::map<std::string, std::int64_t> counts(const char* key) {
    std::map<std::string, std::int64_t> counts;
    const auto field = json_.find(key);
    const bool is_object = field != json_.end() && field->is_object();
    if (!is_object) complain(key, "an object of counts");
    if (!is_object) return counts;
    for (const auto& [name, value] : field->items()) {
      if (!is_count(value) || value == 0)
        complain(key, "counts greater than 0");
      else
        counts[name] = value.get<std::int64_t>();
    }
    return counts;
  }

  void require(bool right, const char* key, const char* expected) {
    if (!right) complain(key, expected);
  }

  const std::string& error() const { return error_; }

 private:
  static bool is_count(const Json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= db::kNoCountLimit;
  }

  void complain(const char* key, const char* expected) {
    if (error_.empty()) error_ = fmt::format("\"{}\" is missing or wrong, expected {}", key, expected);
  }

  const Json& json_;
  std::string error_;
};

Expected<db::PropertyRun, std::string> parse_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return Unexpected{std::string("not a property run, expected a JSON object")};
  Fields fields(json);
  db::PropertyRun run;
  const auto take = [&fields](const char* key, auto&& value) { fields.take(key, value); };
  db::PropertyRun::origin_columns(run, take);
  db::PropertyRun::columns(run, take);
  run.classes = fields.counts("classes");
  fields.require(run.uuid.size() == kUuidLength, "uuid", "36 characters");
  fields.require(!run.title.empty(), "title", "a sentence");
  fields.require(
      run.status == kStarted || run.status == "passed" || run.status == "failed" || run.status == "gave_up",
      "status", "started, passed, failed or gave_up");
  fields.require(run.shrinks <= run.shrink_tries, "shrinks", "at most shrink_tries");
  fields.require(run.status == kStarted || run.status == "passed" || !run.message.empty(), "message",
                 "a reason");
  fields.require((run.status == "failed") != run.reproduce.empty(), "reproduce", "it for failures alone");
  if (!fields.error().empty()) return Unexpected{fields.error()};
  return run;
}

/// Leaves one run for each UUID: the end of a property stands for its beginning, too, and a
/// beginning without an end is a crash.
std::vector<db::PropertyRun> ended(std::vector<db::PropertyRun> lines) {
  std::set<std::string> with_an_end;
  for (const db::PropertyRun& line : lines) {
    if (line.status != kStarted) with_an_end.insert(line.uuid);
  }
  std::vector<db::PropertyRun> runs;
  for (db::PropertyRun& line : lines) {
    if (line.status == kStarted) {
      if (with_an_end.count(line.uuid) > 0) continue;
      line.status = "crashed";
      line.message = fmt::format(
          "the program ended before this property did; the same cases again: "
          "RC_PARAMS=\"seed={} max_success={}\" properties {}",
          line.seed, line.max_success, line.room);
    }
    runs.push_back(std::move(line));
  }
  return runs;
}

}  // namespace

Expected<std::vector<db::PropertyRun>, std::string> parse_property_log(std::string_view text,
                                                                       const std::string& name) {
  std::vector<db::PropertyRun> runs;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    auto run = parse_line(line);
    if (!run) return Unexpected{fmt::format("{}:{}: {}", name, number, run.error())};
    runs.push_back(std::move(*run));
  }
  if (runs.empty()) return Unexpected{name + ": no property run, expected at least one"};
  return ended(std::move(runs));
}

PropertyTotals totals_of(const std::vector<db::PropertyRun>& runs) {
  constexpr double kSecondsPerNs = 1e-9;
  PropertyTotals totals;
  totals.runs = runs.size();
  for (const db::PropertyRun& run : runs) {
    totals.cases += run.cases;
    totals.discards += run.discards;
    if (run.status == "failed") ++totals.failed;
    if (run.status == "gave_up") ++totals.gave_up;
    if (run.status == "crashed") ++totals.crashed;
    totals.wall_time_s += static_cast<double>(run.wall_time_ns) * kSecondsPerNs;
  }
  return totals;
}

}  // namespace sipplab::bench
