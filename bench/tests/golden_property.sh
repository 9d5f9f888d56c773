#!/usr/bin/env bash
# A property that fails is logged, recorded, listed, shown and tried again. Prints one
# line per promise that is broken.
#
#   golden_property.sh PATH_OF_SIPPLAB PATH_OF_PROPERTIES
properties=$(realpath "$2")
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
# As in a build folder: sipplab, and the program of the properties below it.
install -m 755 "$sipplab" sipplab
install -D -m 755 "$properties" property_tests/properties
unset RC_PARAMS SIPPLAB_ONE_CASE_OF SIPPLAB_PROPERTY_LOG

# prints TEXT [FILE]: the text as it stands, not a pattern.
prints() { grep -qF -- "$1" "${2:-out}" || complain "no '$1' in ${2:-out}: $(head -c 600 "${2:-out}")"; }
ask() { sqlite3 history.db "$1"; }

# The log: two lines for each property, its beginning and its end, appended.
runs 1 env RC_PARAMS=seed=7 SIPPLAB_PROPERTY_LOG=log property_tests/properties sample
prints 'classes: even' err
prints 'RC_PARAMS="reproduce=' err
equal "$(grep -c '"started"' log) $(wc -l <log)" "5 10" "lines of the log"
runs 1 env RC_PARAMS=seed=8 SIPPLAB_PROPERTY_LOG=log property_tests/properties sample
equal "$(wc -l <log)" 20 "lines of the log after two runs"
runs 1 property_tests/properties sample
equal "$(wc -l <log)" 20 "lines of the log after a run without one"
runs 2 env RC_PARAMS=max_success=many property_tests/properties sample
runs 2 env RC_PARAMS='seed=7 max_sucess=9' property_tests/properties sample
prints "RC_PARAMS: unknown key 'max_sucess', expected such as" err
runs 1 env SIPPLAB_ONE_CASE_OF=10 property_tests/properties sample
prints 'passed: 100 cases' err
runs 2 env SIPPLAB_ONE_CASE_OF=0 property_tests/properties sample
prints "SIPPLAB_ONE_CASE_OF: '0', expected a number from 1 on" err
runs 2 property_tests/properties
runs 3 property_tests/properties no_such_room
prints 'expected one of any_angle_search' err

runs 1 ./sipplab property totals log
prints '10 property runs'
prints '6 failed, 2 gave up, 0 crashed'

# The history.
runs 0 ./sipplab property record log --db history.db
prints '10 recorded in history.db, 0 there already'
runs 0 ./sipplab property record log --db history.db --json
prints '"known": 10'
equal "$(ask 'SELECT count(*) FROM property_run')" 10 "rows after recording twice"
equal "$(ask 'SELECT group_concat(DISTINCT seed) FROM (SELECT seed FROM v_property_runs ORDER BY seed)')" "7,8" "seeds"
equal "$(ask "SELECT cases, discards, shrinks FROM v_property_latest WHERE title = 'every number is odd or even'")" "1000|0|0" "a property that held"
equal "$(ask "SELECT cases, discards > 0 FROM v_property_latest WHERE status = 'gave_up'")" "0|1" "a property that gave up"
equal "$(ask "SELECT count(*) FROM v_property_classes WHERE class = 'even' AND share BETWEEN 0.4 AND 0.6")" 2 "shares of a class"
# Shrunk to what a person can draw: two robots, and ten instead of any number.
equal "$(ask "SELECT max(case_robots), max(case_cells) <= 9 FROM property_run WHERE plan_case IS NOT NULL")" "2|1" "smallest cases"
equal "$(ask "SELECT count(*) FROM property_run WHERE counterexample LIKE '%' || char(10) || '10' || char(10)")" 2 "smallest numbers"

runs 0 ./sipplab property list --db history.db
equal "$(grep -c sample out)" 5 "properties listed"
runs 0 ./sipplab property list --db history.db --all --failed --format csv
equal "$(grep -c failed out)" 6 "failures listed"

