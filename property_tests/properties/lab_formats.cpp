// Texts that the laboratory writes and reads: tables, logs of engines and properties, reports of other
// programs, words between processes. What was written is what is read, each column and each unit.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/campaigns/coverage.hpp"
#include "bench/campaigns/engine_log.hpp"
#include "bench/campaigns/property_log.hpp"
#include "bench/gate/protocol.hpp"
#include "bench/import/google_benchmark.hpp"
#include "db/queries.hpp"
#include "db/run_names.hpp"
#include "db/table.hpp"
#include "planner/options/option_table.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/texts.hpp"

namespace sipplab::bench::lab_formats_laws {
namespace {

using db::any_flag;
using db::any_whole;
using db::Table;
using db::Value;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFewer = (kCasesOfHistories + 3) / 4;
constexpr int kFewest = (kCasesOfHistories + 7) / 8;

// --- tables -------------------------------------------------------------------------

Value any_value() {
  switch (any_whole(0, 4)) {
    case 0:
      return db::Null{};
    case 1:
      return *rc::gen::arbitrary<std::int64_t>();
    case 2:
      return any_whole(0, 4) == 0 ? (any_flag() ? kInfinity : -kInfinity) : *any_real_between(-1e6, 1e6);
    case 3:
      return db::Blob{*any_text()};
    default:
      return *any_text();
  }
}

Table any_table() {
  Table table;
  const auto columns = any_whole(1, 4);
  for (std::int64_t i = 0; i < columns; ++i)
    table.columns.push_back(any_whole(0, 3) == 0 ? "same" : "column " + std::to_string(i));
  for (auto rows = any_whole(0, 4); rows > 0; --rows) {
    table.rows.emplace_back();
    for (std::int64_t i = 0; i < columns; ++i) table.rows.back().push_back(any_value());
  }
  return table;
}

std::string hexadecimal(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    text += kDigits[code / 16];
    text += kDigits[code % 16];
  }
  return text;
}

/// RFC 4180, field by field; whether it was quoted tells an empty text from none.
std::vector<std::vector<std::pair<std::string, bool>>> read_csv(const std::string& text) {
  std::vector<std::vector<std::pair<std::string, bool>>> lines;
  std::size_t at = 0;
  while (at < text.size()) {
    lines.emplace_back();
    for (bool again = true; again;) {
      std::string field;
      const bool quoted = text[at] == '"';
      if (quoted) {
        ++at;
        while (!(text[at] == '"' && text[at + 1] != '"')) {
          if (text[at] == '"') ++at;
          field += text[at++];
        }
        ++at;
      } else {
        while (text[at] != ',' && text[at] != '\r') field += text[at++];
      }
      lines.back().emplace_back(field, quoted);
      again = text[at] == ',';
      if (again) ++at;
    }
    RC_ASSERT(text.substr(at, 2) == "\r\n");
    at += 2;
  }
  return lines;
}

void csv_is_read_as_written() {
  const Table table = any_table();
  const auto lines = read_csv(format_csv(table));
  RC_ASSERT(lines.size() == table.rows.size() + 1);
  for (std::size_t i = 0; i < table.columns.size(); ++i) RC_ASSERT(lines[0].at(i).first == table.columns[i]);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    RC_ASSERT(lines[row + 1].size() == table.columns.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const auto& [text, quoted] = lines[row + 1][i];
      const Value& value = table.rows[row][i];
      if (std::holds_alternative<db::Null>(value)) RC_ASSERT(text.empty() && !quoted);
      if (const auto* whole = std::get_if<std::int64_t>(&value)) RC_ASSERT(text == std::to_string(*whole));
      if (const auto* real = std::get_if<double>(&value)) RC_ASSERT(std::stod(text) == *real);
      if (const auto* words = std::get_if<std::string>(&value))
        RC_ASSERT(text == *words && (quoted || !text.empty()));
      if (const auto* blob = std::get_if<db::Blob>(&value)) RC_ASSERT(text == hexadecimal(blob->bytes));
    }
  }
}

