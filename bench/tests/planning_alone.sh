#!/usr/bin/env bash
# plan, validate and generate as a program of their own: it works, and nothing of SQLite or Google
# Benchmark is in it or loaded by it.
#
#   planning_alone.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

for part in 'readelf -d' nm 'nm -D'; do
  # Names of C++ are mangled: of Google Benchmark they hold its namespace, with its length.
  found=$($part "$program" 2>/dev/null | grep -E 'lib(sqlite3|benchmark)|sqlite3_|9benchmark' | head -n 5) || true
  [ -z "$found" ] || { printf 'BROKEN: %s names\n%s\n' "$part" "$found" && exit 1; }
done
"$program" generate --map empty:8x8 --agents 4 --count 1 --seed 1 -o small >/dev/null
"$program" plan --instance small/0.xml -o plan.xml >/dev/null
"$program" validate --instance small/0.xml --solution plan.xml >/dev/null
code=0
"$program" runs >out 2>err || code=$?
[ "$code" -eq 2 ] || { echo "BROKEN: exit code $code of a command that is not there, expected 2" && exit 1; }
echo 'planning alone: three commands, no SQLite, no Google Benchmark'
