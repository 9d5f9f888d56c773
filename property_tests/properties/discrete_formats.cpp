// Plans of other programs: one plan in steps, written here as each of them writes it, reads back as the
// motions that it stands for; what is written for them is what this file reads out of it.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "planner/complete/complete_planner.hpp"
#include "planner/io/foreign_instance.hpp"
#include "planner/io/tracker.hpp"
#include "planner/retime/steps.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/steps_between.hpp"
#include "sipplab/solution_io.hpp"

namespace sipplab::discrete_formats_laws {
namespace {

constexpr const char* kFile = "some/file";

/// Robots at cells, step by step. Readers do not judge whether they meet.
struct Steps {
  Instance instance;
  std::vector<std::vector<Cell>> cells;  ///< by robot, all of one length
  bool diagonals = false;
};

Steps make_steps(bool may_go_diagonally) {
  Steps steps;
  steps.diagonals = may_go_diagonally && *rc::gen::arbitrary<bool>();
  GridMap& map = steps.instance.map;
  map = GridMap(*rc::gen::inRange(2, 8), *rc::gen::inRange(2, 6));
  for (int walls = *rc::gen::inRange(0, 4); walls > 0; --walls) {
    map.set_blocked(*any_cell(map.width(), map.height()), true);
  }
  std::vector<Cell> free;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (!map.is_blocked(map.cell(i))) free.push_back(map.cell(i));
  }
  if (free.empty()) {
    map.set_blocked({0, 0}, false);
    free.push_back({0, 0});
  }
  const int robots = *rc::gen::inRange(1, 4);
  const int length = *rc::gen::inRange(1, 12);
  for (int robot = 0; robot < robots; ++robot) {
    std::vector<Cell> cells = {*rc::gen::elementOf(free)};
    while (static_cast<int>(cells.size()) < length) {
      const Cell here = cells.back();
      Cell by{*rc::gen::inRange(-1, 2), *rc::gen::inRange(-1, 2)};
      if (!steps.diagonals && by.x != 0) by.y = 0;
      const Cell there{here.x + by.x, here.y + by.y};
      const bool can_go = map.contains(there) && !map.is_blocked(there) && *rc::gen::inRange(0, 4) > 0;
      cells.push_back(can_go ? there : here);
    }
    Agent& agent = steps.instance.agents.emplace_back();
    agent.id = std::to_string(robot);
    agent.start = cells.front();
    agent.goal = cells.back();
    agent.speed_cells_per_s = *any_of({1.0, 2.0, 0.5});
    steps.cells.push_back(std::move(cells));
  }
  return steps;
}

/// A step takes as long as the slowest robot needs for a cell.
Solution solution_of(const Steps& steps) {
  double step_s = 0;
  for (const Agent& agent : steps.instance.agents) step_s = std::max(step_s, 1 / agent.speed_cells_per_s);
  Solution solution;
  for (const std::vector<Cell>& cells : steps.cells) {
    Trajectory& trajectory = solution.trajectories.emplace_back();
    trajectory.start = cells.front();
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const auto end = static_cast<double>(i);
      trajectory.motions.push_back({(end - 1) * step_s, end * step_s, cells[i - 1], cells[i]});
    }
  }
  return solution;
}

std::string pair_text(int one, int other) {
  return "(" + std::to_string(one) + "," + std::to_string(other) + ")";
}

std::string lacam_text(const Steps& steps) {
  std::string text =
      "agents=" + std::to_string(steps.cells.size()) + "\nsolver=x\nsolved=1\nsoc=7\nsolution=\n";
  for (std::size_t step = 0; step < steps.cells.front().size(); ++step) {
    text += std::to_string(step) + ":";
    for (const std::vector<Cell>& cells : steps.cells) text += pair_text(cells[step].x, cells[step].y) + ",";
    text += '\n';
  }
  return text;
}

std::string paths_text(const Steps& steps, bool rows_first) {
  std::string text;
  for (std::size_t robot = 0; robot < steps.cells.size(); ++robot) {
    text += "Agent " + std::to_string(robot) + ": ";
    for (const Cell cell : steps.cells[robot]) {
      text += (rows_first ? pair_text(cell.y, cell.x) : pair_text(cell.x, cell.y)) + "->";
    }
    text += '\n';
  }
  return text;
}

