// Other programs as planners: what they are told, and what is believed of what they leave. The programs are
// lines of shell, drawn: honest ones, liars, and those that leave nothing after they had left something.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/sweep/command_planner.hpp"
#include "planner/io/text_file.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/solve.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::bench::outside_planners_laws {
namespace {

using db::any_flag;
using db::any_whole;

/// Each starts some shells.
constexpr int kShells = (kCasesOfHistories + 7) / 8;

Instance any_instance(std::size_t obstacles = 0) {
  GeneratorOptions options;
  options.obstacles = obstacles;
  options.agents = static_cast<std::size_t>(any_whole(1, 3));
  options.seed = static_cast<std::uint64_t>(any_whole(1, 9));
  return *generate_instance(*parse_map_spec("empty:6x4"), options);
}

CommandPlanner planner_of(const std::string& command, const std::string& no_plan = "", bool retime = false) {
  auto spec = parse_command_planner("cmd:" + command, "drawn");
  if (!spec) RC_FAIL(spec.error());
  spec->no_plan = no_plan;
  spec->retime = retime;
  auto made = CommandPlanner::make(*spec);
  if (!made) RC_FAIL(made.error());
  return std::move(*made);
}

db::ResultRow run(const CommandPlanner& planner, const Instance& instance,
                  const PlannerOptions& options = {}) {
  auto row = planner.run(instance, options);
  if (!row) RC_FAIL(row.error());
  return std::move(*row);
}

void write(const std::filesystem::path& file, const std::string& text) {
  RC_ASSERT(!write_file(file.string(), text).has_value());
}

std::string text_of(const std::filesystem::path& file) {
  const auto text = read_file(file.string());
  if (!text) RC_FAIL(text.error().message());
  return *text;
}

/// Every placeholder, read back: numbers as they are, files by what is in them.
void placeholders_stand_for_what_they_say() {
  const ScratchFolder folder;
  const std::filesystem::path said = folder.path() / "said";
  std::string command =
      "for w in {robots} {seed} {small_seed} {time_limit} {whole_time_limit} {out} {stats}; do echo \"$w\"; "
      "done >" +
      said.string();
  for (const char* name : {"instance", "task", "map", "obstacles", "movingai_map", "scen", "yaml", "config",
                           "ccbs_map", "ccbs_task", "ccbs_config"}) {
    command += "; cp {" + std::string(name) + "} " + (folder.path() / name).string();
  }
  command += "; echo '${none} {nothing}' >>" + said.string();
  const CommandPlanner planner = planner_of(command);
  const auto obstacles = static_cast<std::size_t>(any_whole(0, 1));
  const Instance instance = any_instance(obstacles);
  PlannerOptions options;
  options.seed = static_cast<std::uint64_t>(any_whole(0, 3)) * ((std::uint64_t{1} << 31) + 5) +
                 static_cast<std::uint64_t>(any_whole(0, 9));
  const auto eighths = any_whole(1, 80);
  options.time_limit_s =
      eighths == 80 ? std::numeric_limits<double>::infinity() : static_cast<double>(eighths) / 8;
  options.weight = 1.5;
  const double limit_s = eighths == 80 ? 300 : options.time_limit_s;
  run(planner, instance, options);

  std::istringstream lines(text_of(said));
  std::vector<std::string> words;
  for (std::string line; std::getline(lines, line);) words.push_back(line);
  RC_ASSERT(words.size() == 8U);
  RC_ASSERT(words[0] == std::to_string(instance.agents.size()));
  RC_ASSERT(words[1] == std::to_string(options.seed));
  RC_ASSERT(words[2] == std::to_string(options.seed % 2147483648U));
  RC_ASSERT(std::stod(words[3]) == limit_s);
  RC_ASSERT(words[4] == std::to_string(std::max(1L, static_cast<long>(limit_s))));
  RC_ASSERT(std::filesystem::path(words[5]).filename() == "solution");
  RC_ASSERT(std::filesystem::path(words[6]).filename() == "stats");
  RC_ASSERT(words[7] == "${none} {nothing}");  // a shell's own braces stay

  InstanceFiles files;
  files.instance = (folder.path() / "instance").string();
  auto whole = load_instance(files);
  RC_ASSERT(whole.has_value());
  RC_ASSERT(content_hash(whole->instance) == content_hash(instance));
  files = {};
  files.task = (folder.path() / "task").string();
  files.map = (folder.path() / "map").string();
  files.config = (folder.path() / "config").string();
  if (obstacles > 0) files.obstacles = (folder.path() / "obstacles").string();
  whole = load_instance(files);
  if (!whole) RC_FAIL(whole.error().message());
  RC_ASSERT(content_hash(whole->instance) == content_hash(instance));
  const PlannerOptions told = whole->options.applied_to({});
  RC_ASSERT(told.time_limit_s == limit_s);
  RC_ASSERT(told.weight == options.weight);
  files = {};
  files.instance = (folder.path() / "scen").string();
  files.map = (folder.path() / "movingai_map").string();
  whole = load_instance(files);
  RC_ASSERT(whole.has_value());
  RC_ASSERT(whole->instance.agents.size() == instance.agents.size());
  RC_ASSERT(whole->instance.map.width() == 6);
  RC_ASSERT(whole->instance.map.height() == 4);
  for (std::size_t i = 0; i < instance.agents.size(); ++i) {
    RC_ASSERT(whole->instance.agents[i].start == instance.agents[i].start);
    RC_ASSERT(whole->instance.agents[i].goal == instance.agents[i].goal);
  }
  // libMultiRobotPlanning: x and y of each start and goal; the size of the map.
  const std::string yaml = text_of(folder.path() / "yaml");
  RC_ASSERT(yaml.find("6") < yaml.find("4") || yaml.find("[6, 4]") != std::string::npos);
  for (const char* name : {"ccbs_map", "ccbs_task", "ccbs_config"})
    RC_ASSERT(text_of(folder.path() / name).find("<root>") != std::string::npos);
}

// --- what is believed ---------------------------------------------------------------

/// What a program does, and what is to be made of it.
enum class Deed {
  kHonest,         ///< a right plan
  kLiar,           ///< a plan with a collision or of another instance, which says that it is valid
  kNonsense,       ///< a file that is no solution
  kCutShort,       ///< a file that breaks off
  kEmpty,          ///< an empty file
  kGivesUp,        ///< "solved=0"
  kSaysFailed,     ///< a document that says so
  kSaysLimit,      ///< a document that says that its limit came first
  kNothing,        ///< no file at all
  kNothingButLog,  ///< words, and no file
  kTwoFiles,       ///< of its own names
  kOwnName,        ///< one file of its own name
  kPrintsNoPlan,   ///< says that there is none, and leaves a file all the same
  kKilled,         ///< a right plan, and then ends by a signal
  kExitCode,       ///< a right plan, and an exit code that says otherwise
};
constexpr int kDeeds = 15;

struct Believed {
  db::ResultStatus status;
  std::optional<bool> valid;
  std::string limit;
};

/// Of each deed, whatever was done before it.
Believed believed_of(Deed deed) {
  switch (deed) {
    case Deed::kHonest:
    case Deed::kOwnName:
    case Deed::kExitCode:
      return {db::ResultStatus::kSolved, true, ""};
    case Deed::kLiar:
    case Deed::kNonsense:
    case Deed::kCutShort:
      return {db::ResultStatus::kInvalid, false, ""};
    case Deed::kSaysLimit:
      return {db::ResultStatus::kLimit, std::nullopt, "time"};
    default:
      return {db::ResultStatus::kFailed, std::nullopt, ""};
  }
}

SolutionDocument document_of(const SolveResult& solved) {
  SolutionDocument document;
  document.valid = true;
  document.solution = solved.solution();
  document.order = solved.order();
  document.tries = 3;
  document.expansions = 40;
  document.generations = 500;
  document.makespan_s = 1;  // lies that nobody reads
  document.flowtime_s = 1;
  return document;
}

/// A plan in which a robot jumps to its goal at once.
SolutionDocument lie_of(SolutionDocument document) {
  for (std::size_t i = 0; i < document.solution.trajectories.size(); ++i) {
    for (TimedMotion& motion : document.solution.trajectories[i].motions) {
      motion.begin_s /= 4;
      motion.end_s /= 4;
    }
  }
  return document;
}

void only_what_is_checked_is_believed() {
  const ScratchFolder folder;
  const Instance instance = any_instance();
  const SolveResult solved = solve(instance, {});
  if (!solved.is_solved()) RC_DISCARD("no plan");
  const std::string_view format = any_flag() ? "json" : "xml";
  const SolutionDocument right = document_of(solved);
  const SolutionDocument lie = lie_of(right);
  const bool is_lie = !validate(instance, lie.solution, {0, {}, {}}).valid();
  SolutionDocument failed;
  failed.status = "failed";
  SolutionDocument limit;
  limit.status = "limit";
  const std::string text = *write_solution(format, instance, right);
  write(folder.path() / "right", text);
  write(folder.path() / "lie", *write_solution(format, instance, lie));
  write(folder.path() / "cut", text.substr(0, text.size() / 2));
  write(folder.path() / "failed", *write_solution("json", instance, failed));
  write(folder.path() / "limit", *write_solution("json", instance, limit));
  const std::string here = folder.path().string();
  const std::map<Deed, std::string> lines = {
      {Deed::kHonest, "cp " + here + "/right {out}"},
      {Deed::kLiar, "cp " + here + "/lie {out}"},
      {Deed::kNonsense, "echo 'hello, this is no plan' >{out}"},
      {Deed::kCutShort, "cp " + here + "/cut {out}"},
      {Deed::kEmpty, "echo >{out}"},
      {Deed::kGivesUp, "printf 'agents=1\\nsolved=0\\n' >{out}"},
      {Deed::kSaysFailed, "cp " + here + "/failed {out}"},
      {Deed::kSaysLimit, "cp " + here + "/limit {out}"},
      {Deed::kNothing, "true"},
      {Deed::kNothingButLog, "echo 'I did it'; echo '{\"a\": 1}' >{stats}"},
      {Deed::kTwoFiles, "cp " + here + "/right a.out; cp " + here + "/right b.out"},
      {Deed::kOwnName, "cp " + here + "/right my-plan"},
      {Deed::kPrintsNoPlan, "echo 'found: false'; cp " + here + "/right {out}"},
      {Deed::kKilled, "cp " + here + "/right {out}; kill -9 $$"},
      {Deed::kExitCode, "cp " + here + "/right {out}; exit 3"}};
  // One program that does what a file tells it, again and again.
  std::string command = ": {instance}; case $(cat " + here + "/deed) in";
  for (const auto& [deed, line] : lines)
    command += " " + std::to_string(static_cast<int>(deed)) + ") " + line + ";;";
  const CommandPlanner planner = planner_of(command + " esac", "found: false");
  for (auto left = any_whole(1, 5); left > 0; --left) {
    const auto deed = static_cast<Deed>(any_whole(0, kDeeds - 1));
    if (deed == Deed::kLiar && !is_lie) continue;
    write(folder.path() / "deed", std::to_string(static_cast<int>(deed)));
    const db::ResultRow row = run(planner, instance);
    const Believed believed = believed_of(deed);
    RC_LOG() << lines.at(deed) << ": " << db::name(row.status) << ", " << row.message << '\n';
    RC_ASSERT(row.status == believed.status);
    RC_ASSERT(row.valid == believed.valid);
    RC_ASSERT(row.limit == believed.limit);
    RC_ASSERT(row.planning_time_ns > 0);
    RC_ASSERT(row.made_by.empty());
    const bool has_plan = believed.status == db::ResultStatus::kSolved || deed == Deed::kLiar;
    RC_ASSERT(row.plan_hash.has_value() == has_plan);
    RC_ASSERT(row.makespan_s.has_value() == has_plan);
    if (believed.status == db::ResultStatus::kSolved) {
      // Of the plan, not of what the file says of it.
      RC_ASSERT(*row.makespan_s == makespan_s(right.solution));
      RC_ASSERT(*row.flowtime_s == flowtime_s(right.solution));
      RC_ASSERT(row.violations == 0);
      RC_ASSERT(row.tries == 3U);
      RC_ASSERT(row.expansions == 40U);
      if (format == "json") RC_ASSERT(row.generations == 500U);
      RC_ASSERT(row.message.empty());
    } else if (deed == Deed::kLiar) {
      RC_ASSERT(row.violations > 0);
      RC_ASSERT(!row.message.empty());
    } else if (deed != Deed::kSaysFailed && deed != Deed::kSaysLimit) {
      RC_ASSERT(!row.message.empty());
    }
    if (format == "json") RC_ASSERT(row.reported.empty());
  }
}

/// Numbers that a program says of its run: of this run alone, under its own names.
void reports_are_kept_apart() {
  const ScratchFolder folder;
  const Instance instance = any_instance();
  const SolveResult solved = solve(instance, {});
  if (!solved.is_solved()) RC_DISCARD("no plan");
  write(folder.path() / "right", *write_solution("json", instance, document_of(solved)));
  const std::string here = folder.path().string();
  const CommandPlanner planner = planner_of(": {instance}; cp " + here + "/right {out}; [ -s " + here +
                                            "/table ] && cp " + here + "/table {stats}.csv; true");
  for (auto left = any_whole(1, 3); left > 0; --left) {
    std::map<std::string, double> expected;
    std::string names;
    std::string values;
    std::string older;
    for (auto columns = any_whole(0, 3); columns > 0; --columns) {
      const std::string name = "number " + std::to_string(columns);
      const double value = static_cast<double>(any_whole(-40, 40)) / 8;
      names += (names.empty() ? "" : ",") + name;
      values += (values.empty() ? "" : ",") + std::to_string(value);
      older += older.empty() ? "99" : ",99";
      expected[name] = value;
    }
    write(folder.path() / "table",
          names.empty() ? "" : names + "\n" + (any_flag() ? older + "\n" : "") + values + "\n");
    const db::ResultRow row = run(planner, instance);
    RC_ASSERT(row.status == db::ResultStatus::kSolved);
    RC_ASSERT((std::map<std::string, double>(row.reported.begin(), row.reported.end())) == expected);
  }
}

/// A plan with needless waits, re-timed: judged with the earliest times, and what was given is told beside
/// it.
void retimed_plans_are_told_as_given() {
  const ScratchFolder folder;
  const Instance instance = any_instance();
  PlannerOptions options;
  options.any_angle = false;
  const SolveResult solved = solve(instance, options);
  if (!solved.is_solved()) RC_DISCARD("no plan");
  SolutionDocument given = document_of(solved);
  const double late_s = static_cast<double>(any_whole(0, 8)) / 4;
  const bool moves = makespan_s(given.solution) > 0;
  for (std::size_t i = 0; i < given.solution.trajectories.size(); ++i) {
    std::vector<TimedMotion>& motions = given.solution.trajectories[i].motions;
    if (motions.empty()) continue;
    for (TimedMotion& motion : motions) {
      motion.begin_s += late_s;
      motion.end_s += late_s;
    }
    TimedMotion wait = motions.front();
    wait.to = wait.from;
    wait.begin_s = 0;
    wait.end_s = late_s;
    wait.turn_to_deg.reset();
    if (late_s > 0) motions.insert(motions.begin(), wait);
  }
  write(folder.path() / "given", *write_solution("json", instance, given));
  const CommandPlanner planner =
      planner_of(": {instance}; cp " + folder.path().string() + "/given {out}", "", true);
  const db::ResultRow row = run(planner, instance);
  RC_ASSERT(row.retiming.has_value());
  RC_ASSERT(row.retiming->executable);
  const auto as_given = validate(instance, given.solution, {0, {}, {}});
  RC_ASSERT(row.retiming->given_valid == as_given.valid());
  RC_ASSERT(row.retiming->given_violations == static_cast<std::int64_t>(as_given.violations.size()));
  RC_ASSERT(std::abs(row.retiming->given_makespan_s - makespan_s(given.solution)) < 1e-9);
  RC_ASSERT(std::abs(row.retiming->given_flowtime_s - flowtime_s(given.solution)) < 1e-9);
  RC_ASSERT(row.status == db::ResultStatus::kSolved);
  RC_ASSERT(*row.flowtime_s <= row.retiming->given_flowtime_s + 1e-9);
  if (moves && late_s > 0) RC_ASSERT(*row.makespan_s <= row.retiming->given_makespan_s - late_s + 1e-9);
}

/// Ended for its time or its memory, a program has reached that limit, whatever it had left before.
void limits_end_programs() {
  const ScratchFolder folder;
  const Instance instance = any_instance();
  const SolveResult solved = solve(instance, {});
  if (!solved.is_solved()) RC_DISCARD("no plan");
  write(folder.path() / "right", *write_solution("json", instance, document_of(solved)));
  const CommandPlanner planner =
      planner_of(": {instance}; cp " + folder.path().string() + "/right {out}; exec sleep 30");
  PlannerOptions options;
  options.time_limit_s = 0.125;
  const db::ResultRow row = run(planner, instance, options);
  RC_ASSERT(row.status == db::ResultStatus::kLimit);
  RC_ASSERT(row.limit == "time");
  RC_ASSERT(!row.valid.has_value());
  RC_ASSERT(!row.makespan_s.has_value());
  RC_ASSERT(row.message == "killed after 1.125 s");
  RC_ASSERT(row.planning_time_ns >= 1'125'000'000);
}

const PropertyRoom room("outside_planners", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("a placeholder stands for the value that it is called after, in its unit",
                     placeholders_stand_for_what_they_say, kShells);
  passed &= property("of what a program leaves only what is checked is believed, whatever it left before",
                     only_what_is_checked_is_believed, 2 * kShells);
  passed &= property("what a program says of its run is kept apart", reports_are_kept_apart, kShells);
  passed &=
      property("a plan that is re-timed is told as it was given", retimed_plans_are_told_as_given, kShells);
  passed &= property("a program that is ended has reached its limit", limits_end_programs, 1);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::outside_planners_laws