void json_is_read_as_written() {
  const Table table = any_table();
  const auto json = nlohmann::json::parse(format_json(table));
  RC_ASSERT(json.size() == table.rows.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    RC_ASSERT(json[row].size() == table.columns.size());
    std::map<std::string, int> taken;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      // The second column of a name is NAME:1.
      const int number = taken[table.columns[i]]++;
      const auto& said =
          json[row].at(number == 0 ? table.columns[i] : table.columns[i] + ":" + std::to_string(number));
      const Value& value = table.rows[row][i];
      if (std::holds_alternative<db::Null>(value)) RC_ASSERT(said.is_null());
      if (const auto* whole = std::get_if<std::int64_t>(&value)) RC_ASSERT(said == *whole);
      if (const auto* real = std::get_if<double>(&value)) {
        if (std::isinf(*real)) RC_ASSERT(said == (*real > 0 ? "inf" : "-inf"));
        if (!std::isinf(*real)) RC_ASSERT(said == *real);
      }
      if (const auto* words = std::get_if<std::string>(&value)) RC_ASSERT(said == *words);
      if (const auto* blob = std::get_if<db::Blob>(&value)) RC_ASSERT(said == hexadecimal(blob->bytes));
    }
  }
}

std::size_t code_points(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Text to the left, numbers to the right, every column as wide as its widest, two blanks between.
void columns_are_aligned() {
  const Table table = any_table();
  const std::string text = format_aligned(table);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  RC_ASSERT(lines.size() == table.rows.size() + 2);
  // The rule below the heading tells where columns are.
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t at = 0; at < lines[1].size();) {
    const std::size_t end = std::min(lines[1].find(' ', at), lines[1].size());
    RC_ASSERT(lines[1].substr(at, end - at) == std::string(end - at, '-'));
    places.emplace_back(at, end);
    at = end + 2;
  }
  RC_ASSERT(places.size() == table.columns.size());
  const auto cell = [&](std::size_t line, std::size_t column) {
    std::string cut;
    std::size_t point = 0;
    for (const char c : lines[line]) {
      if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) ++point;
      if (point > places[column].first && point <= places[column].second) cut += c;
    }
    return cut;
  };
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    bool numbers = false;
    bool others = false;
    std::size_t widest = code_points(table.columns[i]);
    for (const auto& row : table.rows) {
      const bool null = std::holds_alternative<db::Null>(row[i]);
      const bool number =
          std::holds_alternative<std::int64_t>(row[i]) || std::holds_alternative<double>(row[i]);
      numbers = numbers || number;
      others = others || !(null || number);
    }
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      std::string shown = cell(row + 2, i);
      const std::string padded = shown;
      if (const auto* whole = std::get_if<std::int64_t>(&table.rows[row][i])) {
        const std::size_t begin = shown.find_first_not_of(' ');
        RC_ASSERT(begin != std::string::npos);
        shown = shown.substr(begin, shown.find_last_not_of(' ') + 1 - begin);
        RC_ASSERT(shown == std::to_string(*whole));
        widest = std::max(widest, shown.size());
        // Flush with its side.
        if (numbers && !others) RC_ASSERT(padded.back() != ' ');
        if (others) RC_ASSERT(padded.front() != ' ');
      }
      if (std::holds_alternative<db::Null>(table.rows[row][i]))
        RC_ASSERT(shown.find("NULL") != std::string::npos);
      if (const auto* real = std::get_if<double>(&table.rows[row][i])) RC_ASSERT(std::stod(shown) == *real);
    }
    RC_ASSERT(places[i].second - places[i].first >= widest);
  }
}

// --- reports of Google Benchmark ----------------------------------------------------

