#!/usr/bin/env bash
# The build script for distributed engines: two targets are built with the engine that is at
# hand, and everything is there that an engine looks for. usage: engine_build.sh SCRIPT COMPILER [libc++]
#
# libc++: with that library, as OSS-Fuzz and ClusterFuzzLite build. It takes Clang 16 or later.
set -euo pipefail
script=$1 flags='-O0 -fsanitize=fuzzer-no-link' engine=-fsanitize=fuzzer
if [ "${3:-}" = libc++ ]; then
  flags+=' -stdlib=libc++'
  engine+=' -Wl,--no-as-needed -l:libstdc++.so.6' # Debian's engine was built with that one
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/out"
# Without optimisation and sanitizers: what is tested is the script.
OUT=$folder/out WORK=$folder CXX=$2 CXXFLAGS=$flags LIB_FUZZING_ENGINE=$engine \
  "$script" parse_map_never_crashes plan_then_validate >"$folder/log" 2>&1 || { cat "$folder/log" && exit 1; }

expect() { [ -e "$folder/out/$1" ] || { echo "no $1 in \$OUT, expected one" && ls "$folder/out" && exit 1; }; }
for name in parse_map_never_crashes plan_then_validate; do
  expect "$name"
  expect "${name}_seed_corpus.zip"
  expect "$name.options"
  mkdir "$folder/$name"
  (cd "$folder/$name" && cmake -E tar xf "$folder/out/${name}_seed_corpus.zip")
  # Somewhere else, as a fuzzer that knows nothing of the build.
  (cd "$folder/$name" && "$folder/out/$name" -runs=200 -seed=1 "$folder/$name" >"$folder/log" 2>&1) ||
    { cat "$folder/log" && exit 1; }
done
expect parse_map_never_crashes.dict
# Not through a pipe: grep ends at the first match, and with pipefail the end of ldd would count.
ldd "$folder/out/plan_then_validate" >"$folder/libraries"
grep -q "$folder/out/lib/libpugixml" "$folder/libraries" || { echo "libpugixml is not taken along" && exit 1; }
grep -q 'dict = parse_map_never_crashes.dict' "$folder/out/parse_map_never_crashes.options"
echo "built, seeded and run"
