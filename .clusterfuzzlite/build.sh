#!/bin/bash -eu
# Builds the fuzz targets for a distributed engine (ClusterFuzzLite, OSS-Fuzz); with names as
# arguments those alone. The engine says how: $CXX, $CXXFLAGS (sanitizers are in there),
# $LIB_FUZZING_ENGINE (brings main), $OUT (where programs, seed corpora, dictionaries and
# options are looked for).
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if [ ! -d "$root/fuzz" ]; then root=${SRC:?}/sipplab; fi # the engine runs a copy of this script
build=${WORK:-$(mktemp -d)}/sipplab-fuzz

# Programs run elsewhere: they look for shared libraries beside themselves.
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_COMPILER="${CXX:-clang++}" -DCMAKE_CXX_FLAGS="${CXXFLAGS:-}" \
  -DCMAKE_BUILD_WITH_INSTALL_RPATH=ON -DCMAKE_INSTALL_RPATH="\$ORIGIN/lib" \
  -DSIPPLAB_ASSERTIONS=ON -DSIPPLAB_FUZZ_ENGINE="${LIB_FUZZING_ENGINE:?}" \
  -DSIPPLAB_BUILD_TESTS=OFF -DSIPPLAB_BUILD_BENCH=OFF -DSIPPLAB_BUILD_DB=OFF -DBUILD_TESTING=OFF
cmake --build "$build" --target "${@:-fuzz_targets}"

mkdir -p "$OUT/lib"
for folder in "$root"/fuzz/corpus/*; do
  name=$(basename "$folder")
  [ -x "$build/fuzz/$name" ] || continue
  cp "$build/fuzz/$name" "$OUT/"
  ldd "$build/fuzz/$name" | sed -n 's/.*=> \(.*lib\(pugixml\|fmt\|xxhash\|yaml-cpp\)[^ ]*\).*/\1/p' | xargs -I{} cp -L {} "$OUT/lib/"

  seeds=$build/seeds/$name
  rm -rf "$seeds" && mkdir -p "$seeds"
  cp "$folder"/* "$seeds/"
  if [ -d "$root/fuzz/regressions/$name" ]; then cp "$root/fuzz/regressions/$name"/* "$seeds/"; fi
  (cd "$seeds" && cmake -E tar cf "$OUT/${name}_seed_corpus.zip" --format=zip -- *)

  printf '[libfuzzer]\nmax_len = 4096\ntimeout = 10\nrss_limit_mb = 1024\nentropic = 0\n' >"$OUT/$name.options"
  if [ -f "$root/fuzz/dictionaries/$name.dict" ]; then
    cp "$root/fuzz/dictionaries/$name.dict" "$OUT/"
    printf 'dict = %s.dict\n' "$name" >>"$OUT/$name.options"
  fi
done
