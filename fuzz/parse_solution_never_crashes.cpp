// Claim: no bytes, taken as a solution in any format that is read, make the reader crash or take
// memory that they are not due; a refusal is one line, and a solution that is accepted reads
// back equal from each format. What is accepted, the validator judges without a crash.
#include <string>

#include "fuzz/support/claims.hpp"
#include "fuzz/support/reading.hpp"
#include "fuzz/support/target.hpp"
#include "planner/retime/retime.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/validator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// The instance that solutions are read for; seeds in corpus/ belong to it. Ids are such
/// that every format has to escape one.
const Instance& instance_of_solutions() {
  static const Instance instance = [] {
    Instance made;
    made.map = GridMap(6, 4);
    made.map.set_blocked({2, 1}, true);
    made.agents.resize(3);
    made.agents[0].id = "0";
    made.agents[0].goal = {5, 0};
    made.agents[1].id = "a,\"b\"";
    made.agents[1].start = {0, 3};
    made.agents[1].goal = {4, 2};
    made.agents[1].speed_cells_per_s = 2;
    made.agents[2].id = "<&>";
    made.agents[2].start = {5, 3};
    made.agents[2].goal = {5, 3};
    made.agents[2].radius_cells = 0.25;
    return made;
  }();
  return instance;
}

bool same(const SolutionDocument& a, const SolutionDocument& b) {
  return a.solution == b.solution && a.status == b.status && a.valid == b.valid && a.order == b.order &&
         a.makespan_s == b.makespan_s && a.flowtime_s == b.flowtime_s && a.tries == b.tries &&
         a.expansions == b.expansions && a.generations == b.generations &&
         a.planning_seconds == b.planning_seconds && a.plan_hash == b.plan_hash && a.made_by == b.made_by &&
         a.ssi_kept_s == b.ssi_kept_s && a.options == b.options;
}

void check_read_back(const SolutionDocument& document) {
  const Instance& instance = instance_of_solutions();
  for (const SolutionFormat& format : solution_formats()) {
    const auto text = write_solution(format.name, instance, document);
    if (!text) continue;  // the format is not written, or cannot tell this solution
    if (format.name == "tracker" && document.status != "solved") continue;  // a table without a row
    const auto again = parse_solution(*text, "again", instance, format.name);
    fuzz::require(Claim::kReadsBackEqual, again.has_value(), again ? "" : again.error().message());
    if (format.name == "csv") {
      const bool trajectories = !document.solution.trajectories.empty();
      fuzz::require(Claim::kReadsBackEqual, !trajectories || again->solution == document.solution,
                    "trajectories read back from CSV as others");
    } else if (format.name != "tracker") {  // which has steps instead of seconds
      fuzz::require(Claim::kReadsBackEqual, same(*again, document), "a solution reads back as another");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::count(fuzz::Event::kInputs);
  const std::string_view text = fuzz::text_of(data, size);
  const Instance& instance = instance_of_solutions();
  const auto document = fuzz::read_checked(text, [&] { return parse_solution(text, "fuzz", instance); });
  if (!document) return 0;
  check_read_back(*document);
  static_cast<void>(plan_hash(document->solution));
  if (document->solution.trajectories.empty()) return 0;
  validate(instance, document->solution);
  static_cast<void>(retime(instance, document->solution));
  return 0;
}