void reports_are_read_in_their_units() {
  const ScratchFolder folder;
  nlohmann::json report;
  report["context"] = {{"date", "2026-01-31T12:30:00+01:30"},
                       {"host_name", "host"},
                       {"executable", "/some/where/program"},
                       {"num_cpus", 4},
                       {"mhz_per_cpu", 2000},
                       {"library_build_type", "release"},
                       {"library_version", "v1.9"},
                       {"compiler", "gcc 12"}};
  const bool has_commit = any_flag();
  if (has_commit) report["context"]["commit"] = "0123456789abcdef";
  std::vector<db::Measurement> expected;
  const std::map<std::string, double> units = {{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  report["benchmarks"] = nlohmann::json::array();
  for (const char* benchmark : {"sort/8", "search_median"}) {
    const auto repetitions = any_whole(1, 3);
    const auto kind = any_whole(0, 3);  // 3: aggregates alone
    const auto unit = std::next(units.begin(), any_whole(0, 3));
    std::vector<std::string> aggregates =
        kind < 3 ? std::vector<std::string>{""} : std::vector<std::string>{};
    if (kind == 3 || repetitions > 1) {
      for (const char* aggregate : {"mean", "median", "stddev"}) {
        if (std::string(aggregate) != "median" || any_flag()) aggregates.emplace_back(aggregate);
      }
    }
    const bool has_median = std::count(aggregates.begin(), aggregates.end(), "median") > 0;
    for (const std::string& aggregate : aggregates) {
      for (std::int64_t repetition = 0; repetition < (aggregate.empty() ? repetitions : 1); ++repetition) {
        db::Measurement one;
        one.benchmark = benchmark;
        one.repetition = aggregate.empty() ? repetition : 0;
        one.iterations = any_whole(1, 1000);
        one.threads = any_whole(1, 4);
        one.aggregate = aggregate;
        const auto real_time = any_whole(1, 99);
        const auto cpu_time = any_whole(1, 99);
        nlohmann::json line = {{"name", std::string(benchmark) + (aggregate.empty() ? "" : "_" + aggregate)},
                               {"run_name", benchmark},
                               {"run_type", aggregate.empty() ? "iteration" : "aggregate"},
                               {"repetitions", repetitions},
                               {"threads", one.threads},
                               {"iterations", one.iterations},
                               {"real_time", real_time},
                               {"cpu_time", cpu_time},
                               {"time_unit", unit->first}};
        if (!aggregate.empty()) line["aggregate_name"] = aggregate;
        if (any_flag()) line["label"] = one.label = "a label";
        if (any_flag()) {
          const auto value = static_cast<double>(any_whole(1, 80)) / 8;
          line["items_per_second"] = value;
          one.counters = {{"items_per_second", value}};
        }
        const auto trouble = aggregate.empty() ? any_whole(0, 5) : 5;
        if (trouble == 0) {
          line["error_occurred"] = true;
          line["error_message"] = one.error = "it failed";
        } else if (trouble == 1) {
          line["skipped"] = true;
          line["skip_message"] = "not here";
          one.error = "skipped: not here";
        } else {
          one.real_time_ns = static_cast<double>(real_time) * unit->second;
          one.cpu_time_ns = static_cast<double>(cpu_time) * unit->second;
        }
        report["benchmarks"].push_back(line);
        const bool is_kept = kind < 3 ? aggregate.empty() : aggregate == (has_median ? "median" : "mean");
        if (is_kept) expected.push_back(std::move(one));
      }
    }
  }
  const std::filesystem::path file = folder.path() / "report.json";
  std::ofstream(file) << report.dump(1);
  ImportContext context;
  context.branch = "topic";
  if (any_flag()) context.suite = "my suite";
  const auto run = read_google_benchmark(file.string(), context);
  if (!run) RC_FAIL(run.error());
  RC_ASSERT(run->started_utc == "2026-01-31T11:00:00.000Z");
  RC_ASSERT(run->info.machine.host == "host");
  RC_ASSERT(run->info.machine.cores == 4);
  RC_ASSERT(run->info.machine.cpu_model == "2000 MHz");
  RC_ASSERT(run->info.build.build_type == "release");
  RC_ASSERT(run->info.suite == (context.suite.empty() ? "program" : context.suite));
  RC_ASSERT(run->info.branch == "topic");
  RC_ASSERT(run->info.options ==
            (has_commit ? "commit=0123456789abcdef compiler=gcc 12" : "compiler=gcc 12"));
  RC_ASSERT(run->info.commit.has_value() == has_commit);
  RC_ASSERT(run->measurements.size() == expected.size());
  const auto key = [](const db::Measurement& one) { return std::tie(one.benchmark, one.repetition); };
  for (const db::Measurement& one : expected) {
    const auto found = std::find_if(run->measurements.begin(), run->measurements.end(),
                                    [&](const auto& other) { return key(other) == key(one); });
    RC_ASSERT(found != run->measurements.end());
    RC_LOG() << one.benchmark << ' ' << one.repetition << '\n';
    RC_ASSERT(found->iterations == one.iterations);
    RC_ASSERT(found->threads == one.threads);
    RC_ASSERT(found->real_time_ns == one.real_time_ns);
    RC_ASSERT(found->cpu_time_ns == one.cpu_time_ns);
    RC_ASSERT(found->error == one.error);
    RC_ASSERT(found->label == one.label);
    RC_ASSERT(found->aggregate == one.aggregate);
    RC_ASSERT(found->counters == one.counters);
  }
  // The same report again is the same run; another one, or another commit, is not.
  RC_ASSERT(read_google_benchmark(file.string(), context)->uuid == run->uuid);
  ImportContext other = context;
  other.commit = "fedcba9876543210";
  RC_ASSERT(read_google_benchmark(file.string(), other)->uuid != run->uuid);
  other = context;
  other.suite = "another suite";
  RC_ASSERT(read_google_benchmark(file.string(), other)->uuid != run->uuid);
}

/// A moment in UTC from any offset, days and years apart included; what is no date is refused.
void dates_are_read_in_their_zone() {
  const ScratchFolder folder;
  const auto moment = static_cast<std::time_t>(any_whole(1'700'000'000, 1'900'000'000));
  const auto hours = any_whole(0, 14);
  const auto minutes = any_whole(0, 3) * 15;
  const bool ahead = any_flag();
  const std::time_t offset_s = (hours * 60 + minutes) * 60;
  const auto text = [](std::time_t at, const char* format) {
    std::tm fields = {};
    gmtime_r(&at, &fields);
    char buffer[64];
    std::strftime(buffer, sizeof buffer, format, &fields);
    return std::string(buffer);
  };
  char zone[16];
  std::snprintf(zone, sizeof zone, "%c%02d:%02d", ahead ? '+' : '-', static_cast<int>(hours),
                static_cast<int>(minutes));
  const auto form = any_whole(0, 3);
  const std::string date =
      form == 0   ? text(moment, "%Y-%m-%dT%H:%M:%SZ")
      : form == 1 ? text(moment, "%Y-%m-%d %H:%M:%S")
      : form == 2 ? text(moment, "%m/%d/%y %H:%M:%S")
                  : text(ahead ? moment + offset_s : moment - offset_s, "%Y-%m-%dT%H:%M:%S") + zone;
  const auto read = [&](const std::string& said) {
    const nlohmann::json report = {{"context", {{"date", said}}},
                                   {"benchmarks", {{{"name", "a"}, {"real_time", 1}}}}};
    std::ofstream(folder.path() / "report.json") << report.dump();
    return read_google_benchmark((folder.path() / "report.json").string(), {});
  };
  RC_LOG() << date << '\n';
  const auto run = read(date);
  RC_ASSERT(run.has_value());
  RC_ASSERT(run->started_utc == text(moment, "%Y-%m-%dT%H:%M:%S.000Z"));
  for (const char* wrong :
       {"2026-02-30T12:00:00Z", "2026-13-01T12:00:00Z", "2026-01-31T24:30:00Z", "2026-01-31",
        "2026-01-31T12:00:00+25:00", "2026-01-31T12:00:00+01:60", "yesterday", ""}) {
    RC_ASSERT(!read(wrong).has_value());
  }
}

// --- logs ---------------------------------------------------------------------------

void logs_of_engines_are_read_in_their_units() {
  const bool forked = any_flag();
  std::string log = "INFO: Seed: 1\n";
  std::vector<db::FuzzSnapshot> lines;
  std::int64_t corpus_bytes = 0;
  std::int64_t peak_mb = 0;
  std::int64_t executions = 0;
  for (auto left = any_whole(0, 6); left > 0; --left) {
    executions += any_whole(1, 100);
    db::FuzzSnapshot at;
    at.executions = executions;
    at.edges = any_whole(0, 999);
    at.features = any_whole(0, 999);
    at.corpus_files = any_whole(0, 99);
    const auto rate = any_whole(0, 50);
    const auto mb = any_whole(1, 99);
    const auto amount = any_whole(1, 99);
    const auto unit = static_cast<std::size_t>(any_whole(0, 2));
    if (forked) {
      const auto seconds = any_whole(0, 99);
      at.elapsed_ns = seconds * 1'000'000'000;
      log += "#" + std::to_string(executions) + ": cov: " + std::to_string(at.edges) +
             " ft: " + std::to_string(at.features) + " corp: " + std::to_string(at.corpus_files) +
             " exec/s " + std::to_string(rate) +
             " oom/timeout/crash: 0/0/0 time: " + std::to_string(seconds) + "s job: 3\n";
    } else {
      at.memory_bytes = mb * 1024 * 1024;
      at.elapsed_ns =
          rate == 0
              ? 0
              : static_cast<std::int64_t>(static_cast<double>(executions) / static_cast<double>(rate) * 1e9);
      log += "#" + std::to_string(executions) + "\tpulse  cov: " + std::to_string(at.edges) +
             " ft: " + std::to_string(at.features) + " corp: " + std::to_string(at.corpus_files) + "/" +
             std::to_string(amount) + std::string(1, "bKM"[unit]) + (unit == 0 ? "" : "b") +
             " lim: 80 exec/s: " + std::to_string(rate) + " rss: " + std::to_string(mb) + "Mb\n";
      peak_mb = std::max(peak_mb, mb);
      corpus_bytes = std::max(corpus_bytes, amount << (10 * unit));
    }
    lines.push_back(at);
  }
  const auto slowest = any_whole(0, 20);
  const auto final_mb = any_whole(1, 200);
  log += "stat::slowest_unit_time_sec:     " + std::to_string(slowest) +
         "\nstat::peak_rss_mb:              " + std::to_string(final_mb) + "\n";
  const EngineLog read = parse_engine_log(log);
  RC_ASSERT(read.slowest_input_s == slowest);
  RC_ASSERT(read.peak_memory_bytes == std::max(peak_mb, final_mb) * 1024 * 1024);
  RC_ASSERT(read.corpus_bytes == corpus_bytes);
  const auto same = [](const db::FuzzSnapshot& a, const db::FuzzSnapshot& b) {
    return std::tie(a.executions, a.elapsed_ns, a.edges, a.features, a.corpus_files, a.memory_bytes) ==
           std::tie(b.executions, b.elapsed_ns, b.edges, b.features, b.corpus_files, b.memory_bytes);
  };
  if (lines.empty()) {
    RC_ASSERT(read.snapshots.empty());
    return;
  }
  RC_ASSERT(same(read.last, lines.back()));
  // The first, then each with a quarter more than the one before that was kept, and the last.
  std::vector<db::FuzzSnapshot> kept;
  for (const db::FuzzSnapshot& at : lines) {
    if (kept.empty() || 4 * (at.executions - kept.back().executions) > kept.back().executions)
      kept.push_back(at);
  }
  if (kept.back().executions < lines.back().executions) kept.push_back(lines.back());
  RC_LOG() << log;
  RC_ASSERT(read.snapshots.size() == kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) RC_ASSERT(same(read.snapshots[i], kept[i]));
}

void coverage_is_that_of_the_planner() {
  nlohmann::json files = nlohmann::json::array();
  std::vector<std::tuple<std::string, std::int64_t, std::int64_t>> expected;
  for (auto left = any_whole(0, 4); left > 0; --left) {
    const bool ours = any_flag();
    const std::string path = std::string(ours ? "planner/grid/" : "fuzz/") + std::to_string(left) + ".cpp";
    const auto lines = any_whole(1, 99);
    const auto covered = any_whole(0, lines);
    files.push_back({{"filename", "/home/planner-of-mine/" + path},
                     {"summary",
                      {{"lines", {{"count", lines}, {"covered", covered}, {"percent", 1}}},
                       {"regions", {{"count", 7}, {"covered", 3}}}}}});
    if (ours) expected.emplace_back(path, lines, covered);
  }
  const auto read = parse_coverage(nlohmann::json{{"data", {{{"files", files}}}}}.dump(), "name");
  RC_ASSERT(read.has_value() == !expected.empty());
  if (!read) return;
  RC_ASSERT(read->size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    RC_ASSERT(std::tie((*read)[i].file, (*read)[i].lines, (*read)[i].covered_lines) ==
              std::tie(std::get<0>(expected[i]), std::get<1>(expected[i]), std::get<2>(expected[i])));
  }
}

nlohmann::json line_of(const db::PropertyRun& run) {
  nlohmann::json line;
  const auto put = [&line](const char* name, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, std::optional<std::int64_t>>) {
      if (value) line[name] = *value;
    } else if constexpr (std::is_same_v<T, std::string> || std::is_arithmetic_v<T>) {
      line[name] = value;
    } else {
      line[name] = value.text;
    }
  };
  db::PropertyRun::origin_columns(run, put);
  db::PropertyRun::columns(run, put);
  line["classes"] = run.classes;
  return line;
}

/// Runs that ended, ended and were told twice, or only began; what is wrong in one line is named.
void logs_of_properties_are_read_as_written() {
  std::string log;
  std::vector<db::PropertyRun> expected;
  for (auto left = any_whole(1, 4); left > 0; --left) {
    db::PropertyRun run = db::any_property_run();
    if (run.status == "crashed") run.status = "passed", run.message.clear();
    db::PropertyRun begun = run;
    begun.status = "started";
    begun.reproduce.clear();
    const bool ended = any_flag();
    if (any_flag() || !ended) log += line_of(begun).dump() + "\n";
    if (ended) log += line_of(run).dump() + "\n" + (any_flag() ? "\n" : "");
    expected.push_back(ended ? run : begun);
    if (!ended) expected.back().status = "crashed";
  }
  const auto read = parse_property_log(log, "log");
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->size() == expected.size());
  PropertyTotals totals;
  for (const db::PropertyRun& run : expected) {
    const auto found = std::find_if(read->begin(), read->end(),
                                    [&run](const auto& other) { return other.uuid == run.uuid; });
    RC_ASSERT(found != read->end());
    if (run.status == "crashed") {
      RC_ASSERT(found->status == "crashed");
      RC_ASSERT(found->message.find("seed=" + std::to_string(run.seed) + " ") != std::string::npos);
    } else {
      RC_ASSERT(line_of(*found) == line_of(run));
    }
    ++totals.runs;
    totals.cases += run.cases;
    totals.discards += run.discards;
    totals.failed += run.status == "failed" ? 1U : 0U;
    totals.gave_up += run.status == "gave_up" ? 1U : 0U;
    totals.crashed += run.status == "crashed" ? 1U : 0U;
    totals.wall_time_s += static_cast<double>(run.wall_time_ns) / 1e9;
  }
  const PropertyTotals said = totals_of(*read);
  RC_ASSERT(
      std::tie(said.runs, said.cases, said.discards, said.failed, said.gave_up, said.crashed) ==
      std::tie(totals.runs, totals.cases, totals.discards, totals.failed, totals.gave_up, totals.crashed));
  RC_ASSERT(std::abs(said.wall_time_s - totals.wall_time_s) < 1e-6);
  // Each rule of a line broken alone.
  nlohmann::json wrong = line_of(db::any_property_run());
  wrong["status"] = "failed";
  wrong["message"] = "why";
  wrong["reproduce"] = "how";
  RC_ASSERT(parse_property_log(wrong.dump(), "log").has_value());
  const std::vector<std::pair<const char*, nlohmann::json>> breaks = {
      {"uuid", "short"},
      {"title", ""},
      {"status", "fine"},
      {"shrinks", wrong["shrink_tries"].get<std::int64_t>() + 1},
      {"message", ""},
      {"reproduce", ""},
      {"cases", -1},
      {"cases", "1"},
      {"seed", -1},
      {"room", 3},
      {"classes", {{"dense", 0}}},
      {"case_robots", "x"},
      {"wall_time_ns", nullptr}};
  const auto& [key, value] =
      breaks[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(breaks.size()) - 1))];
  wrong[key] = value;
  const auto refused = parse_property_log(log + wrong.dump(), "log");
  RC_LOG() << wrong.dump() << '\n';
  RC_ASSERT(!refused.has_value());
  const auto at = static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n')) + 1;
  RC_ASSERT(refused.error().find("log:" + std::to_string(at) + ": \"" + key + "\"") == 0U);
}

