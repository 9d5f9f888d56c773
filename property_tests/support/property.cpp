// Runs one property with a listener that counts; see property.hpp.
#include "property_tests/support/property.hpp"

#include <rapidcheck/detail/TestListenerAdapter.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "bench/campaigns/replay.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/property_log.hpp"

// Set for this file alone by property_tests/CMakeLists.txt.
#if !defined(SIPPLAB_PROPERTY_PARAMS) || !defined(SIPPLAB_SOURCE_DIR)
#error "SIPPLAB_PROPERTY_PARAMS (what RC_PARAMS leaves open) and SIPPLAB_SOURCE_DIR are to be defined"
#endif

namespace sipplab {
namespace {

using rc::detail::CaseDescription;
using rc::detail::CaseResult;
using rc::detail::Example;
using rc::detail::FailureResult;
using rc::detail::Reproduce;

struct Room {
  int cases;
  bool (*run)();
};

/// By name; filled before main begins.
std::map<std::string, Room>& rooms() {
  static std::map<std::string, Room> all;
  return all;
}

/// The one that runs.
std::string current_room;

/// What note_case said since the last case ended.
std::optional<PlanCase> noted_case;

/// The case in a counterexample as rapidcheck prints it.
std::optional<PlanCase> drawn_case(const Example& counterexample) {
  for (const auto& [type, value] : counterexample) {
    if (type.find("PlanCase") == std::string::npos) continue;
    if (auto plan_case = decode_case(value)) return plan_case;
  }
  return std::nullopt;
}

std::string text_of(const Example& counterexample) {
  std::string text;
  for (const auto& [type, value] : counterexample) {
    text += (text.empty() ? "" : "\n") + type + ":\n" + value + "\n";
  }
  return text;
}

/// rapidcheck prints a tag as it prints any text, in quotes.
std::string without_quotes(const std::string& tag) {
  const bool quoted = tag.size() >= 2 && tag.front() == '"' && tag.back() == '"';
  return quoted ? tag.substr(1, tag.size() - 2) : tag;
}

/// Counts cases, classes and shrinks while rapidcheck works.
class Tally : public rc::detail::TestListenerAdapter {
 public:
  explicit Tally(db::PropertyRun& record) : record_(record) {}

  void onTestCaseFinished(const CaseDescription& description) override {
    if (description.result.type == CaseResult::Type::Discard) {
      ++record_.discards;
    } else {
      ++record_.cases;
      // A class counts once, however often a case says that it is in it.
      for (const auto& tag : std::set<std::string>(description.tags.begin(), description.tags.end())) {
        ++record_.classes[without_quotes(tag)];
      }
    }
    end_case(description.result.type == CaseResult::Type::Failure);
  }

  void onShrinkTried(const CaseDescription& /*shrink*/, bool accepted) override {
    ++record_.shrink_tries;
    if (accepted) ++record_.shrinks;
    end_case(accepted);
  }

  /// What the smallest counterexample noted, if anything.
  const std::optional<PlanCase>& failing_case() const { return failing_case_; }

 private:
  void end_case(bool failed) {
    if (failed) failing_case_ = noted_case;
    noted_case.reset();
  }

  db::PropertyRun& record_;
  std::optional<PlanCase> failing_case_;
};

/// rapidcheck overlooks keys that it does not know.
void check_keys(const std::string& params) {
  const std::string known = " reproduce= " + rc::detail::configToString({});
  std::istringstream words(params);
  for (std::string word; words >> word;) {
    const std::string key = word.substr(0, word.find('='));
    if (known.find(" " + key + "=") == std::string::npos)
      throw rc::detail::ConfigurationException("unknown key '" + key + "'");
  }
}

/// Of so many cases one is tried, if RC_PARAMS names no number.
int share_of_cases() {
  const char* given = std::getenv("SIPPLAB_ONE_CASE_OF");
  if (given == nullptr || *given == '\0') return 1;
  int share = 0;
  const char* end = given + std::strlen(given);
  const auto [rest, error] = std::from_chars(given, end, share);
  if (error == std::errc() && rest == end && share > 0) return share;
  std::cerr << "SIPPLAB_ONE_CASE_OF: '" << given << "', expected a number from 1 on\n";
  std::exit(2);
}

/// RC_PARAMS, and the project's own values for what it leaves open.
rc::detail::Configuration configured(int cases) {
  auto defaults = rc::detail::configFromString(SIPPLAB_PROPERTY_PARAMS);
  defaults.testParams.maxSuccess = std::max(1, cases / share_of_cases());
  const char* given = std::getenv("RC_PARAMS");
  const std::string params = given == nullptr ? "" : given;
  try {
    check_keys(params);
    return rc::detail::configFromString(params, defaults);
  } catch (const rc::detail::ConfigurationException& error) {
    std::cerr << "RC_PARAMS: " << error.what() << ", expected such as \"seed=7 max_success=100\"\n";
    std::exit(2);
  }
}

std::string reproduce_text(const std::string& title, const Reproduce& reproduce) {
  rc::detail::Configuration configuration;
  configuration.reproduce[title] = reproduce;
  const std::string text = rc::detail::configToMinimalString(configuration);
  // It names the seed, too, which a counterexample does not depend on.
  const std::size_t begin = text.find("reproduce=");
  return text.substr(begin, text.find(' ', begin) - begin);
}

/// The text with files named from the root of the project, as on every machine; ccache may
/// have them named from the folder of the build.
std::string from_the_root(std::string text) {
  for (const std::string folder : {SIPPLAB_SOURCE_DIR "/", "../"}) {
    for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;)
      text.erase(at, folder.size());
  }
  return text;
}

void describe_failure(const FailureResult& failure, const Tally& tally, db::PropertyRun& record) {
  record.status = "failed";
  record.message = from_the_root(failure.description);
  record.reproduce = reproduce_text(record.title, failure.reproduce);
  record.counterexample = text_of(failure.counterExample);
  auto plan_case = tally.failing_case();
  if (!plan_case) plan_case = drawn_case(failure.counterExample);
  if (!plan_case) return;
  record.plan_case = encode_case(*plan_case);
  record.case_robots = static_cast<std::int64_t>(plan_case->instance.agents.size());
  record.case_cells = static_cast<std::int64_t>(plan_case->instance.map.cell_count());
}

std::string percent(std::int64_t part, std::int64_t whole) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text;
}

