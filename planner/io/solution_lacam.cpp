// Result texts of LaCAM, its successors and PIBT: `key=value`, then `solution=` and a line for each step with
// the cells of all robots, `0:(x,y),(x,y),`.
#include "planner/io/solution_parts.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

bool is_lacam_solution(std::string_view head) {
  LineScanner lines(head);
  while (const auto line = lines.next()) {
    const std::string_view key = line->substr(0, line->find('='));
    if (key == "solved" || key == "solution") return key.size() < line->size();
  }
  return false;
}

Input<SolutionDocument> parse_solution_lacam(std::string_view text, const std::string& file_name,
                                             const Instance& instance) {
  SolutionDocument document;
  StepPlan plan(instance);
  LineScanner lines(text);
  const auto error = [&](std::string what, std::string expected) {
    return Unexpected{InputError{file_name, lines.line(), std::move(what), std::move(expected)}};
  };
  bool has_solution = false;
  std::int64_t step = 0;
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    if (!has_solution) {
      const std::size_t equals = line->find('=');
      if (equals == std::string_view::npos) continue;
      const std::string_view key = trimmed(line->substr(0, equals));
      const std::string_view value = trimmed(line->substr(equals + 1));
      if (key == "solution") {
        has_solution = true;
      } else if (key == "solved" && value == "0") {
        document.status = "failed";
      } else if (key == "agents") {
        const auto robots = parse_integer(value);
        if (robots != static_cast<std::int64_t>(instance.agents.size())) {
          return error("agents=" + std::string(value.substr(0, 20)),
                       "the " + std::to_string(instance.agents.size()) + " robots of the instance");
        }
      } else if (key != "solved" && key != "seed") {
        add_report(document, key, value);
      }
      continue;
    }
    std::string_view rest = *line;
    const std::size_t colon = rest.find(':');
    if (colon == std::string_view::npos || parse_integer(rest.substr(0, colon)) != step) {
      return error(in_quotes(rest), "step " + std::to_string(step) + ", a colon and the cells of all robots");
    }
    rest.remove_prefix(colon + 1);
    std::size_t robot = 0;
    for (rest = trimmed(rest); !rest.empty(); ++robot) {
      const auto cell = cut_pair(rest);
      if (!cell) return error(in_quotes(rest), "a cell such as (3,4)");
      const std::string problem = plan.add(robot, *cell, step);
      if (!problem.empty()) return error(problem, "a plan for this instance");
      if (rest.substr(0, 1) == ",") rest.remove_prefix(1);
    }
    if (robot != plan.robots()) {
      return error("step " + std::to_string(step) + " of " + std::to_string(robot) + " robots",
                   "the " + std::to_string(plan.robots()) + " of the instance");
    }
    ++step;
  }
  if (document.status != "solved") return document;
  if (const std::string missing = plan.missing(); !missing.empty()) {
    return error(missing, "lines after 'solution=' with the cells of all robots");
  }
  document.solution = plan.take();
  return document;
}

}  // namespace

SolutionFormat lacam_format() {
  return {"lacam", "result text of LaCAM, LaCAM2, LaCAM3 and PIBT", is_lacam_solution, parse_solution_lacam};
}

}  // namespace sipplab
