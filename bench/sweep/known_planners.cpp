#include "bench/sweep/known_planners.hpp"

#include <algorithm>

namespace sipplab::bench {
namespace {

constexpr std::string_view kUnitSteps = "unit steps; re-time its plans";
constexpr KnownPlanner kPlanners[] = {
    {"lacam3", "LaCAM3 (Okumura 2024), anytime: takes the whole time limit",
     "{program} -m {movingai_map} -i {scen} -N {robots} -s {small_seed} -t {whole_time_limit} -v 0 -o {out}",
     "lacam", kUnitSteps},
    {"lacam2", "LaCAM2 (Okumura 2023)",
     "{program} -m {movingai_map} -i {scen} -N {robots} -s {small_seed} -t {whole_time_limit} -v 0 -o {out}",
     "lacam", kUnitSteps},
    {"lacam", "LaCAM (Okumura 2023)",
     "{program} -m {movingai_map} -i {scen} -N {robots} -s {small_seed} -t {whole_time_limit} -v 0 -o {out}",
     "lacam", kUnitSteps},
    {"eecbs", "EECBS (Li, Ruml, Koenig 2021), suboptimality 1.2",
     "{program} -m {movingai_map} -a {scen} -k {robots} -t {time_limit} -s 0 --suboptimality=1.2 -o {stats} "
     "--outputPaths={out}",
     "eecbs", kUnitSteps},
    {"cbsh2-rtc", "CBSH2-RTC (Li et al. 2021), optimal in steps",
     "{program} -m {movingai_map} -a {scen} -k {robots} -t {time_limit} -s 0 -o {stats} --outputPaths={out}",
     "eecbs", kUnitSteps},
    {"pbs", "PBS (Ma et al. 2019)",
     "{program} -m {movingai_map} -a {scen} -k {robots} -t {time_limit} -s 0 -o {stats} --outputPaths={out}",
     "eecbs", kUnitSteps},
    {"mapf-lns2", "MAPF-LNS2 (Li et al. 2022), anytime: takes the whole time limit",
     "{program} -m {movingai_map} -a {scen} -k {robots} -t {time_limit} -s 0 --seed={small_seed} "
     "--maxIterations=1000000000 "
     "-o {stats} --outputPaths={out}",
     "mapf-lns2", kUnitSteps},
    {"libmrp-cbs", "CBS of libMultiRobotPlanning, optimal in steps", "{program} -i {yaml} -o {out}", "yaml",
     kUnitSteps},
    {"libmrp-ecbs", "ECBS of libMultiRobotPlanning, suboptimality 1.3", "{program} -i {yaml} -o {out} -w 1.3",
     "yaml", kUnitSteps},
    {"libmrp-sipp", "prioritized SIPP of libMultiRobotPlanning", "{program} -i {yaml} -o {out}", "yaml",
     kUnitSteps},
    {"ccbs", "Continuous-CBS (Andreychuk et al. 2022), moves as --connectedness says",
     "{program} {ccbs_map} {ccbs_task} {ccbs_config}", "ccbs", "one radius up to 0.5, speed 1",
     "found: false"},
    {"aa-sipp", "the published AA-SIPP(m) (Yakovlev, Andreychuk 2017)", "{program} {task} {map} {config}",
     "aa-sipp", "nothing more: it reads all that AA-SIPP(m)'s XML states"},
};

}  // namespace

std::span<const KnownPlanner> known_planners() { return kPlanners; }

const KnownPlanner* find_known_planner(std::string_view name) {
  const auto found = std::find_if(std::begin(kPlanners), std::end(kPlanners),
                                  [&](const KnownPlanner& planner) { return planner.name == name; });
  return found == std::end(kPlanners) ? nullptr : &*found;
}

}  // namespace sipplab::bench
