// Solutions out and in: XML in the style of AA-SIPP(m)'s log, JSON, CSV. All numbers
// survive the round trip bit by bit.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/solve.hpp"

namespace sipplab {

/// A robot found no path, and these made room for it.
struct EjectionRecord {
  AgentIndex failed = 0;
  std::vector<AgentIndex> ejected;
};

/// A solution and what is told about it. What is empty is written as null in JSON
/// and left out elsewhere.
struct SolutionDocument {
  std::string status = "solved";  ///< "solved", "failed", "limit"
  bool valid = false;             ///< the validator's verdict
  Solution solution;              ///< one trajectory per agent when solved, else empty
  std::vector<AgentIndex> order;  ///< final priority order
  std::optional<double> makespan_s;
  std::optional<double> flowtime_s;
  std::uint64_t tries = 0;
  std::uint64_t expansions = 0;
  std::uint64_t generations = 0;
  double planning_seconds = 0;
  std::string plan_hash;
  std::string made_by;      ///< "prioritized", "complete"; empty if it is not known
  std::string robots_file;  ///< where the robots come from; MAPF-tracker's table names its scenario after it
  /// The guarantee of start-safe intervals holds for `order` in [0, ssi_kept_s].
  std::optional<double> ssi_kept_s;
  /// What it was planned with, as the table of options has it. Kept by JSON (extra keys at the end) and XML.
  std::optional<PlannerOptions> options;
  /// What another program says of its run, under its own names: unchecked numbers. Not written.
  std::vector<std::pair<std::string, double>> reported;
  /// Written to JSON if there are any, and not read back.
  std::vector<EjectionRecord> ejections;
  std::vector<BestStep> steps;
  std::optional<ImprovementLog> improvement;
};

/// REQUIRES: the solution is empty or has one trajectory per agent of the instance.
std::string solution_to_json(const Instance& instance, const SolutionDocument& document);
std::string solution_to_xml(const Instance& instance, const SolutionDocument& document);
/// One line a motion: agent,id,t0,t1,x0,y0,x1,y1, and turn_to where there are turns. Holds the trajectories
/// alone. The first line of a robot that never moves is a wait from 0 to 0, which says where it is.
std::string solution_to_csv(const Instance& instance, const SolutionDocument& document);

/// Reads a solution of this instance; the format is told from the content. Besides the
/// formats that are written, plain lines are read, one a robot: its id, or else its position counted from 0,
/// a colon, and the cells with the times at which it is there, `0: (3,4,0) (5,4,2)`; the words "agent" and
/// "robot" before it, arrows between, and lines that begin with # are passed over. The published planner's
/// logs are read as well: their durations, rounded to 8 digits, are summed up from time 0, and a straight
/// section that takes its length over the robot's speed to within that rounding gets exactly that duration. A
/// robot without motions stays where the file says that it begins, else at its start. Whether the solution is
/// right is for validate() to say; here only its form is checked.
///
/// Plans in discrete time are read as their programs write them: a step lasts as long as the slowest robot
/// needs for a cell. A plan that disagrees with the instance is an error: another start, a jump, too few
/// robots, rows and columns exchanged. `format` is a name of solution_formats(), for files where guessing
/// fails; empty: guess.
Input<SolutionDocument> parse_solution(std::string_view text, const std::string& file_name,
                                       const Instance& instance, std::string_view format = {});
Input<SolutionDocument> load_solution(const std::string& path, const Instance& instance,
                                      std::string_view format = {});

/// A format of solutions: one row of a table from which flags, lists and guesses are made.
struct SolutionFormat {
  std::string_view name;  ///< of the program that writes it, or the suffix of its files
  std::string_view words;
  /// Whether a text may be of this format, from its first characters; null: it is taken only by its name.
  bool (*begins_so)(std::string_view head) = nullptr;
  Input<SolutionDocument> (*parse)(std::string_view text, const std::string& file_name,
                                   const Instance& instance) = nullptr;
  /// The text, or why this solution cannot be told in it; null: the format is only read.
  Expected<std::string, std::string> (*write)(const Instance& instance,
                                              const SolutionDocument& document) = nullptr;
};
/// In the order in which a text is asked for its format.
std::span<const SolutionFormat> solution_formats();
/// The format that a file's suffix names, if it is written; else XML.
std::string_view solution_format_of_file(std::string_view path);
/// `format`: a name of solution_formats() that is written. The error says why the solution cannot be told in
/// it.
Expected<std::string, std::string> write_solution(std::string_view format, const Instance& instance,
                                                  const SolutionDocument& document);

}  // namespace sipplab