# A program that is killed leaves what it was at, until the log says how that ended.
RC_PARAMS="seed=9 max_success=10000000" SIPPLAB_PROPERTY_LOG=killed.log property_tests/properties sample >out 2>err &
victim=$!
comes test -s killed.log || complain 'no line in the log while a property is tried'
kill -KILL "$victim"
code=0
wait "$victim" 2>/dev/null || code=$?
equal "$code" 137 'exit code of a program that is killed'
runs 0 ./sipplab property record killed.log --db killed.db
prints '1 crashed'
equal "$(sqlite3 killed.db 'SELECT status, title, cases FROM v_property_runs')" "crashed|every number is odd or even|0" "what was killed"
runs 0 ./sipplab property list --failed --db killed.db
prints 'crashed'
runs 0 ./sipplab property show 1 --db killed.db
prints 'RC_PARAMS="seed=9 max_success=10000000" properties sample'
runs 1 ./sipplab property totals killed.log
sed 's/"started"/"passed"/; s/"cases":0/"cases":7/' killed.log >ended.log
cat ended.log >>killed.log
runs 0 ./sipplab property record killed.log --db killed.db
equal "$(sqlite3 killed.db 'SELECT status, cases FROM v_property_runs')" "passed|7" "what had only seemed to be killed"

id=$(ask "SELECT id FROM v_property_latest WHERE title = 'a plan has one robot'")
noted=$(ask "SELECT id FROM v_property_latest WHERE title = 'a plan in 8 neighbours has one robot'")
number=$(ask "SELECT id FROM v_property_latest WHERE title = 'no number is larger than 9'")
held=$(ask "SELECT id FROM v_property_latest WHERE status = 'passed'")
runs 0 ./sipplab property show "$id" --db history.db
prints 'planned: 2 robots'
prints 'one_robot_at_most(plan_case)'
equal "$(ask "SELECT count(*) FROM property_run WHERE message NOT LIKE 'property_tests/samples/sample.cpp:%'")" 0 "messages that do not begin with a file from the root"
runs 0 ./sipplab property show --db history.db --json
prints '"status": "failed"'

# Again: the property still fails, though the plan is right.
runs 1 ./sipplab property replay "$id" --db history.db -o case.xml --svg case.svg
prints 'plan      the plan is valid'
prints 'property  still fails'
prints 'a plan has one robot' err
prints '</svg>' case.svg
runs 0 ./sipplab plan --instance case.xml
runs 1 ./sipplab property replay "$noted" --db history.db --json
prints 'connectedness 3'
prints '"property": "still fails"'
runs 1 ./sipplab property replay "$number" --db history.db
prints 'property  still fails'

# The command that it prints does what it says.
./sipplab property replay "$number" --db history.db 2>/dev/null | sed -n 's/^command *//p' >replay_command
runs 1 bash replay_command
prints 'still fails' err

# Mended: the same property holds now.
printf '#!/bin/sh\nexit 0\n' >property_tests/properties
runs 0 ./sipplab property replay "$id" --db history.db
prints 'property  holds now'
# Renamed: a room without it does not mend it.
printf '#!/bin/sh\nexec "%s" open_list\n' "$properties" >property_tests/properties
runs 3 ./sipplab property replay "$number" --db history.db
prints 'not run'
printf '#!/bin/sh\nexec "%s" no_such_room\n' "$properties" >property_tests/properties
runs 3 ./sipplab property replay "$number" --db history.db
prints 'not run'
# Its program is gone: nobody can say whether it holds, whatever becomes of the plan.
rm property_tests/properties
runs 3 ./sipplab property replay "$id" --db history.db
prints 'not run'
runs 3 ./sipplab property replay "$number" --db history.db

# What a user gets wrong.
refused() {
  local words=$1
  shift
  runs 2 ./sipplab property "$@" --db history.db
  prints "$words" err
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
