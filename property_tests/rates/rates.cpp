// Measures how often the soft relations hold, over cases of all families:
//
//     rates [--cases N] [--seed S]
//
// A table goes to stdout and, if SIPPLAB_PROPERTY_LOG names a file, one line for
// each relation to that. A low rate is no failure; exit code 1 means that counts do not add
// up or that the log cannot be written, 2 bad usage.
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/io/text.hpp"
#include "property_tests/rates/rate.hpp"
#include "property_tests/rates/relations.hpp"
#include "property_tests/support/case_maker.hpp"
#include "property_tests/support/property_log.hpp"

namespace sipplab {
namespace {

constexpr std::int64_t kDefaultCases = 3000;
constexpr std::int64_t kMostCases = 10'000'000;
constexpr std::uint64_t kDefaultSeed = 20180710;
/// Sizes of cases go round from 0 to this.
constexpr std::int64_t kLargestSize = 100;

struct Budget {
  std::int64_t cases = kDefaultCases;
  std::uint64_t seed = kDefaultSeed;
};

std::optional<Budget> parse_arguments(const std::vector<std::string_view>& words) {
  Budget budget;
  if (words.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto number = parse_integer(words[i + 1]);
    if (!number || *number < 0) return std::nullopt;
    if (words[i] == "--cases" && *number <= kMostCases) {
      budget.cases = *number;
    } else if (words[i] == "--seed") {
      budget.seed = static_cast<std::uint64_t>(*number);
    } else {
      return std::nullopt;
    }
  }
  return budget;
}

struct Measured {
  Rate rate;
  std::chrono::steady_clock::duration elapsed{};
};

std::vector<Measured> measure(const Budget& budget) {
  const std::vector<Relation>& relations = soft_relations();
  std::vector<Measured> measured;
  for (const Relation& relation : relations) measured.push_back({{relation.title, 0, 0, 0}, {}});
  Random seeds(budget.seed);
  for (std::int64_t i = 0; i < budget.cases; ++i) {
    const auto family = static_cast<CaseFamily>(i % kCaseFamilies);
    const auto size = static_cast<int>((i / kCaseFamilies) % (kLargestSize + 1));
    const Planned planned = plan_of(make_case(family, size, seeds.next()));
    const std::uint64_t choices = seeds.next();
    for (std::size_t k = 0; k < relations.size(); ++k) {
      Random random(choices);  // each relation its own, so that a new one changes no other
      const auto begin = std::chrono::steady_clock::now();
      measured[k].rate.count(relations[k].holds(planned, random));
      measured[k].elapsed += std::chrono::steady_clock::now() - begin;
    }
  }
  return measured;
}

/// A property run whose classes are the outcomes, so that the history keeps it as one,
/// with the kind "rate" and the interval next to it.
std::string log_line(const Measured& measured, const Budget& budget) {
  const Rate& rate = measured.rate;
  db::PropertyRun record;
  record.uuid = db::new_uuid();
  record.started_utc = db::utc_now();
  record.room = "rates";
  record.title = rate.title;
  record.seed = budget.seed;
  record.max_success = static_cast<std::int64_t>(budget.cases);
  record.status = "passed";
  record.cases = rate.applicable();
  record.discards = rate.not_applicable;
  record.wall_time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(measured.elapsed).count();
  if (rate.held > 0) record.classes["held"] = rate.held;
  if (rate.broken > 0) record.classes["broken"] = rate.broken;
  std::string line = to_json_line(record);
  const db::statistics::ConfidenceInterval interval = rate.interval();
  const std::string value = rate.value() ? format_real(*rate.value()) : "null";
  const std::string more = R"(,"kind":"rate","held":)" + std::to_string(rate.held) + R"(,"rate":)" + value +
                           R"(,"rate_low":)" + format_real(interval.low) + R"(,"rate_high":)" +
                           format_real(interval.high);
  return line.insert(line.rfind('}'), more);
}

int run(const Budget& budget) {
  const char* log = std::getenv("SIPPLAB_PROPERTY_LOG");
  bool sound = true;
  std::cout << rate_table_heading();
  for (const Measured& measured : measure(budget)) {
    std::cout << rate_table_row(measured.rate);
    if (measured.rate.cases() != budget.cases) {
      std::cerr << "'" << measured.rate.title << "' counts " << measured.rate.cases() << " cases, expected "
                << budget.cases << '\n';
      sound = false;
    }
    if (log == nullptr || *log == '\0') continue;
    if (const auto error = append_to_log(log, log_line(measured, budget))) {
      std::cerr << *error << '\n';
      sound = false;
    }
  }
  return sound ? 0 : 1;
}

}  // namespace
}  // namespace sipplab

int main(int argc, char** argv) {
  const auto budget = sipplab::parse_arguments({argv + 1, argv + argc});
  if (!budget) {
    std::cerr << "usage: rates [--cases N] [--seed S], both whole numbers from 0\n";
    return 2;
  }
  return sipplab::run(*budget);
}
