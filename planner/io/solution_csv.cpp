// Solutions as CSV (RFC 4180), one line a motion: see solution_io.hpp.
#include <array>
#include <limits>

#include "planner/io/csv_text.hpp"
#include "planner/io/solution_parts.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

constexpr std::string_view kHeader = "agent,id,t0,t1,x0,y0,x1,y1";
constexpr std::size_t kColumns = 8;
/// With the heading at the end of a turn, empty for other motions.
constexpr std::string_view kHeaderWithTurns = "agent,id,t0,t1,x0,y0,x1,y1,turn_to";
constexpr std::size_t kColumnsWithTurns = 9;

/// The motion of a record, or what is wrong with it.
Expected<TimedMotion, std::string> motion_of(const std::vector<std::string>& fields) {
  const auto begin_s = parse_real(fields[2]);
  const auto end_s = parse_real(fields[3]);
  if (!begin_s || !end_s) return Unexpected{"time " + in_quotes(begin_s ? fields[3] : fields[2])};
  std::array<std::int32_t, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = parse_integer(fields[4 + i]);
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (!number || *number < -kMost || *number > kMost) {
      return Unexpected{"coordinate " + in_quotes(fields[4 + i])};
    }
    numbers[i] = static_cast<std::int32_t>(*number);
  }
  TimedMotion motion{*begin_s, *end_s, {numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
  if (fields.size() == kColumnsWithTurns && !trimmed(fields[kColumns]).empty()) {
    motion.turn_to_deg = parse_real(fields[kColumns]);
    if (!motion.turn_to_deg) return Unexpected{"turn_to " + in_quotes(fields[kColumns])};
  }
  return motion;
}

/// A wait from 0 to 0, a robot's first line, says where it begins and is no motion.
bool states_place(const TimedMotion& motion) {
  return motion.is_wait() && !motion.is_turn() && motion.begin_s == 0 && motion.end_s == 0;
}

/// Whether its motions do not say where the robot begins.
bool needs_place(const Trajectory& trajectory) {
  if (trajectory.motions.empty()) return true;
  const TimedMotion& first = trajectory.motions.front();
  return first.from != trajectory.start || states_place(first);
}

void append_line(std::string& out, std::size_t agent, std::string_view id, const TimedMotion& motion,
                 bool with_turns) {
  out += std::to_string(agent) + ",";
  append_csv_field(out, id);
  out += ',';
  append_real(out, motion.begin_s);
  out += ',';
  append_real(out, motion.end_s);
  for (const std::int32_t number : {motion.from.x, motion.from.y, motion.to.x, motion.to.y}) {
    out += ',';
    out += std::to_string(number);
  }
  if (with_turns) out += ',';
  if (with_turns && motion.turn_to_deg) append_real(out, *motion.turn_to_deg);
  out += '\n';
}

bool is_csv(std::string_view head) { return head.substr(0, 5) == "agent"; }

Input<SolutionDocument> parse_solution_csv(std::string_view text, const std::string& file_name,
                                           const Instance& instance) {
  const auto error = [&file_name](int line, std::string what, std::string expected) {
    return Unexpected{InputError{file_name, line, std::move(what), std::move(expected)}};
  };
  const std::string_view header = trimmed(text.substr(0, text.find('\n')));
  if (header != kHeader && header != kHeaderWithTurns) {
    return error(1, "header " + in_quotes(header), std::string(kHeader));
  }
  const std::size_t columns = header == kHeader ? kColumns : kColumnsWithTurns;
  SolutionDocument document;
  for (const Agent& agent : instance.agents) document.solution.trajectories.push_back({agent.start, {}});
  std::vector<bool> is_begun(instance.agents.size(), false);

  int line = 1;
  std::string_view rest = text;
  next_csv_record(rest, line, kColumnsWithTurns);
  while (!rest.empty()) {
    const CsvRecord record = next_csv_record(rest, line, kColumnsWithTurns);
    if (!record.complete) return error(record.line, "a quote that is not closed", "a closing \"");
    if (record.fields.size() == 1 && trimmed(record.fields[0]).empty()) continue;
    if (record.fields.size() != columns) {
      return error(record.line,
                   record.fields.size() > columns ? "too many fields"
                                                  : std::to_string(record.fields.size()) + " fields",
                   std::to_string(columns) + ": " + std::string(header));
    }
    const auto agent = parse_integer(record.fields[0]);
    if (!agent || *agent < 0 || static_cast<std::uint64_t>(*agent) >= instance.agents.size()) {
      return error(record.line, "agent " + in_quotes(record.fields[0]),
                   "a position below " + std::to_string(instance.agents.size()));
    }
    const auto index = static_cast<AgentIndex>(*agent);
    if (record.fields[1] != instance.agents[index].id) {
      return error(record.line, "id " + in_quotes(record.fields[1]),
                   "that of the instance, " + in_quotes(instance.agents[index].id));
    }
    const Expected<TimedMotion, std::string> motion = motion_of(record.fields);
    if (!motion) return error(record.line, motion.error(), "a number");
    if (motion->is_turn() && !motion->is_wait()) {
      return error(record.line, "turn_to in a motion that changes place", "turns in place alone");
    }
    Trajectory& trajectory = document.solution.trajectories[index];
    const bool is_first = !is_begun[index];
    is_begun[index] = true;
    if (is_first) trajectory.start = motion->from;
    if (!is_first || !states_place(*motion)) trajectory.motions.push_back(*motion);
  }
  return document;
}

}  // namespace

std::string solution_to_csv(const Instance& instance, const SolutionDocument& document) {
  const bool with_turns = has_turns(document.solution);
  std::string out(with_turns ? kHeaderWithTurns : kHeader);
  out += '\n';
  const std::vector<Trajectory>& trajectories = document.solution.trajectories;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const std::string& id = instance.agents[i].id;
    const Cell start = trajectories[i].start;
    if (needs_place(trajectories[i])) append_line(out, i, id, {0, 0, start, start}, with_turns);
    for (const TimedMotion& motion : trajectories[i].motions) append_line(out, i, id, motion, with_turns);
  }
  return out;
}

SolutionFormat csv_format() {
  return {"csv", "CSV of this program", is_csv, parse_solution_csv, always<solution_to_csv>};
}

}  // namespace sipplab