/// Now and then a wait is left out: the next place says when it ends.
std::string yaml_text(const Steps& steps) {
  std::string text = "statistics:\n  cost: 12\nschedule:\n";
  for (std::size_t robot = 0; robot < steps.cells.size(); ++robot) {
    text += "  agent" + std::to_string(robot) + ":\n";
    const std::vector<Cell>& cells = steps.cells[robot];
    for (std::size_t step = 0; step < cells.size(); ++step) {
      const bool waits = step > 0 && step + 1 < cells.size() && cells[step] == cells[step - 1];
      if (waits && *rc::gen::arbitrary<bool>()) continue;
      text += "    - x: " + std::to_string(cells[step].x) + "\n      y: " + std::to_string(cells[step].y) +
              "\n      t: " + std::to_string(step) + "\n";
    }
  }
  return text;
}

/// As MAPF-tracker has them: `u` is one row down in our maps, one up if they are flipped.
std::string moves_text(const std::vector<Cell>& cells, bool flipped) {
  std::string text;
  for (std::size_t i = 1; i < cells.size();) {
    const Cell by{cells[i].x - cells[i - 1].x, cells[i].y - cells[i - 1].y};
    std::size_t run = 0;
    while (i < cells.size() && cells[i].x - cells[i - 1].x == by.x && cells[i].y - cells[i - 1].y == by.y) {
      ++run;
      ++i;
    }
    const char up = flipped ? 'd' : 'u';
    const char down = flipped ? 'u' : 'd';
    const char letter = by.x > 0 ? 'r' : by.x < 0 ? 'l' : by.y > 0 ? up : by.y < 0 ? down : 'w';
    text += (run > 1 ? std::to_string(run) : "") + letter;
  }
  return text;
}

std::string all_moves(const Steps& steps, bool flipped) {
  std::string text;
  for (const std::vector<Cell>& cells : steps.cells) text += moves_text(cells, flipped) + "\n";
  return text;
}

std::string tracker_table(const Steps& steps, bool flipped) {
  std::string moves = all_moves(steps, flipped);
  moves.pop_back();
  return std::string("flip_up_down,agents,map_name,solution_plan\n") + (flipped ? "true" : "false") + "," +
         std::to_string(steps.cells.size()) + ",m,\"" + moves + "\"\n";
}

void reads_back(const Steps& steps, const std::string& text, const char* format) {
  const auto read = parse_solution(text, kFile, steps.instance, format);
  if (!read) RC_FAIL(read.error().message() + "\n" + text);
  RC_LOG() << format << ":\n" << text << std::endl;
  const Solution expected = solution_of(steps);
  RC_ASSERT(read->status == "solved");
  RC_ASSERT(read->solution.trajectories.size() == expected.trajectories.size());
  for (std::size_t i = 0; i < expected.trajectories.size(); ++i) {
    RC_ASSERT(read->solution.trajectories[i].start == expected.trajectories[i].start);
    RC_ASSERT(canonical(read->solution.trajectories[i]) == canonical(expected.trajectories[i]));
    RC_ASSERT(read->solution.trajectories[i].arrival_s() == expected.trajectories[i].arrival_s());
  }
}

/// Does the plan end at the goals if its rows are counted the other way round?
bool is_ambiguous_upside_down(const Steps& steps) {
  return std::all_of(steps.cells.begin(), steps.cells.end(), [&](const std::vector<Cell>& cells) {
    std::int32_t y = cells.front().y;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      y -= cells[i].y - cells[i - 1].y;
      if (y < 0 || y >= steps.instance.map.height()) return false;
    }
    return y == cells.back().y;
  });
}

bool begins_and_ends_on_the_diagonal(const Steps& steps) {
  return std::all_of(steps.cells.begin(), steps.cells.end(), [](const std::vector<Cell>& cells) {
    return cells.front().x == cells.front().y && cells.back().x == cells.back().y;
  });
}

bool begins_on_the_diagonal(const Steps& steps) {
  return std::all_of(steps.cells.begin(), steps.cells.end(),
                     [](const std::vector<Cell>& cells) { return cells.front().x == cells.front().y; });
}

