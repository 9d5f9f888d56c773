// What the readers of the solution formats share.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/solution_io.hpp"

namespace sipplab {

Input<SolutionDocument> parse_solution_json(std::string_view text, const std::string& file_name,
                                            const Instance& instance);
Input<SolutionDocument> parse_solution_xml(std::string_view text, const std::string& file_name,
                                           const Instance& instance);
Input<SolutionDocument> parse_solution_csv(std::string_view text, const std::string& file_name,
                                           const Instance& instance);
Input<SolutionDocument> parse_solution_plain(std::string_view text, const std::string& file_name,
                                             const Instance& instance);
/// Of other programs: result texts of LaCAM, lines of cells of EECBS and its kin, YAML of
/// libMultiRobotPlanning, and MAPF-tracker's moves, by themselves or in its table.
Input<SolutionDocument> parse_solution_lacam(std::string_view text, const std::string& file_name,
                                             const Instance& instance);
enum class CellOrder { kGuess, kRowsFirst, kColumnsFirst };
Input<SolutionDocument> parse_solution_paths(std::string_view text, const std::string& file_name,
                                             const Instance& instance, CellOrder order);
Input<SolutionDocument> parse_solution_yaml(std::string_view text, const std::string& file_name,
                                            const Instance& instance);
Input<SolutionDocument> parse_solution_tracker(std::string_view text, const std::string& file_name,
                                               const Instance& instance);
/// MAPF-tracker's table: its header, and a row for a solution. Refused: moves that are not unit steps along
/// rows and columns.
Expected<std::string, std::string> solution_to_tracker(const Instance& instance,
                                                       const SolutionDocument& document);
/// Whether a text that begins so is one of them.
bool is_lacam_solution(std::string_view head);
bool is_path_solution(std::string_view head);
bool is_yaml_solution(std::string_view head);
bool is_tracker_solution(std::string_view head);

/// Whether the text begins as a solution in plain lines does: "0: (3,4,0)", or "# words".
bool is_plain_solution(std::string_view head);

/// Puts trajectories in the order of the instance's agents. They are told by id;
/// by position where ids repeat or are left out.
class TrajectoryCollector {
 public:
  explicit TrajectoryCollector(const Instance& instance);

  /// Empty when the trajectory was taken, else what is wrong: no such agent, or one that has a trajectory
  /// already. It begins at `stated_start`, else where its first motion does; a robot without either stays at
  /// its start.
  std::string add(const std::optional<std::string>& id, std::size_t position, Trajectory trajectory,
                  const std::optional<Cell>& stated_start);
  /// The first agent without a trajectory, if there is one.
  std::optional<AgentIndex> missing() const;
  Solution take() { return Solution{std::move(trajectories_)}; }

 private:
  const Instance& instance_;
  std::map<std::string, AgentIndex> agent_of_id_;
  bool ids_repeat_ = false;
  std::vector<Trajectory> trajectories_;
  std::vector<bool> taken_;
};

}  // namespace sipplab
