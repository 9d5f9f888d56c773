// Plans four robots in the paper's warehouse, improves the plan, and asks the validator about it.
#include <cstdio>

#include "sipplab/generator.hpp"
#include "sipplab/solve.hpp"

int main() {
  sipplab::GeneratorOptions wanted;
  wanted.agents = 4;
  const auto instance = sipplab::generate_instance(sipplab::warehouse_map(), wanted);
  if (!instance) return 1;
  sipplab::PlannerOptions options;
  options.improve = sipplab::parse_improve_budget("20i");
  const sipplab::SolveResult result = sipplab::solve(*instance, options);
  if (!result.is_solved()) return 1;
  if (!sipplab::validate(*instance, result.solution(), result.guarantees(options.rules)).valid()) return 1;
  std::printf("makespan %g s, flowtime %g s\n", sipplab::makespan_s(result.solution()),
              sipplab::flowtime_s(result.solution()));
  return 0;
}