// --- words between processes --------------------------------------------------------

void workers_are_understood() {
  WorkerGreeting greeting;
  greeting.protocol = static_cast<int>(any_whole(0, 4));
  greeting.build = {*any_text(), *any_text(), *any_text(), *any_text(),
                    any_flag(),  *any_text(), *any_text(), any_flag()};
  greeting.program = *any_text();
  greeting.unfit = *any_text();
  greeting.injected_slowdown = static_cast<double>(any_whole(0, 8)) / 8;
  const auto heard = greeting_from_json(nlohmann::json::parse(to_json(greeting).dump()));
  RC_ASSERT(heard.has_value() == (greeting.protocol == 1 || greeting.protocol == 2));
  if (heard) {
    const auto fields = [](const WorkerGreeting& g) {
      return std::tie(g.protocol, g.build.compiler, g.build.compiler_version, g.build.flags,
                      g.build.build_type, g.build.assertions, g.build.sanitizers, g.build.binary_hash,
                      g.build.dirty, g.program, g.unfit, g.injected_slowdown);
    };
    RC_ASSERT(fields(*heard) == fields(greeting));
  }
  WorkerAnswer answer;
  answer.row = db::any_result();
  answer.cpu_ns = any_whole(0, 1 << 30);
  const auto read = answer_from_json(nlohmann::json::parse(to_json(answer).dump()));
  RC_ASSERT(read.has_value());
  const auto told = [](const db::ResultRow& row) {
    return std::tie(row.status, row.tries, row.expansions, row.generations, row.makespan_s, row.flowtime_s,
                    row.plan_hash, row.valid, row.peak_memory_bytes, row.message);
  };
  RC_ASSERT(told(read->row) == told(answer.row));
  RC_ASSERT(read->cpu_ns == answer.cpu_ns);
  RC_ASSERT(read->row.planning_time_ns == answer.cpu_ns);
  const PlanCase plan_case = any_flag() ? *any_case() : *any_turning_case();
  const auto options = options_from_json(nlohmann::json::parse(to_json(plan_case.options).dump()));
  RC_ASSERT(options.has_value());
  for (const Option& option : option_rows()) {
    RC_LOG() << option.name << '\n';
    RC_ASSERT(option.get(*options) ==
              (std::string(option.name) == "time-limit" ? "inf" : option.get(plan_case.options)));
  }
}

