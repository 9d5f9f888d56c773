#include "planner/io/tracker.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "planner/grid/free_grid.hpp"
#include "planner/io/csv_text.hpp"
#include "planner/io/solution_parts.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"
#include "planner/retime/steps.hpp"

namespace sipplab {
namespace {

constexpr std::string_view kTrackerHeader =
    "map_name,scen_type,type_id,agents,lower_cost,solution_cost,solution_plan";
/// A table with more columns is something else.
constexpr std::size_t kMostColumns = 32;

struct TrackerTable {
  std::vector<std::string> columns;
  std::string_view rest;
  int line = 1;

  /// Position of a column; the number of columns if there is none.
  std::size_t column(std::string_view name) const {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin());
  }
  std::string_view field(const CsvRecord& record, std::string_view name) const {
    const std::size_t at = column(name);
    return at < record.fields.size() ? std::string_view(record.fields[at]) : std::string_view();
  }
};

TrackerTable table_of(std::string_view text) {
  TrackerTable table;
  table.rest = without_byte_order_mark(text);
  table.columns = next_csv_record(table.rest, table.line, kMostColumns).fields;
  for (std::string& column : table.columns) column = std::string(trimmed(column));
  return table;
}

/// Strings of moves, one a line; with `up` as the change of row of a `u`. Empty, or what is wrong and in
/// which line.
std::pair<std::string, int> read_moves(std::string_view text, const Instance& instance, std::int32_t up,
                                       StepPlan& plan) {
  std::size_t robot = 0;
  LineScanner lines(text);
  // Lines are separated, not ended: a last one of a robot that never moves is empty.
  bool has_last = text.empty() || text.back() == '\n';
  const auto next_line = [&]() -> std::optional<std::string_view> {
    if (const auto line = lines.next()) return line;
    return std::exchange(has_last, false) ? std::optional<std::string_view>("") : std::nullopt;
  };
  for (; robot < plan.robots(); ++robot) {
    const auto text_of_robot = next_line();
    if (!text_of_robot) return {"moves of " + std::to_string(robot) + " robots", std::max(1, lines.line())};
    std::string_view moves = trimmed(*text_of_robot);
    const int line = static_cast<int>(robot) + 1;
    std::string problem = plan.add(robot, instance.agents[robot].start, 0);
    while (problem.empty() && !moves.empty()) {
      const std::size_t digits = std::min(moves.find_first_not_of("0123456789"), moves.size());
      const auto run = digits == 0 ? std::optional<std::int64_t>(1) : parse_integer(moves.substr(0, digits));
      const char letter = digits < moves.size() ? static_cast<char>(moves[digits] | 0x20) : '\0';
      if (!run || *run < 1 || *run > std::numeric_limits<std::int32_t>::max() ||
          std::string_view("udlrw").find(letter) == std::string_view::npos) {
        return {in_quotes(moves), line};
      }
      moves.remove_prefix(digits + 1);
      const Cell by{letter == 'r' ? 1 : letter == 'l' ? -1 : 0, letter == 'u' ? up : letter == 'd' ? -up : 0};
      if (letter == 'w') {
        problem = plan.add(robot, plan.at(robot), plan.next_step(robot) + *run - 1);
        continue;
      }
      for (std::int64_t i = 0; problem.empty() && i < *run; ++i) {
        const Cell here = plan.at(robot);
        const Cell there{here.x + by.x, here.y + by.y};
        problem = instance.map.contains(there) ? plan.add(robot, there)
                                               : "robot " + std::to_string(robot) + " leaves the map";
      }
    }
    if (!problem.empty()) return {problem, line};
  }
  while (const auto line = lines.next()) {
    if (!trimmed(*line).empty())
      return {"moves of more than " + std::to_string(robot) + " robots", lines.line()};
  }
  return {};
}

/// The plan with `u` as it ends at the goals, else as the format has it.
Input<SolutionDocument> plan_of_moves(std::string_view text, const std::string& file_name, int first_line,
                                      const Instance& instance, std::optional<std::int32_t> up) {
  const auto ends_at_goals = [&](const Solution& solution) {
    for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
      if (solution.trajectories[i].end() != instance.agents[i].goal) return false;
    }
    return true;
  };
  std::optional<InputError> error;
  std::optional<Solution> first;
  for (const std::int32_t rows : {up.value_or(1), up.value_or(-1)}) {
    StepPlan plan(instance);
    const auto [problem, line] = read_moves(text, instance, rows, plan);
    if (!problem.empty()) {
      if (!error) {
        error = InputError{file_name, first_line + line - 1, problem,
                           "a line of moves such as 3ru2l for each robot of the instance"};
      }
      continue;
    }
    Solution solution = plan.take();
    const bool fits = ends_at_goals(solution);
    if (fits || !first) first = std::move(solution);
    if (fits) break;
  }
  if (!first) return Unexpected{*error};
  SolutionDocument document;
  document.solution = std::move(*first);
  return document;
}

