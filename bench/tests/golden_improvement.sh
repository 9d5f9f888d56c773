#!/usr/bin/env bash
# A golden run of what goes beyond the paper: ejection, longer start-safe intervals,
# improvement, --best, and a signal in the middle of it. Prints one line per promise that is
# broken.
#
#   golden_improvement.sh PATH_OF_SIPPLAB
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"

# value KEY FILE: of a JSON document with a key on a line of its own.
value() { sed -n "s/^  \"$1\": \"\\{0,1\\}\\([^\",]*\\)\"\\{0,1\\},\\{0,1\\}\$/\\1/p" "$2"; }
# less A B: as numbers.
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a < b) }'; }
# valid FILE: what the validator says of a JSON solution and the promise in it.
valid() {
  expect 0 validate --instance crowd/0.xml --solution "$1" --ssi "$(value ssi "$1")"
  says '^valid'
}

expect 0 generate --map empty:12x12 --agents 40 --count 1 --seed 5 -o crowd

# --- ejection: the trace tells who ejected whom ---------------------------------------

expect 1 plan --instance crowd/0.xml --ssi 3 --reschedule none
expect 0 plan --instance crowd/0.xml --ssi 3 --reschedule ejection
says '^ejected     by [0-9]+: [0-9]+'
expect 0 plan --instance crowd/0.xml --ssi 3 --reschedule ejection --json
cp out ejection.json
says '"ejections": \['
says '"failed": [0-9]+, "ejected": \[[0-9]+'
valid ejection.json
expect 1 plan --instance crowd/0.xml --ssi 3 --reschedule ejection --max-restarts 0
says '^status      limit'

# --- longer start-safe intervals ------------------------------------------------------

expect 0 plan --instance crowd/0.xml --ssi 0,3,7,9 --reschedule none --json
cp out escalated.json
equal "$(value ssi escalated.json) $(value tries escalated.json)" '7 3' 'the first interval that is enough'
valid escalated.json
refused "'5,x'|'x'" plan --instance crowd/0.xml --ssi 5,x
refused 'seconds > 0' plan --instance crowd/0.xml --improve 0
refused 'iterations > 0' plan --instance crowd/0.xml --improve 1.5i
refused 'flowtime, makespan' plan --instance crowd/0.xml --improve 5i --objective 0:0
refused 'objective.*--improve or --best' plan --instance crowd/0.xml --objective makespan
refused 'threads.*--improve or --best' bench --instances crowd --threads 2

# --- improvement ----------------------------------------------------------------------

improving=(plan --instance crowd/0.xml --ssi 3 --reschedule ejection --improve 300i)
expect 0 "${improving[@]}" --json
cp out improved.json
less "$(value flowtime improved.json)" "$(value flowtime ejection.json)" || complain "nothing was improved"
valid improved.json
says '"ssi_promise": true' improved.json
says '"lower_bound": \{"flowtime": [0-9.]+, "makespan": [0-9.]+\}, "gap"' improved.json
expect 0 "${improving[@]}" --json
equal "$(value plan_hash out)" "$(value plan_hash improved.json)" 'the same iterations, the same plan'
expect 0 "${improving[@]}"
says '^improved    [0-9]+ times in 300 iterations, for flowtime'
says '^lower bound [0-9.]+ s makespan, gap [0-9.]+ %'
expect 0 "${improving[@]}" --objective makespan --json
less "$(value makespan out)" "$(value makespan ejection.json)" || complain "the makespan was not improved"

# --- all of it ------------------------------------------------------------------------

expect 0 plan --instance crowd/0.xml --ssi 3 --best --improve 300i --time-limit inf --json
cp out best.json
valid best.json
says '"kind": "fallback", "ssi": 3, "status": "solved", "tries": 1, ' best.json
less "$(value flowtime best.json)" "$(value flowtime ejection.json)" || complain "the best plan is not better"
expect 0 plan --instance crowd/0.xml --ssi 3 --best --improve 300i --time-limit inf
says '^step        fallback, ssi 3: solved after 1 try, [0-9.]+ s; flowtime [0-9.]+, makespan '
says '^step        method, ssi 3: '
says '^curve       seconds'