// --- SQL ----------------------------------------------------------------------------

/// Statements that would change something are refused, and change nothing.
void questions_change_nothing() {
  static const db::NewHistory kHistory;
  static const bool kRecorded = [] {
    db::record(kHistory.path(), db::any_sweep());
    return true;
  }();
  RC_ASSERT(kRecorded);
  const std::vector<std::string> kRefused = {"DELETE FROM run",
                                             "UPDATE run SET suite = 'x'",
                                             "INSERT INTO fuzz_coverage VALUES ('a', 'b', 1, 1)",
                                             "DROP TABLE result",
                                             "DROP VIEW v_runs",
                                             "CREATE TABLE x (y)",
                                             "ALTER TABLE run RENAME TO x",
                                             "PRAGMA user_version = 3",
                                             "PRAGMA journal_mode = DELETE",
                                             "PRAGMA foreign_keys = OFF",
                                             "ATTACH ':memory:' AS x",
                                             "BEGIN",
                                             "VACUUM",
                                             "REINDEX",
                                             "ANALYZE",
                                             "SELECT load_extension('x')",
                                             "SELECT 1; SELECT 2",
                                             "",
                                             "-- nothing",
                                             "WITH a AS (SELECT 1) DELETE FROM run",
                                             "SAVEPOINT x",
                                             "PRAGMA wal_checkpoint",
                                             "EXPLAIN QUERY PLAN DELETE FROM run"};
  const std::string& refused =
      kRefused[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(kRefused.size()) - 1))];
  RC_LOG() << refused << '\n';
  const auto before = db::must(db::run_sql(kHistory.path(),
                                           "SELECT (SELECT count(*) FROM run) + (SELECT count(*) FROM "
                                           "sqlite_schema), (SELECT user_version FROM pragma_user_version)"))
                          .rows;
  RC_ASSERT(!db::run_sql(kHistory.path(), refused).has_value());
  RC_ASSERT(db::must(db::run_sql(kHistory.path(),
                                 "SELECT (SELECT count(*) FROM run) + (SELECT count(*) FROM sqlite_schema), "
                                 "(SELECT user_version FROM pragma_user_version)"))
                .rows == before);
  const std::vector<std::string> kAnswered = {"SELECT 1;",
                                              "SELECT count(*) FROM v_runs; -- all",
                                              "PRAGMA table_info(run)",
                                              "PRAGMA user_version",
                                              "WITH a AS (SELECT 1) SELECT * FROM a",
                                              "VALUES (1), (2)",
                                              "SELECT json_extract('{\"a\": 1}', '$.a')",
                                              "EXPLAIN QUERY PLAN SELECT 1",
                                              "PRAGMA integrity_check"};
  const std::string& answered =
      kAnswered[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(kAnswered.size()) - 1))];
  RC_LOG() << answered << '\n';
  RC_ASSERT(db::run_sql(kHistory.path(), answered).has_value());
  // Parameters are numbers if they read as numbers.
  const auto row = db::must(db::run_sql(kHistory.path(), "SELECT typeof(:a), typeof(:b), typeof(:c), :a + 1",
                                        {{"a", "41"}, {"b", "2.5"}, {"c", "4x"}}))
                       .rows.at(0);
  RC_ASSERT(row[0] == Value{std::string("integer")});
  RC_ASSERT(row[1] == Value{std::string("real")});
  RC_ASSERT(row[2] == Value{std::string("text")});
  RC_ASSERT(row[3] == Value{std::int64_t{42}});
  RC_ASSERT(!db::run_sql(kHistory.path(), "SELECT :a").has_value());
  RC_ASSERT(!db::run_sql(kHistory.path(), "SELECT 1", {{"a", "1"}}).has_value());
}