void print_summary(const db::PropertyRun& record) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.2f s", static_cast<double>(record.wall_time_ns) * 1e-9);
  std::cerr << record.status << ": " << record.cases << " cases, " << record.discards << " discarded, "
            << seconds << '\n';
  std::string classes;
  for (const auto& [name, count] : record.classes) {
    classes += (classes.empty() ? "classes: " : ", ") + name + ' ' + percent(count, record.cases);
  }
  if (!classes.empty()) std::cerr << classes << '\n';
  if (record.status != "failed") return;
  if (!record.plan_case.empty()) std::cerr << "the case that was planned:\n" << record.plan_case;
  std::cerr << "shrunk in " << record.shrinks << " steps; to try the counterexample again:\n  RC_PARAMS=\""
            << record.reproduce << "\" properties " << record.room << '\n';
}

/// Appends the record to the log, if there is one. False if that fails.
bool log(const db::PropertyRun& record) {
  const char* path = std::getenv("SIPPLAB_PROPERTY_LOG");
  if (path == nullptr || *path == '\0') return true;
  const auto error = append_to_log(path, record);
  if (error) std::cerr << *error << '\n';
  return !error;
}

/// Tries one counterexample again. rapidcheck's own way reports "holds now" and
/// "cannot be found any more" as the same kind of error.
bool reproduce_failure(const rc::detail::Property& property, const Reproduce& reproduce) {
  const auto first = property(reproduce.random, reproduce.size);
  const auto smallest = rc::shrinkable::walkPath(first, reproduce.shrinkPath);
  if (!smallest) {
    std::cerr << "cannot be reproduced: what is drawn or how it shrinks has changed since\n";
    return false;
  }
  const CaseDescription description = smallest->value();
  const bool failed = description.result.type == CaseResult::Type::Failure;
  std::cerr << (failed ? "still fails:\n" : "does not fail any more:\n") << text_of(description.example())
            << '\n'
            << description.result.description << '\n';
  return !failed;
}

/// Whether a property that is to be reproduced is there.
bool met_reproduced = false;

void end_where_none_was_met() {
  if (met_reproduced) return;
  std::cerr << "no property of this room is the one that is to be reproduced\n";
  std::_Exit(bench::kNoSuchProperty);
}

}  // namespace

void note_case(const PlanCase& plan_case) { noted_case = plan_case; }

PropertyRoom::PropertyRoom(const char* name, int cases, bool (*run)()) {
  if (rooms().emplace(name, Room{cases, run}).second) return;
  std::cerr << "two rooms are called " << name << '\n';
  std::abort();
}

int run_room(std::span<const char* const> arguments) {
  const auto room = arguments.size() == 1 ? rooms().find(arguments.front()) : rooms().end();
  if (room == rooms().end()) {
    std::cerr << "usage: properties ROOM, expected one of";
    for (const auto& [name, ignored] : rooms()) std::cerr << ' ' << name;
    std::cerr << '\n';
    return arguments.size() == 1 ? bench::kNoSuchProperty : 2;
  }
  current_room = room->first;
  return room->second.run() ? 0 : 1;
}

bool run_property(const std::string& title, const std::function<void()>& testable, std::optional<int> cases) {
  const rc::detail::Property checked = rc::detail::toProperty(testable);
  const auto configuration = configured(cases ? *cases : rooms().at(current_room).cases);
  const auto reproduce = configuration.reproduce.find(title);
  if (!configuration.reproduce.empty()) {
    [[maybe_unused]] static const int registered = std::atexit(end_where_none_was_met);
    if (reproduce == configuration.reproduce.end()) return true;
    met_reproduced = true;
  }
  std::cerr << "\n- " << title << '\n';
  if (!configuration.reproduce.empty()) return reproduce_failure(checked, reproduce->second);

  db::PropertyRun record;
  record.uuid = db::new_uuid();
  record.started_utc = db::utc_now();
  record.room = current_room;
  record.title = title;
  record.seed = configuration.testParams.seed;
  record.max_success = configuration.testParams.maxSuccess;
  record.status = "started";
  if (!log(record)) return false;
  Tally tally(record);
  const auto begin = std::chrono::steady_clock::now();
  rc::detail::TestMetadata metadata;
  metadata.id = title;
  metadata.description = title;
  const auto result = rc::detail::checkProperty(checked, metadata, configuration.testParams, tally, {});
  const auto elapsed = std::chrono::steady_clock::now() - begin;
  record.wall_time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count();

  rc::detail::FailureResult failure;
  rc::detail::GaveUpResult gave_up;
  record.status = "passed";
  if (result.match(failure)) describe_failure(failure, tally, record);
  if (result.match(gave_up)) {
    record.status = "gave_up";
    record.message = from_the_root(gave_up.description);
  }
  if (record.status != "passed") {
    rc::detail::printResultMessage(result, std::cerr);
    std::cerr << '\n';
  }
  print_summary(record);

  return log(record) && record.status == "passed";
}

}  // namespace sipplab
