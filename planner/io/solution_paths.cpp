// A line of cells for each robot, `Agent 0: (row,column)->(row,column)->`: what CBSH2-RTC, EECBS, PBS and
// MAPF-LNS write, rows first; or columns first.
#include "planner/io/solution_parts.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

constexpr const char* kPathWords = "a line such as 'Agent 0: (3,4)->(3,5)->'";

struct RobotPath {
  std::size_t robot = 0;
  std::string_view cells;
  int line = 0;
};

/// "Agent 7:" cut off the line; nothing where it does not begin so.
std::optional<std::size_t> cut_robot(std::string_view& line) {
  constexpr std::string_view kWord = "Agent ";
  const std::size_t colon = line.find(':');
  if (line.substr(0, kWord.size()) != kWord || colon == std::string_view::npos) return std::nullopt;
  const auto robot = parse_integer(line.substr(kWord.size(), colon - kWord.size()));
  if (!robot || *robot < 0) return std::nullopt;
  line = trimmed(line.substr(colon + 1));
  return static_cast<std::size_t>(*robot);
}

enum class CellOrder { kGuess, kRowsFirst, kColumnsFirst };

Cell swapped(Cell cell) { return {cell.y, cell.x}; }

/// The first cell of a path.
std::optional<Cell> first_cell(std::string_view cells) { return cut_pair(cells); }

/// The last one.
std::optional<Cell> last_cell(std::string_view cells) {
  const std::size_t open = cells.rfind('(');
  if (open == std::string_view::npos) return std::nullopt;
  cells.remove_prefix(open);
  return cut_pair(cells);
}

/// Whether the paths, read this way, begin where robots start, and end where they are to go.
int agreement(const std::vector<RobotPath>& paths, const Instance& instance, bool rows_first) {
  bool starts = true;
  bool goals = true;
  for (const RobotPath& path : paths) {
    const auto first = first_cell(path.cells);
    const auto last = last_cell(path.cells);
    if (path.robot >= instance.agents.size() || !first || !last) continue;
    const Agent& agent = instance.agents[path.robot];
    starts = starts && (rows_first ? swapped(*first) : *first) == agent.start;
    goals = goals && (rows_first ? swapped(*last) : *last) == agent.goal;
  }
  return (starts ? 2 : 0) + (starts && goals ? 1 : 0);
}

bool is_path_solution(std::string_view head) {
  std::string_view line = trimmed(head.substr(0, head.find('\n')));
  return cut_robot(line) && (line.empty() || cut_pair(line));
}

Input<SolutionDocument> parse_solution_paths(std::string_view text, const std::string& file_name,
                                             const Instance& instance, CellOrder order) {
  LineScanner lines(text);
  const auto error = [&](int line, std::string what, std::string expected) {
    return Unexpected{InputError{file_name, line, std::move(what), std::move(expected)}};
  };
  std::vector<RobotPath> paths;
  while (const auto line = lines.next()) {
    std::string_view rest = trimmed(*line);
    if (rest.empty()) continue;
    const auto robot = cut_robot(rest);
    if (!robot) return error(lines.line(), in_quotes(*line), kPathWords);
    paths.push_back({*robot, rest, lines.line()});
  }
  const int by_rows = agreement(paths, instance, true);
  const int by_columns = agreement(paths, instance, false);
  const bool rows_first =
      order == CellOrder::kRowsFirst || (order == CellOrder::kGuess && by_rows >= by_columns);
  const bool other_fits = rows_first ? by_rows < 2 && by_columns >= 2 : by_columns < 2 && by_rows >= 2;
  if (other_fits) {
    return error(paths.front().line,
                 std::string("cells with the ") + (rows_first ? "column" : "row") + " first",
                 std::string("the ") + (rows_first ? "row" : "column") + " first in this format");
  }
  StepPlan plan(instance);
  for (const RobotPath& path : paths) {
    std::string_view rest = path.cells;
    if (rest.empty()) return error(path.line, "no cells of robot " + std::to_string(path.robot), kPathWords);
    if (plan.next_step(path.robot) > 0) {
      return error(path.line, "a second line of robot " + std::to_string(path.robot), "one for each robot");
    }
    while (!rest.empty()) {
      const auto cell = cut_pair(rest);
      if (!cell) return error(path.line, in_quotes(rest), kPathWords);
      const std::string problem = plan.add(path.robot, rows_first ? swapped(*cell) : *cell);
      if (!problem.empty()) return error(path.line, problem, "a plan for this instance");
      rest = trimmed(rest);
      if (rest.substr(0, 2) == "->") rest = trimmed(rest.substr(2));
    }
  }
  if (const std::string missing = plan.missing(); !missing.empty()) {
    return error(lines.line(), missing, "one line for each robot of the instance");
  }
  SolutionDocument document;
  document.solution = plan.take();
  return document;
}

template <CellOrder order>
Input<SolutionDocument> parse_paths(std::string_view text, const std::string& file,
                                    const Instance& instance) {
  return parse_solution_paths(text, file, instance, order);
}

}  // namespace

SolutionFormat path_format() {
  return {"paths", "Agent 0: (3,4)->(3,5)->, rows or columns first, as they fit", is_path_solution,
          parse_paths<CellOrder::kGuess>};
}
SolutionFormat eecbs_format() {
  return {"eecbs", "paths, rows first: EECBS, CBSH2-RTC, PBS", nullptr, parse_paths<CellOrder::kRowsFirst>};
}
SolutionFormat xy_path_format() {
  return {"paths-xy", "paths, columns first", nullptr, parse_paths<CellOrder::kColumnsFirst>};
}

}  // namespace sipplab
