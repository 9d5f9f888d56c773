// YAML of libMultiRobotPlanning: `statistics:`, and `schedule:` with a list of x, y and t for each agent.
// Read event by event, so that a document takes no more memory than its plan.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <limits>
#include <sstream>

#include "planner/io/solution_parts.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

/// What is wrong with the content of a document, and where; thrown from the events of the parser to below.
struct YamlComplaint {
  int line = 0;
  std::string what;
};

class ScheduleEvents : public YAML::EventHandler {
 public:
  ScheduleEvents(const Instance& instance, SolutionDocument& document)
      : plan_(instance), document_(document) {}

  bool has_schedule() const { return has_schedule_; }
  StepPlan& plan() { return plan_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { take(mark, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { complain(mark, "an alias"); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    take(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, false);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, true);
  }
  void OnMapEnd() override {
    if (is_waypoint()) add_waypoint();
    close();
  }

 private:
  struct Level {
    bool is_map = false;
    bool has_key = false;
    std::string key;
  };

  [[noreturn]] static void complain(const YAML::Mark& mark, std::string what) {
    throw YamlComplaint{mark.line + 1, std::move(what)};
  }

  void open(const YAML::Mark& mark, bool is_map) {
    if (!levels_.empty() && levels_.back().is_map && !levels_.back().has_key) {
      complain(mark, "a key that is no text");
    }
    levels_.push_back({is_map, false, {}});
    if (is_waypoint()) {
      x_ = y_ = t_ = std::nullopt;
      mark_ = mark;
    }
  }

  void close() {
    levels_.pop_back();
    if (!levels_.empty()) levels_.back().has_key = false;
  }

  void take(const YAML::Mark& mark, const std::string& value) {
    if (levels_.empty()) return;
    Level& level = levels_.back();
    if (level.is_map && !level.has_key) {
      level.has_key = true;
      level.key = value;
      has_schedule_ = has_schedule_ || (levels_.size() == 1 && value == "schedule");
      return;
    }
    level.has_key = false;
    if (levels_.size() == 2 && levels_[0].key == "statistics") add_report(document_, level.key, value);
    if (!is_waypoint()) return;
    std::optional<std::int64_t>* const number = level.key == "x"   ? &x_
                                                : level.key == "y" ? &y_
                                                : level.key == "t" ? &t_
                                                                   : nullptr;
    if (number == nullptr) return;
    *number = parse_integer(value);
    if (!*number) complain(mark, level.key + ": " + in_quotes(value));
  }

  /// schedule, an agent, its list, the map in it.
  bool is_waypoint() const {
    return levels_.size() == 4 && levels_[0].key == "schedule" && levels_[1].is_map && !levels_[2].is_map &&
           levels_[3].is_map;
  }

  void add_waypoint() {
    constexpr std::string_view kAgent = "agent";
    const std::string& name = levels_[1].key;
    std::int64_t robot = -1;
    if (name.substr(0, kAgent.size()) == kAgent) {
      robot = parse_integer(std::string_view(name).substr(kAgent.size())).value_or(-1);
    }
    if (robot < 0) complain(mark_, in_quotes(name) + ", expected agent0 and so on");
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (!x_ || !y_ || !t_ || std::abs(*x_) > kMost || std::abs(*y_) > kMost) {
      complain(mark_, "a place of " + in_quotes(name) + " without x, y and t");
    }
    const Cell cell{static_cast<std::int32_t>(*x_), static_cast<std::int32_t>(*y_)};
    const std::string problem = plan_.add(static_cast<std::size_t>(robot), cell, *t_);
    if (!problem.empty()) complain(mark_, problem);
  }

  StepPlan plan_;
  SolutionDocument& document_;
  std::vector<Level> levels_;
  bool has_schedule_ = false;
  std::optional<std::int64_t> x_, y_, t_;
  YAML::Mark mark_;
};

bool is_yaml_solution(std::string_view head) {
  LineScanner lines(head);
  while (const auto line = lines.next()) {
    if (line->substr(0, 9) == "schedule:" || line->substr(0, 11) == "statistics:") return true;
  }
  return false;
}

Input<SolutionDocument> parse_solution_yaml(std::string_view text, const std::string& file_name,
                                            const Instance& instance) {
  const auto error = [&](int line, std::string what, std::string expected) {
    return Unexpected{InputError{file_name, line, std::move(what), std::move(expected)}};
  };
  SolutionDocument document;
  ScheduleEvents events(instance, document);
  const int last_line = LineTable(text).line(text.size());
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    parser.HandleNextDocument(events);
  } catch (const YamlComplaint& complaint) {
    return error(std::min(complaint.line, last_line), complaint.what, "a plan for this instance");
  } catch (const YAML::Exception& failure) {
    return error(std::min(failure.mark.line + 1, last_line), "not well-formed YAML", "a complete document");
  }
  const std::string missing =
      events.has_schedule() || instance.agents.empty() ? events.plan().missing() : "no 'schedule:'";
  if (!missing.empty())
    return error(last_line, missing, "a list of x, y and t for each robot of the instance");
  document.solution = events.plan().take();
  return document;
}

}  // namespace

SolutionFormat yaml_format() {
  return {"yaml", "schedule of libMultiRobotPlanning", is_yaml_solution, parse_solution_yaml};
}

}  // namespace sipplab
