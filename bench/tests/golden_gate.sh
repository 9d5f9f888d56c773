#!/usr/bin/env bash
# The gate and the comparison of runs, as users meet them. $1: sipplab.
scripts=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../scripts")
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
install -m 755 "$sipplab" sipplab
sipplab=$work/sipplab
export TMPDIR=$work/temporary
mkdir "$TMPDIR"
unset SIPPLAB_INJECT_SLOWDOWN SIPPLAB_INJECT_CHANGE

ask() { sqlite3 gate.db "$1"; }

# --- gate -------------------------------------------------------------------------

# As short as it gets: what is tested is what it says, not how well it measures.
gate=(gate --base . --head ./sipplab --db gate.db --pair-seconds 0.01 --fewest-rounds 1 --timed-only --short-cells)

refused 'expected --base' gate --db gate.db
refused 'no program' gate --base nowhere --head . --db gate.db
refused 'suite' gate --base . --head . --suite paper --db gate.db
refused 'no --head' gate --calibrate --head . --db gate.db
refused 'has no verdict' gate --calibrate --junit junit.xml --db gate.db
printf '#!/bin/sh\nexit 0\n' >other && chmod +x other
refused 'head build.*does not serve the gate' gate --base . --head other --db gate.db
printf 'not a database, whatever its name says; long enough to be taken for one' >text.db
refused 'text.db' gate --base . --head . --db text.db

expect 0 gate --calibrate --comparisons 1 --pairs 6 --pair-seconds 0.01 --fewest-rounds 1 --timed-only --short-cells --db gate.db
says 'from 1 comparison of equal builds'
says '^sees: '
says '^of 2000 comparisons drawn from these pairs:$'
says '^  equal builds: [0-9.]+ % called regressed \(95 %: '

# The same program and the same plans: whatever the clock says, it is noise.
expect 0 "${gate[@]}" --pairs 6 --json
says '"verdict": "equivalent"'
says '"calibrations": 1'
says '"differing": 0'

# A history that takes no verdict: it is said all the same.
cp gate.db full.db
sqlite3 full.db "CREATE TRIGGER full BEFORE INSERT ON gate_run BEGIN SELECT RAISE(ABORT, 'no room'); END"
refused_after_all() { "$sipplab" "$@" >out 2>err && complain "exit code 0 though nothing was recorded"; }
refused_after_all gate --base . --head ./sipplab --db full.db --pair-seconds 0.01 --fewest-rounds 1 --timed-only --short-cells --pairs 6 --json --junit full.xml
says '"verdict": "equivalent"'
says '"gate_run": ""'
says 'no room' err
[ -s full.xml ] || complain "no JUnit file where the history took no verdict"

# A slowdown that no noise hides; only the head is given it. Processor time beside six compilers was
# 0.98 to 1.00 slower; the bound of 0.8 tells that from its logarithm, 0.69.
SIPPLAB_INJECT_SLOWDOWN=1 expect 1 "${gate[@]}" --treat-as-different --pairs 8 --format markdown --junit gate.xml
says '^\*\*REGRESSED: [0-9.]+ % slower \(95 %: [0-9.]+ to [0-9.]+\), most of all .* cells are like that\); .*plans unchanged; flowtime \+0.0 %.*\*\*$'
equal "$(head -n 1 out | cut -c 1-12)" '**REGRESSED:' "the first line"
says '^\| all cells \|'
says '<failure message="[0-9.]* % slower' gate.xml
equal "$(ask 'SELECT injected_slowdown, verdict, slowdown > 0.8 FROM v_gate_runs ORDER BY started_utc DESC LIMIT 1')" "1.0|regressed|1" "the comparison in the history"
equal "$(ask 'SELECT count(DISTINCT pairs) > 0, min(pairs) FROM v_gate_cells WHERE gate_run = (SELECT gate_run FROM v_gate_runs ORDER BY started_utc DESC LIMIT 1)')" "1|16" "pairs in the history, fresh ones included"

# One instance planned otherwise: found, named, and planned again by the command that is printed.
# It is changed, not regressed, and fails unless somebody expects it; whether it is worse one instance cannot tell.
SIPPLAB_INJECT_CHANGE=1 expect 5 "${gate[@]}" --pairs 6 --tolerance 10 --junit changed.xml
says '<testcase classname="sipplab gate" name="empty:32x32, 32 robots"><failure message=' changed.xml
says '<testcase classname="sipplab gate" name="verdict"><failure message=' changed.xml
says '^INCONCLUSIVE: flowtime \+[0-9.]+ % .*, which may be chance \(sees .*\); 1 of 8 plannings changed; '
says '^plan: empty:32x32 agents:32 seed:1 index:1$'
flowtime=$(sed -n 's/.*base: plan .*flowtime //p' out | head -n 1)
again=$(sed -n 's/^ *again: //p' out | head -n 1)
PATH=$work:$PATH bash -c "$again" >replayed 2>&1 || complain "the printed command fails: $again"
# The gate prints two digits behind the point, plan three.
awk -v expected="$flowtime" '$1 == "flowtime" { off = $2 - expected; found = off < 0.006 && off > -0.006 } END { exit !found }' replayed ||
  complain "no flowtime $flowtime in: $(head -c 500 replayed)"