/// Moves between free neighbours that the robots need one by one; those that cannot reach their goals aside.
std::int64_t steps_alone(const Instance& instance) {
  const FreeGrid grid(instance.map);
  std::int64_t sum = 0;
  std::vector<std::int32_t> distance;
  std::vector<CellId> queue;
  for (const Agent& agent : instance.agents) {
    distance.assign(grid.size(), -1);
    const CellId goal = grid.id(agent.goal);
    queue.assign(1, grid.id(agent.start));
    distance[queue.front()] = 0;
    for (std::size_t at = 0; at < queue.size() && distance[goal] < 0; ++at) {
      for (const CellId next : grid.neighbours(queue[at])) {
        if (distance[next] >= 0) continue;
        distance[next] = distance[queue[at]] + 1;
        queue.push_back(next);
      }
    }
    sum += std::max(0, distance[goal]);
  }
  return sum;
}

void append_run(std::string& out, char letter, std::size_t run) {
  if (run > 1) out += std::to_string(run);
  if (run > 0) out += letter;
}

char letter_of(Cell from, Cell to) {
  if (to.x > from.x) return 'r';
  if (to.x < from.x) return 'l';
  if (to.y > from.y) return 'u';
  return to.y < from.y ? 'd' : 'w';
}

}  // namespace

TrackerRow tracker_scenario(const std::string& file_name) {
  std::string name = file_name.substr(file_name.find_last_of('/') + 1);
  name = name.substr(0, name.rfind('.'));
  TrackerRow row;
  const std::size_t number = name.rfind('-');
  const std::size_t type = number == std::string::npos || number == 0 ? number : name.rfind('-', number - 1);
  if (type == std::string::npos || type == 0 || number == std::string::npos) {
    row.map_name = name;
    return row;
  }
  const auto id = parse_integer(std::string_view(name).substr(number + 1));
  row.map_name = id ? name.substr(0, type) : name;
  if (!id) return row;
  row.scen_type = name.substr(type + 1, number - type - 1);
  row.type_id = *id;
  return row;
}

std::string tracker_lines(const std::vector<std::vector<Cell>>& steps) {
  std::string out;
  for (const std::vector<Cell>& cells : steps) {
    char last = '\0';
    std::size_t run = 0;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const char letter = letter_of(cells[i - 1], cells[i]);
      if (letter != last) {
        append_run(out, last, run);
        run = 0;
      }
      last = letter;
      ++run;
    }
    append_run(out, last, run);
    out += '\n';
  }
  return out;
}

std::string tracker_csv(const Instance& instance, TrackerRow row,
                        const std::vector<std::vector<Cell>>& steps) {
  row.agents = static_cast<std::int64_t>(steps.size());
  row.solution_cost = 0;
  for (const std::vector<Cell>& cells : steps) {
    row.solution_cost += cells.empty() ? 0 : static_cast<std::int64_t>(cells.size()) - 1;
  }
  row.lower_cost = steps_alone(instance);
  std::string out(kTrackerHeader);
  out += '\n';
  append_csv_field(out, row.map_name);
  out += ',';
  append_csv_field(out, row.scen_type);
  for (const std::int64_t number : {row.type_id, row.agents, row.lower_cost, row.solution_cost}) {
    out += ',' + std::to_string(number);
  }
  out += ',';
  std::string lines = tracker_lines(steps);
  if (!lines.empty()) lines.pop_back();
  append_csv_field(out, lines);
  return out + '\n';
}