# --- in a sweep -----------------------------------------------------------------------

ask() { sqlite3 curves.db "$1"; }
sweep=(bench --suite anytime --map empty:12x12 --robots 40 --count 1 --ssi 3 --db curves.db)
# Without a time limit: the iterations alone end it, on a machine with other work as well.
expect 0 "${sweep[@]}" --best --improve 100i --repetitions 2 --time-limit inf
equal "$(ask "SELECT planner, count(*), count(DISTINCT plan_hash), sum(valid) FROM v_results")" \
  'sipplab connectedness:3 best:yes improve:100i|2|1|2' 'two repetitions, one plan'
equal "$(ask 'SELECT count(*) FROM v_progress p JOIN v_progress q USING (run, case_id, position, repetition)
  WHERE q.step = p.step + 1 AND (q.flowtime_s > p.flowtime_s OR q.elapsed_s < p.elapsed_s
    OR q.flowtime_s < q.flowtime_bound_s)')" 0 'curves fall, and not below the bound'
equal "$(ask 'SELECT count(*) FROM (SELECT flowtime_s FROM v_progress GROUP BY repetition HAVING step = max(step))
  JOIN (SELECT DISTINCT flowtime_s FROM v_results) USING (flowtime_s)')" 2 'curves end at the plan'
equal "$(ask 'SELECT count(*), sum(abs(p.flowtime_bound_s - r.flowtime_bound_s) > 1e-9 OR abs(p.makespan_bound_s - r.makespan_bound_s) > 1e-9)
  FROM v_progress AS p JOIN v_results AS r USING (run, case_id, position, repetition)' | sed 's/^[1-9][0-9]*|/some|/')" 'some|0' \
  'the bounds of improvement are those of the instance'
equal "$(ask 'SELECT count(DISTINCT flowtime_s) FROM (SELECT flowtime_s FROM v_progress GROUP BY repetition HAVING step = min(step))')" 1 \
  'curves begin with the plan of LaCAM, the one that is improved'
# A run that is named is drawn though it is excluded, by any picture.
expect 0 plot improvement latest --db curves.db -o included.svg
named=$(ask 'SELECT uuid FROM run')
expect 0 runs --exclude "$named" --reason 'machine was busy' --db curves.db
refused 'no run yet' plot improvement --db curves.db
for picture in improvement success cactus; do
  expect 0 plot "$picture" "$named" --db curves.db -o "excluded-$picture.svg"
done
cmp -s included.svg excluded-improvement.svg || complain 'an excluded run is drawn otherwise'
expect 0 runs --include "$named" --db curves.db
expect 0 "${sweep[@]}" --no-best --improve 0.05s --objective makespan
equal "$(ask "SELECT limit_struck, status FROM v_results WHERE planner LIKE '% improve:0.05s objective:makespan'")" \
  'time|solved' 'the clock ended the improvement'

# --- a signal -------------------------------------------------------------------------

# A signal in the middle: the best plan so far, valid and in time. There is a plan after
# hundredths of a second of processor time, and the clock on the wall says nothing of that.
limit_s=600
"$sipplab" plan --instance crowd/0.xml --ssi 3 --best --time-limit "$limit_s" --json >interrupted.json 2>err &
planner=$!
# spent SECONDS: whether the planner had so much of the processors. Fields 14 and 15, counted from
# the end of the name, which may hold spaces.
spent() {
  local fields
  read -ra fields <<<"$(sed 's/.*) //' "/proc/$planner/stat")"
  [ $(((${fields[11]:-0} + ${fields[12]:-0}) / $(getconf CLK_TCK))) -ge "$1" ]
}
comes spent 2 || complain 'the planner does not get along'
kill -INT "$planner"
code=0
wait "$planner" || code=$?
equal "$code" 0 'exit code after a signal'
says 'ending with the best plan so far' err
says '"status": "solved"' interrupted.json
less "$(value planning_seconds interrupted.json)" "$limit_s" || complain "the signal was not heard"
# LaCAM's may be the best so far, which keeps starts safe for as long as it says.
expect 0 validate --instance crowd/0.xml --solution interrupted.json
says '^valid'

[ "$broken" -eq 0 ]