SIPPLAB_INJECT_CHANGE=1 expect 3 "${gate[@]}" --pairs 6 --expect-changes --tolerance 10
says '1 of 8 plannings changed, as expected'
SIPPLAB_INJECT_CHANGE=1 expect 0 "${gate[@]}" --pairs 6 --expect-changes --floor quality=5 --tolerance 10 --junit changed.xml
says 'failures="0"' changed.xml
says '^CHANGED: 1 of 8 plannings changed, as expected; no slowdown'
equal "$(ask "SELECT DISTINCT instance FROM v_gate_differences WHERE what = 'plan'")" "empty:32x32 agents:32 seed:1 index:1" "the instance in the history"

[ -z "$(ls "$TMPDIR")" ] || complain "the gate left files: $(ls "$TMPDIR")"

# --- compare ----------------------------------------------------------------------

sweep=(bench --suite smoke --map warehouse --robots 16 --ssi "0,5" --reschedule "none,deterministic" --order shortest --any-angle --connectedness 2 --count 4 --db gate.db)
expect 0 "${sweep[@]}"
expect 0 "${sweep[@]}"
runs=$(ask "SELECT uuid FROM run WHERE kind = 'sweep' ORDER BY id")
base=$(head -n 1 <<<"$runs")
head=$(tail -n 1 <<<"$runs")
expect 0 compare "$base" latest --db gate.db
says '^SAME: all 16 plannings gave the same'
says '^base run '
expect 0 compare "run:$base" "run:$head" --db gate.db --format markdown
equal "$(head -n 1 out)" '**SAME: all 16 plannings gave the same status, plan and work**' "the first line"

# Whatever the clock said of two runs of one program, the page gives no colour to chance.
expect 0 report "$head" --base "$base" --db gate.db -o page
says 'same: all 16 plannings gave the same' page/index.html
grep -qE '"n (bad|good)"' page/index.html && complain "a colour in the comparison of two equal runs"

# A run that lost one instance and found another plan for a second one.
sqlite3 gate.db "
  UPDATE result SET status = 1, makespan_s = NULL, flowtime_s = NULL, plan_hash = NULL, valid = NULL
  WHERE position = 1 AND status = 0 AND cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id JOIN case_ ON case_.id = case_id
    WHERE uuid = '$head' AND ssi_s = 5 AND reschedule = 'none');
  UPDATE result SET plan_hash = 1
  WHERE position = 0 AND status = 0 AND cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id JOIN case_ ON case_.id = case_id
    WHERE uuid = '$head' AND ssi_s = 5 AND reschedule = 'none');"
expect 3 compare "${base:0:8}" "${head:0:8}" --db gate.db --junit compare.xml
says '^lost: warehouse agents:16 seed:1 index:1$'
says '^  head: failed$'
says '^plan: warehouse agents:16 seed:1 index:0'
says '^INCONCLUSIVE: success .* points: 1 of 16 plannings lost, 0 gained, p = 1, which may be chance \(sees nothing with so few\)'
says '<skipped' compare.xml
expect 0 report "$head" --base "$base" --db gate.db -o page
says '<td class="bad">lost</td><td>warehouse, 16 robots, ssi 5, none</td>' page/index.html
expect 5 compare "$base" "$head" --db gate.db --exact --json --junit compare.xml
says '<testcase classname="sipplab compare" name="verdict"><failure message=' compare.xml
says '"verdict": "inconclusive"'
python3 -c 'import json; json.load(open("out"))' 2>/dev/null || ! command -v python3 >/dev/null || complain "compare's JSON does not parse"

# Worse plans in every cell: seen over all of them, whatever is expected. Twice the instructions as well.
again=(bench --suite smoke --map warehouse --robots 16 --ssi "0,5" --reschedule "none,deterministic" --order shortest --any-angle --connectedness 2 --count 12)
expect 0 "${again[@]}" --db plans.db
expect 0 "${again[@]}" --db plans.db
plans() { sqlite3 plans.db "SELECT uuid FROM run ORDER BY id LIMIT 1 OFFSET $1"; }
sqlite3 plans.db "UPDATE result SET instructions = 1000 + position;
  UPDATE result SET instructions = 2 * instructions WHERE cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id WHERE uuid = '$(plans 1)')"
