// Plans four robots in the paper's warehouse, and asks the validator about the plan.
#include <cstdio>

#include "planner/generator/generator.hpp"
#include "planner/prioritized/prioritized_planner.hpp"
#include "planner/validator/validator.hpp"

int main() {
  sipplab::GeneratorOptions who;
  who.agents = 4;
  const auto instance = sipplab::generate_instance(sipplab::warehouse_map(), who);
  if (!instance) return 1;
  const sipplab::PlanResult result = sipplab::plan(*instance, sipplab::PlannerOptions{});
  if (result.status != sipplab::PlanStatus::kSolved) return 1;
  if (!sipplab::validate(*instance, result.solution).valid()) return 1;
  std::printf("makespan %g s, flowtime %g s\n", sipplab::makespan_s(result.solution),
              sipplab::flowtime_s(result.solution));
  return 0;
}
