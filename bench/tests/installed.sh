#!/usr/bin/env bash
# Both packages, installed on a machine without the sources: the program plans, SQLite loads the
# extension, and the example of the library builds and runs. scripts/test-fresh runs it in a root of its own.
#
#   installed.sh FOLDER_OF_PACKAGES
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { printf 'BROKEN: %s\n' "$1" && exit 1; }
apt-get -q update
apt-get -y -q install --no-install-recommends "$1"/*.deb sqlite3
cd "$work"

sipplab --version
sipplab generate --map warehouse --agents 16 --seed 7 -o instances
sipplab plan --instance instances/0.xml --json >plan.json
grep -q '"valid": true' plan.json || fail 'plan is not valid'
sipplab bench --suite smoke --robots 8 --count 1 --db history.db
median=$(sqlite3 history.db '.load sipplab_sqlite' "SELECT median(column1) FROM (VALUES (1), (5), (2))")
[ "$median" = 2.0 ] || fail "median of 1, 5, 2 by the extension is $median"
[ -s /usr/share/man/man1/sipplab.1.gz ] || fail 'no manual page'
[ -s /usr/share/bash-completion/completions/sipplab ] || fail 'no completion'

apt-get -y -q install --no-install-recommends g++ cmake make
cmake -S /usr/share/doc/sipplab/example -B example
cmake --build example
example/example
echo 'installed: program, extension, manual, completion and example work'