/// The beginning of a UUID names the run that it fits, sweeps and reports before all others.
void beginnings_of_names_are_enough() {
  const db::NewHistory history;
  db::Database database = history.open();
  struct Run {
    std::string uuid;
    bool comparable;
  };
  std::vector<Run> runs;
  for (auto left = any_whole(1, 4); left > 0; --left) {
    // Of few digits, so that some begin alike.
    std::string uuid = db::new_uuid();
    for (std::size_t i = 0; i < 8; ++i) uuid[i] = any_whole(0, 3) == 0 ? 'a' : 'b';
    if (any_flag()) {
      db::MeasurementRun report = db::any_report();
      report.uuid = uuid;
      db::must(db::record_measurements(database, report));
      runs.push_back({uuid, true});
    } else {
      db::PropertyRun property = db::any_property_run();
      property.uuid = uuid;
      db::must(db::record_property_runs(database, db::any_origin(), {property}));
      runs.push_back({uuid, false});
    }
  }
  const Run& meant = runs[static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(runs.size()) - 1))];
  const std::string text = meant.uuid.substr(0, static_cast<std::size_t>(any_whole(1, 10)));
  std::vector<std::string> fitting;
  for (const bool comparable : {true, false}) {
    if (!fitting.empty()) break;
    for (const Run& run : runs) {
      if ((run.comparable || !comparable) && run.uuid.substr(0, text.size()) == text)
        fitting.push_back(run.uuid);
    }
  }
  const auto found = db::resolve_run(database, text);
  RC_ASSERT(found.has_value() == (text.size() >= 4 && fitting.size() == 1));
  if (found) RC_ASSERT(*found == fitting[0]);
  RC_ASSERT(db::must(db::resolve_run(database, meant.uuid)) == meant.uuid);
}

const PropertyRoom room("lab_formats", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("a table as CSV is read as it was written", csv_is_read_as_written);
  passed &= property("a table as JSON is read as it was written", json_is_read_as_written);
  passed &= property("columns are aligned", columns_are_aligned);
  passed &= property("reports of Google Benchmark are read in their units", reports_are_read_in_their_units,
                     kFewer);
  passed &= property("dates are read in their zone", dates_are_read_in_their_zone, kFewer);
  passed &= property("logs of engines are read in their units", logs_of_engines_are_read_in_their_units);
  passed &= property("coverage is that of the planner", coverage_is_that_of_the_planner);
  passed &= property("logs of properties are read as they were written, and what is wrong is named",
                     logs_of_properties_are_read_as_written);
  passed &= property("workers of the gate are understood", workers_are_understood);
  passed &= property("a question in SQL changes nothing", questions_change_nothing, kFewer);
  passed &=
      property("the beginning of its name is enough for a run", beginnings_of_names_are_enough, kFewest);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::lab_formats_laws