Input<std::vector<TrackerRow>> parse_tracker_rows(std::string_view text, const std::string& file_name) {
  const auto error = [&](int line, std::string what, std::string expected) {
    return Unexpected{InputError{file_name, line, std::move(what), std::move(expected)}};
  };
  TrackerTable table = table_of(text);
  constexpr std::array<std::string_view, 5> kNeeded = {"map_name", "scen_type", "type_id", "agents",
                                                       "solution_cost"};
  for (const std::string_view name : kNeeded) {
    if (table.column(name) == table.columns.size()) {
      return error(1, "no column " + std::string(name), "a header such as " + std::string(kTrackerHeader));
    }
  }
  std::vector<TrackerRow> rows;
  while (!table.rest.empty()) {
    const CsvRecord record = next_csv_record(table.rest, table.line, kMostColumns);
    if (record.fields.size() == 1 && trimmed(record.fields[0]).empty()) continue;
    if (!record.complete) return error(record.line, "a quote that stays open", "its end");
    TrackerRow row;
    row.map_name = std::string(trimmed(table.field(record, "map_name")));
    row.scen_type = std::string(trimmed(table.field(record, "scen_type")));
    const auto number = [&](std::string_view name, std::int64_t& value) {
      const auto read = parse_integer(table.field(record, name));
      if (read) value = *read;
      return read && *read >= 0;
    };
    if (row.map_name.empty() || row.scen_type.empty()) return error(record.line, "no map or type", "both");
    const bool has_bound = !trimmed(table.field(record, "lower_cost")).empty();
    for (const auto& [name, value] : {std::pair<std::string_view, std::int64_t*>{"type_id", &row.type_id},
                                      {"agents", &row.agents},
                                      {"solution_cost", &row.solution_cost},
                                      {"lower_cost", &row.lower_cost}}) {
      if (name == "lower_cost" && !has_bound) continue;
      if (!number(name, *value)) {
        return error(record.line, std::string(name) + " " + in_quotes(table.field(record, name)),
                     "a whole number from 0");
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

bool is_tracker_table(std::string_view head) {
  const std::string_view line = without_byte_order_mark(head).substr(0, head.find('\n'));
  return line.find("map_name") != std::string_view::npos &&
         line.find("solution_plan") != std::string_view::npos;
}

/// The first row that takes every robot of the instance to its goal, else the last of as many robots.
Input<SolutionDocument> parse_tracker_table(std::string_view text, const std::string& file_name,
                                            const Instance& instance) {
  TrackerTable table = table_of(text);
  const auto robots = static_cast<std::int64_t>(instance.agents.size());
  std::optional<Input<SolutionDocument>> last;
  while (!table.rest.empty()) {
    const CsvRecord record = next_csv_record(table.rest, table.line, kMostColumns);
    if (record.fields.size() == 1 && trimmed(record.fields[0]).empty()) continue;
    const auto agents = parse_integer(table.field(record, "agents"));
    const auto count = agents ? agents : parse_integer(table.field(record, "agent_count"));
    if (count != robots) continue;
    const std::string_view flip = trimmed(table.field(record, "flip_up_down"));
    std::optional<std::int32_t> up;
    if (!flip.empty()) up = (flip[0] | 0x20) == 't' || flip[0] == '1' ? -1 : 1;
    last = plan_of_moves(table.field(record, "solution_plan"), file_name, record.line, instance, up);
    if (!*last) continue;
    for (const std::string_view name : {"lower_cost", "solution_cost"}) {
      add_report(**last, name, table.field(record, name));
    }
    bool fits = true;
    for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
      fits = fits && (*last)->solution.trajectories[i].end() == instance.agents[i].goal;
    }
    if (fits) return std::move(*last);
  }
  if (last) return std::move(*last);
  return Unexpected{InputError{file_name, 1, "no row of " + std::to_string(robots) + " agents",
                               "one with a plan of the instance"}};
}

bool is_tracker_solution(std::string_view head) {
  if (is_tracker_table(head)) return true;
  const std::string_view line = trimmed(head.substr(0, head.find('\n')));
  return !line.empty() && line.find_first_not_of("0123456789udlrwUDLRW") == std::string_view::npos &&
         line.find_first_not_of("0123456789") != std::string_view::npos;
}

Input<SolutionDocument> parse_solution_tracker(std::string_view text, const std::string& file_name,
                                               const Instance& instance) {
  if (is_tracker_table(text)) return parse_tracker_table(text, file_name, instance);
  return plan_of_moves(text, file_name, 1, instance, std::nullopt);
}

/// A table: its header, and a row for a solution.
Expected<std::string, std::string> solution_to_tracker(const Instance& instance,
                                                       const SolutionDocument& document) {
  if (document.status != "solved") return std::string(kTrackerHeader) + '\n';
  const auto steps = discrete_steps(instance, document.solution);
  if (!steps) {
    return Unexpected{
        std::string("the plan has other moves than along rows and columns, expected --method complete")};
  }
  return tracker_csv(instance, tracker_scenario(document.robots_file), *steps);
}

}  // namespace

SolutionFormat tracker_format() {
  return {"tracker", "MAPF-tracker's moves, a line for each robot: 3ru2l, or its table", is_tracker_solution,
          parse_solution_tracker, solution_to_tracker};
}

}  // namespace sipplab