expect 1 compare "$(plans 0)" "$(plans 1)" --db plans.db
says '^REGRESSED: instructions \+100.0 % \(95 %: \+100.0 to \+100.0\); plans unchanged; flowtime \+0.0 %$'
sqlite3 plans.db "UPDATE result SET instructions = 1000"
# One instance of twelve takes twice the expansions, with the same plans: that may be chance, and is not the same.
of_one="WHERE position = 3 AND cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id WHERE uuid = '$(plans 1)')"
sqlite3 plans.db "UPDATE result SET expansions = 2 * expansions $of_one"
expect 3 compare "$(plans 0)" "$(plans 1)" --db plans.db
says '^INCONCLUSIVE: expansions \+5.9 % .*, which may be chance \(sees .*\); plans unchanged, other work in [1-4] of 48; '
expect 0 compare "$(plans 1)" "$(plans 0)" --db plans.db
says '^CHANGED: plans unchanged, other work in [1-4] of 48; expansions -5.6 % '
sqlite3 plans.db "UPDATE result SET expansions = expansions / 2 $of_one"
sqlite3 plans.db "UPDATE result SET plan_hash = 2 WHERE status = 0 AND position = 0 AND cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id WHERE uuid = '$(plans 1)')"
expect 0 compare "$(plans 0)" "$(plans 1)" --db plans.db
says '^CHANGED: [0-9]+ of 48 plannings changed; flowtime \+0.0 %'
expect 5 compare "$(plans 0)" "$(plans 1)" --db plans.db --exact
worse="WHERE status = 0 AND cell_id IN (SELECT cell.id FROM cell JOIN run ON run.id = run_id WHERE uuid = '$(plans 1)')"
sqlite3 plans.db "UPDATE result SET flowtime_s = 1.2 * flowtime_s, plan_hash = 2 $worse"
expect 1 compare "$(plans 0)" "$(plans 1)" --db plans.db
says '^REGRESSED: flowtime \+20.0 % \(95 %: \+20.0 to \+20.0\)'
expect 0 compare "$(plans 0)" "$(plans 1)" --db plans.db --floor quality=30
expect 0 report "$(plans 1)" --base "$(plans 0)" --db plans.db -o page
says '"n bad">\+20.0 %' page/index.html
# As certain, but less than matters: no colour.
sqlite3 plans.db "UPDATE result SET flowtime_s = 1.0005 * flowtime_s / 1.2 $worse"
expect 0 report "$(plans 1)" --base "$(plans 0)" --db plans.db -o page
grep -qE '"n (bad|good)"' page/index.html && complain "a colour for half of a thousandth"
sqlite3 plans.db "UPDATE result SET flowtime_s = 1.2 * flowtime_s / 1.0005 $worse"
expect 0 compare "$(plans 1)" "$(plans 0)" --db plans.db
says 'flowtime -16.7 %'
refused "'speed=1', expected one like success=1,quality=0.2" compare a b --floor speed=1
# The gate judges both runs beside its own plannings: worse plans fail, however they are expected.
expect 1 gate --base . --head ./sipplab --sweeps "$(plans 0)" "$(plans 1)" --pairs 6 --pair-seconds 0.01 --fewest-rounds 1 \
  --timed-only --short-cells --expect-changes --db plans.db --junit both.xml
says '^REGRESSED: flowtime'
says "^and [0-9]+ more: .SELECT \* FROM v_gate_differences., .sipplab compare $(plans 0 | cut -c 1-8) $(plans 1 | cut -c 1-8) --list.$"
says '<testcase classname="sipplab gate" name="warehouse, 16 robots, ssi 5, none"' both.xml
says '<testcase classname="sipplab gate" name="empty:32x32, 32 robots"' both.xml

# scripts/pull-request measures the noise of this machine unless it is known: calibrations of another machine and
# excluded ones are not it. What it starts is short here, but for the questions.
cat >asked <<'TEXT'
#!/bin/sh
case "$1" in
  gate) echo "$*" >>gates ;;
  bench) exec ./sipplab "$@" --robots 2 --map empty:8x8 --ssi 0 --reschedule none --order shortest ;;
  report) ;;
  *) exec ./sipplab "$@" ;;
esac
TEXT
sed -i "s|gates|$work/gates|; s|\./sipplab|$sipplab|" asked && chmod +x asked
pull_request() { # HISTORY: how many calibrations it asks for
  : >gates
  runs 0 "$scripts/pull-request" --programs ./asked ./asked --history "$1" --calibrate 1 --count 1 -o requested
  equal "$(grep -c -- --calibrate gates)" "$2" "calibrations asked for, where $3"
}
pull_request none.db 1 'there is no history'
pull_request gate.db 0 'the noise is known'
cp gate.db elsewhere.db && sqlite3 elsewhere.db "UPDATE machine SET fingerprint = 'another'"
pull_request elsewhere.db 1 'another machine measured its noise'
cp gate.db excluded.db
expect 0 runs --exclude "$(ask "SELECT gate_run FROM v_gate_runs WHERE kind = 'calibration'")" --reason busy --db excluded.db
pull_request excluded.db 1 'the calibration is excluded'

# Nothing in common, or nothing there.
expect 0 bench --suite smoke --map empty:8x8 --robots 2 --ssi 0 --reschedule none --order shortest --count 1 --db gate.db
expect 4 compare "$base" latest --db gate.db
says 'share no case' err
refused 'expected a run, a commit or a branch' compare "$base" no-such-branch --db gate.db
expect 0 runs --exclude "$head" --reason 'tampered with' --db gate.db
refused 'excluded' compare "$base" "$head" --db gate.db
refused 'nowhere.db' compare a b --db nowhere.db

[ "$broken" -eq 0 ] && echo "all promises kept"
exit "$((broken > 0))"