/// "0: (3,4,0) (5,4,2)", in any order of the robots.
std::string plain_text(const Instance& instance, const Solution& solution) {
  std::vector<std::size_t> robots(instance.agents.size());
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i] = i;
  if (*rc::gen::arbitrary<bool>()) std::reverse(robots.begin(), robots.end());
  std::ostringstream text;
  text.precision(17);
  for (const std::size_t robot : robots) {
    const Trajectory& trajectory = solution.trajectories[robot];
    text << robot << ": (" << trajectory.start.x << "," << trajectory.start.y << ",0)";
    for (const TimedMotion& motion : trajectory.motions) {
      text << " (" << motion.to.x << "," << motion.to.y << "," << motion.end_s << ")";
    }
    text << "\n";
  }
  return text.str();
}

std::vector<Cell> without_repeats(const std::vector<Cell>& cells) {
  std::vector<Cell> result = cells;
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Cell> cells_of(const Trajectory& trajectory) {
  std::vector<Cell> cells = {trajectory.start};
  for (const TimedMotion& motion : trajectory.motions) {
    const Cell path{motion.to.x - motion.from.x, motion.to.y - motion.from.y};
    const std::int32_t length = std::abs(path.x) + std::abs(path.y);
    for (std::int32_t i = 1; i <= length; ++i) {
      cells.push_back({motion.from.x + path.x / length * i, motion.from.y + path.y / length * i});
    }
  }
  return cells;
}

/// A plan of LaCAM, and its steps.
struct Stepped {
  PlanCase plan_case;
  Solution solution;
  std::vector<std::vector<Cell>> steps;
};

Stepped any_stepped() {
  Stepped stepped{*any_case(), {}, {}};
  Instance& instance = stepped.plan_case.instance;
  instance.obstacles.clear();
  for (Agent& agent : instance.agents) {
    agent.radius_cells = std::min(agent.radius_cells, kDefaultRadiusCells);
    agent.speed_cells_per_s = 1;
  }
  note_case(stepped.plan_case);
  PlannerOptions options;
  options.max_expansions = 20'000;
  const CompleteResult result = plan_complete(instance, options);
  RC_PRE(result.status == LacamStatus::kSolved);
  const auto steps = discrete_steps(instance, result.solution);
  RC_ASSERT(steps.has_value());
  stepped.solution = result.solution;
  stepped.steps = *steps;
  return stepped;
}

const PropertyRoom room("discrete_formats", [] {
  bool passed = true;

  passed &= property("one plan in steps is the same from each program", [] {
    const Steps steps = at_full_size([] { return make_steps(true); });
    reads_back(steps, lacam_text(steps), "lacam");
    reads_back(steps, lacam_text(steps), "");
    reads_back(steps, yaml_text(steps), "yaml");
    reads_back(steps, yaml_text(steps), "");
    RC_CLASSIFY(steps.diagonals, "with diagonals");
    RC_CLASSIFY(steps.instance.map.width() != steps.instance.map.height(), "not square");
    reads_back(steps, paths_text(steps, false), "paths-xy");
    // What fits both ways is read rows first.
    for (const char* const format : {"eecbs", "mapf-lns2", "paths", ""}) {
      reads_back(steps, paths_text(steps, true), format);
    }
    if (begins_and_ends_on_the_diagonal(steps)) return;
    reads_back(steps, paths_text(steps, false), "paths");
    RC_CLASSIFY(begins_on_the_diagonal(steps), "told by goals alone");
  });

  passed &= property("a robot at two places at one step is refused, a run without a plan is none", [] {
    const Steps steps = at_full_size([] { return make_steps(true); });
    const Cell last = steps.cells.back().back();
    const std::string twice = yaml_text(steps) + "    - x: " + std::to_string(last.x) +
                              "\n      y: " + std::to_string(last.y) +
                              "\n      t: " + std::to_string(steps.cells.back().size() - 1) + "\n";
    RC_ASSERT(!parse_solution(twice, kFile, steps.instance, "yaml"));
    const auto failed = parse_solution(
        "agents=" + std::to_string(steps.cells.size()) + "\nsolved=0\nsoc=0\nsoc=9\nsolution=\n", kFile,
        steps.instance, "lacam");
    RC_ASSERT(failed.has_value());
    RC_ASSERT(failed->status == "failed");
    // What is said twice counts once.
    RC_ASSERT(failed->reported == (std::vector<std::pair<std::string, double>>{{"soc", 0}}));
  });

  passed &= property("strings of moves: as they are written, either way up", [] {
    const Steps steps = at_full_size([] { return make_steps(false); });
    RC_ASSERT(tracker_lines(steps.cells) == all_moves(steps, false));
    reads_back(steps, all_moves(steps, false), "tracker");
    reads_back(steps, tracker_table(steps, false), "tracker");
    reads_back(steps, tracker_table(steps, true), "tracker");
    if (!is_ambiguous_upside_down(steps)) reads_back(steps, all_moves(steps, true), "tracker");
    RC_CLASSIFY(is_ambiguous_upside_down(steps), "right both ways up");
  });

  passed &= property("tables of moves state what the plan costs, and what each robot alone would", [] {
    const Stepped stepped = any_stepped();
    RC_PRE(!stepped.steps.empty());
    std::int64_t alone = 0;
    std::int64_t cost = 0;
    for (const Agent& agent : stepped.plan_case.instance.agents) {
      alone += *steps_between(stepped.plan_case.instance.map, agent.start, agent.goal);
    }
    for (const std::vector<Cell>& cells : stepped.steps) cost += static_cast<std::int64_t>(cells.size()) - 1;
    const int number = *rc::gen::inRange(0, 100);
    const TrackerRow scenario = tracker_scenario("a/b/room-1-even-" + std::to_string(number) + ".scen");
    const std::string table = tracker_csv(stepped.plan_case.instance, scenario, stepped.steps);
    const auto rows = parse_tracker_rows(table, kFile);
    RC_ASSERT(rows.has_value());
    RC_ASSERT(rows->size() == 1u);
    RC_ASSERT(rows->front().map_name == "room-1");
    RC_ASSERT(rows->front().scen_type == "even");
    RC_ASSERT(rows->front().type_id == number);
    RC_ASSERT(rows->front().agents == static_cast<std::int64_t>(stepped.steps.size()));
    RC_ASSERT(rows->front().lower_cost == alone);
    RC_ASSERT(rows->front().solution_cost == cost);
    const auto read = parse_solution(table, kFile, stepped.plan_case.instance);
    RC_ASSERT(read.has_value());
    for (std::size_t i = 0; i < stepped.steps.size(); ++i) {
      RC_ASSERT(cells_of(read->solution.trajectories[i]) == without_repeats(stepped.steps[i]));
    }
  });

  passed &= property(
      "discrete_steps: the same cells, one step at a time, no two at one cell or changing places", [] {
        const Stepped stepped = any_stepped();
        const auto& steps = stepped.steps;
        std::size_t length = 0;
        for (const auto& cells : steps) length = std::max(length, cells.size());
        const auto at = [&](std::size_t robot, std::size_t step) {
          return steps[robot][std::min(step, steps[robot].size() - 1)];
        };
        for (std::size_t robot = 0; robot < steps.size(); ++robot) {
          RC_ASSERT(without_repeats(steps[robot]) == cells_of(stepped.solution.trajectories[robot]));
          if (steps[robot].size() > 1) RC_ASSERT(steps[robot].back() != *(steps[robot].end() - 2));
          for (std::size_t step = 0; step < length; ++step) {
            for (std::size_t other = 0; other < robot; ++other) {
              RC_ASSERT(at(robot, step) != at(other, step));
              if (step == 0) continue;
              RC_ASSERT(at(robot, step) != at(other, step - 1) || at(robot, step - 1) != at(other, step));
            }
          }
        }
        RC_CLASSIFY(length > 3, "more than two steps");
      });

  passed &= property("plans in lines of places and times read back as they were", [] {
    Scene scene = *any_scene();
    RC_PRE(!scene.instance.agents.empty());
    // Robots are told by their ids, and where nobody is called so, by their numbers.
    const std::string before = *rc::gen::element<std::string>("", "r");
    for (std::size_t i = 0; i < scene.instance.agents.size(); ++i)
      scene.instance.agents[i].id = before + std::to_string(i);
    const auto read =
        parse_solution(plain_text(scene.instance, scene.solution), kFile, scene.instance, "lines");
    if (!read) RC_FAIL(read.error().message());
    for (std::size_t i = 0; i < scene.solution.trajectories.size(); ++i) {
      RC_ASSERT(read->solution.trajectories[i] == scene.solution.trajectories[i]);
    }
  });

  passed &= property("instances for other programs hold the map, the robots and the limits", [] {
    const PlanCase plan_case = *any_case();
    const Instance& instance = plan_case.instance;
    const GridMap& map = instance.map;
    // Continuous-CBS: rows are i.
    pugi::xml_document document;
    RC_ASSERT(static_cast<bool>(document.load_string(write_ccbs_map(map).c_str())));
    const pugi::xml_node node = document.child("root").child("map");
    RC_ASSERT(node.child("width").text().as_int() == map.width());
    RC_ASSERT(node.child("height").text().as_int() == map.height());
    std::int32_t y = 0;
    for (const pugi::xml_node row : node.child("grid").children("row")) {
      std::istringstream cells(row.text().get());
      for (std::int32_t x = 0; x < map.width(); ++x) {
        int blocked = -1;
        cells >> blocked;
        RC_ASSERT(blocked == (map.is_blocked({x, y}) ? 1 : 0));
      }
      ++y;
    }
    RC_ASSERT(y == map.height());
    RC_ASSERT(static_cast<bool>(document.load_string(write_ccbs_task(instance).c_str())));
    std::size_t robot = 0;
    for (const pugi::xml_node agent : document.child("root").children("agent")) {
      const Agent& expected = instance.agents[robot++];
      RC_ASSERT(expected.start ==
                (Cell{agent.attribute("start_j").as_int(), agent.attribute("start_i").as_int()}));
      RC_ASSERT(expected.goal ==
                (Cell{agent.attribute("goal_j").as_int(), agent.attribute("goal_i").as_int()}));
    }
    RC_ASSERT(robot == instance.agents.size());
    PlannerOptions options = plan_case.options;
    options.time_limit_s = *any_of({30.0, 0.5, kInfiniteSsi});
    RC_ASSERT(static_cast<bool>(document.load_string(write_ccbs_config(instance, options).c_str())));
    const pugi::xml_node algorithm = document.child("root").child("algorithm");
    double largest = 0;
    for (const Agent& agent : instance.agents) largest = std::max(largest, agent.radius_cells);
    RC_ASSERT(algorithm.child("agent_size").text().as_double() == std::min(largest, 0.5));
    RC_ASSERT(algorithm.child("timelimit").text().as_double() ==
              (std::isinf(options.time_limit_s) ? -1 : options.time_limit_s));
    RC_ASSERT(algorithm.child("connectedness").text().as_int() == options.connectedness);
    // libMultiRobotPlanning: x, y.
    std::string expected = "map:\n  dimensions: [" + std::to_string(map.width()) + ", " +
                           std::to_string(map.height()) + "]\n  obstacles:";
    expected += map.blocked_count() == 0 ? " []\n" : "\n";
    for (std::int32_t row = 0; row < map.height(); ++row) {
      for (std::int32_t column = 0; column < map.width(); ++column) {
        if (!map.is_blocked({column, row})) continue;
        expected += "  - [" + std::to_string(column) + ", " + std::to_string(row) + "]\n";
      }
    }
    expected += instance.agents.empty() ? "agents: []\n" : "agents:\n";
    for (std::size_t i = 0; i < instance.agents.size(); ++i) {
      const Agent& agent = instance.agents[i];
      const auto cell = [](Cell at) {
        return "[" + std::to_string(at.x) + ", " + std::to_string(at.y) + "]\n";
      };
      expected += "- name: agent" + std::to_string(i) + "\n  start: " + cell(agent.start) +
                  "  goal: " + cell(agent.goal);
    }
    RC_ASSERT(write_lmrp_yaml(instance) == expected);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::discrete_formats_laws
