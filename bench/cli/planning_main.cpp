// sipplab without SQLite or Google Benchmark: plan, validate and generate.
#include "bench/cli/program.hpp"

int main(int argc, char** argv) { return sipplab::cli::run_program(argc, argv); }
