#!/usr/bin/env bash
# The library as another project uses it: installs into an empty folder, then builds and
# runs a program that finds it by find_package(sipplab).
#
#   find_package.sh BUILD_FOLDER CXX_COMPILER
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

mkdir "$work/user"
cat >"$work/user/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(sipplab 0.1 REQUIRED)
add_executable(user user.cpp)
target_link_libraries(user PRIVATE sipplab::planner)
CMAKE
cat >"$work/user/user.cpp" <<'CPP'
#include <cstdio>

#include "planner/generator/generator.hpp"
#include "planner/prioritized/prioritized_planner.hpp"
#include "planner/validator/validator.hpp"

int main() {
  sipplab::GeneratorOptions options;
  options.agents = 4;
  const auto instance = sipplab::generate_instance(sipplab::warehouse_map(), options);
  if (!instance) return 1;
  const sipplab::PlanResult result = sipplab::plan(*instance, sipplab::PlannerOptions{});
  if (result.status != sipplab::PlanStatus::kSolved) return 1;
  if (!sipplab::validate(*instance, result.solution).valid()) return 1;
  std::printf("makespan %g\n", sipplab::makespan_s(result.solution));
  return 0;
}
CPP
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
flags=$(cached SIPPLAB_SANITIZE)
# The same build tool: a fresh machine has no other.
cmake -S "$work/user" -B "$work/build" -G "$(cached CMAKE_GENERATOR)" -DCMAKE_CXX_COMPILER="$2" -DCMAKE_PREFIX_PATH="$work/prefix" \
  ${flags:+-DCMAKE_CXX_FLAGS=-fsanitize=$flags} >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/build/user"
