#!/usr/bin/env bash
# A property that fails is logged, recorded, listed, shown and tried again. Prints one
# line per promise that is broken.
#
#   golden_property.sh PATH_OF_SIPPLAB PATH_OF_PROPERTY_SAMPLE
set -uo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# As in a build folder: sipplab, and the programs of the properties below it.
install -D -m 755 "$1" "$work/sipplab"
install -D -m 755 "$2" "$work/property_tests/property_sample"
cd "$work" || exit 1
# A sanitizer's finding must not look like a negative verdict.
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=99" UBSAN_OPTIONS="${UBSAN_OPTIONS:-}:exitcode=99"
unset SIPPLAB_DB RC_PARAMS SIPPLAB_PROPERTY_LOG

broken=0
complain() {
  printf 'BROKEN: %s\n' "$*"
  broken=$((broken + 1))
}
# expect CODE COMMAND...: runs the command into the files out and err.
expect() {
  local code=$1 got=0
  shift
  "$@" >out 2>err </dev/null || got=$?
  [ "$got" -eq "$code" ] || complain "exit code $got, not $code: $* ($(head -c 300 err))"
}
says() { grep -qF -- "$1" "${2:-out}" || complain "no '$1' in ${2:-out}: $(head -c 600 "${2:-out}")"; }
equal() { [ "$1" = "$2" ] || complain "$3: '$1' is not '$2'"; }
ask() { sqlite3 history.db "$1"; }

# The log: two lines for each property, its beginning and its end, appended.
expect 1 env RC_PARAMS=seed=7 SIPPLAB_PROPERTY_LOG=log property_tests/property_sample
says 'classes: even' err
says 'RC_PARAMS="reproduce=' err
equal "$(grep -c '"started"' log) $(wc -l <log)" "5 10" "lines of the log"
expect 1 env RC_PARAMS=seed=8 SIPPLAB_PROPERTY_LOG=log property_tests/property_sample
equal "$(wc -l <log)" 20 "lines of the log after two runs"
expect 1 property_tests/property_sample
equal "$(wc -l <log)" 20 "lines of the log after a run without one"
expect 2 env RC_PARAMS=max_success=many property_tests/property_sample

expect 1 ./sipplab property totals log
says '10 property runs'
says '6 failed, 2 gave up, 0 crashed'

# The history.
expect 0 ./sipplab property record log --db history.db
says '10 recorded in history.db, 0 there already'
expect 0 ./sipplab property record log --db history.db --json
says '"known": 10'
equal "$(ask 'SELECT count(*) FROM property_run')" 10 "rows after recording twice"
equal "$(ask 'SELECT group_concat(DISTINCT seed) FROM (SELECT seed FROM property_run ORDER BY seed)')" "7,8" "seeds"
equal "$(ask "SELECT cases, discards, shrinks FROM v_property_latest WHERE title = 'every number is odd or even'")" "1000|0|0" "a property that held"
equal "$(ask "SELECT cases, discards > 0 FROM v_property_latest WHERE status = 'gave_up'")" "0|1" "a property that gave up"
equal "$(ask "SELECT count(*) FROM v_property_classes WHERE class = 'even' AND share BETWEEN 0.4 AND 0.6")" 2 "shares of a class"
# Shrunk to what a person can draw: two robots, and ten instead of any number.
equal "$(ask "SELECT max(case_robots), max(case_cells) <= 9 FROM property_run WHERE plan_case IS NOT NULL")" "2|1" "smallest cases"
equal "$(ask "SELECT count(*) FROM property_run WHERE counterexample LIKE '%' || char(10) || '10' || char(10)")" 2 "smallest numbers"

expect 0 ./sipplab property list --db history.db
equal "$(grep -c sample out)" 5 "properties listed"
expect 0 ./sipplab property list --db history.db --all --failed --format csv
equal "$(grep -c failed out)" 6 "failures listed"

# A program that is killed leaves what it was at, until the log says how that ended.
expect 137 env RC_PARAMS="seed=9 max_success=10000000" SIPPLAB_PROPERTY_LOG=killed.log \
  timeout --signal=KILL 1 property_tests/property_sample
expect 0 ./sipplab property record killed.log --db killed.db
says '1 crashed'
equal "$(sqlite3 killed.db 'SELECT status, title, cases FROM property_run')" "crashed|every number is odd or even|0" "what was killed"
expect 0 ./sipplab property list --failed --db killed.db
says 'crashed'
expect 0 ./sipplab property show 1 --db killed.db
says 'RC_PARAMS="seed=9 max_success=10000000" property_sample'
expect 1 ./sipplab property totals killed.log
sed 's/"started"/"passed"/; s/"cases":0/"cases":7/' killed.log >>killed.log
expect 0 ./sipplab property record killed.log --db killed.db
equal "$(sqlite3 killed.db 'SELECT status, cases FROM property_run')" "passed|7" "what had only seemed to be killed"

id=$(ask "SELECT id FROM v_property_latest WHERE title = 'a plan has one robot'")
noted=$(ask "SELECT id FROM v_property_latest WHERE title = 'a plan in 8 neighbours has one robot'")
number=$(ask "SELECT id FROM v_property_latest WHERE title = 'no number is larger than 9'")
held=$(ask "SELECT id FROM v_property_latest WHERE status = 'passed'")
expect 0 ./sipplab property show "$id" --db history.db
says 'planned: 2 robots'
says 'one_robot_at_most(plan_case)'
equal "$(ask "SELECT count(*) FROM property_run WHERE message NOT LIKE 'property_tests/samples/sample.cpp:%'")" 0 "messages that do not begin with a file from the root"
expect 0 ./sipplab property show --db history.db --json
says '"status": "failed"'

# Again: the property still fails, though the plan is right.
expect 1 ./sipplab property replay "$id" --db history.db -o case.xml --svg case.svg
says 'plan      the plan is valid'
says 'property  still fails'
says 'a plan has one robot' err
says '</svg>' case.svg
expect 0 ./sipplab plan --instance case.xml
expect 1 ./sipplab property replay "$noted" --db history.db --json
says 'connectedness 3'
says '"property": "still fails"'
expect 1 ./sipplab property replay "$number" --db history.db
says 'property  still fails'

# The command that it prints does what it says.
./sipplab property replay "$number" --db history.db 2>/dev/null | sed -n 's/^command *//p' >replay_command
expect 1 bash replay_command
says 'still fails' err

# Mended: the same property holds by now.
printf '#!/bin/sh\nexit 0\n' >property_tests/property_sample
expect 0 ./sipplab property replay "$id" --db history.db
says 'property  holds by now'
# Its program is gone: a planning case is judged by its plan, others by nobody.
rm property_tests/property_sample
expect 0 ./sipplab property replay "$id" --db history.db
says 'not run'
expect 3 ./sipplab property replay "$number" --db history.db

# What a user gets wrong.
refused() {
  local words=$1
  shift
  expect 2 ./sipplab property "$@" --db history.db
  says "$words" err
  equal "$(wc -l <err)" 1 "lines on stderr of: $*"
}
refused 'missing.log' record missing.log
printf '{"uuid": 1}\n' >wrong.log
refused 'wrong.log:1: "uuid"' record wrong.log
: >empty.log
refused 'no property run' record empty.log
refused 'no property run 99' show 99
refused 'expected the id' show first
refused 'expected one that failed' replay "$held"
refused 'planned no case' replay "$number" --svg number.svg
equal "$(ask 'SELECT count(*) FROM property_run')" 10 "rows after bad input"

[ "$broken" -eq 0 ] && echo "all promises kept"
exit "$((broken > 0))"
