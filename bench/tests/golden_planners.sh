#!/usr/bin/env bash
# A golden run of other planners in the sweep: right ones, and ones that hang, crash, lie or
# flood. Prints one line per promise that is broken.
#
#   golden_planners.sh PATH_OF_SIPPLAB
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
export sipplab
# The sanitizers' own memory is no planner's.
unlimited=(--memory-limit 1073741824)

# planner NAME: a program from stdin.
planner() { { echo '#!/bin/sh' && cat; } >"$1" && chmod +x "$1"; }
# sweeps NAME ARGUMENTS...: two instances of a robot or more through that planner. The suite has four sets of
# options for each, of which one will do after the first planner.
options=()
sweeps() {
  local name=$1
  shift
  expect 0 bench --suite smoke --map empty:9x9 --robots 4 --count 2 --ssi 3 --reschedule none --order shortest "${options[@]}" \
    --db planners.db --planner "cmd:$work/$name {instance} {scen} {out} {config}" "$@"
}
# row NAME COLUMNS: of the first instance.
row() { sqlite3 planners.db "SELECT $2 FROM v_results WHERE planner = 'cmd:$1' ORDER BY position LIMIT 1"; }
# Planners that hang sleep for about a day, each for a time that no other process on this machine,
# of another build's test for one, sleeps for.
export hangs=98761.$$ hangs_too=98762.$$ outlives=98763.$$
# running SECONDS, ended SECONDS: whether somebody, or nobody, sleeps for so long.
running() {
  local file words
  for file in /proc/[0-9]*/cmdline; do
    { mapfile -d '' -t words <"$file"; } 2>/dev/null || continue
    [ "${words[*]}" = "sleep $1" ] && return 0
  done
  return 1
}
ended() { ! running "$1"; }
# Nothing that a planner started is left, a moment after it was killed.
gone() { comes ended "$1" || complain "a process that a planner left behind is still there: sleep $1"; }
# That a sleeper was not waited for: minutes, on a machine with much other work, not a day.
minutes='planning_time_ns < 600000000000'
sleep 98760.$$ &
comes running 98760.$$ || complain 'the test does not see processes'
kill $!

planner honest <<'E2'
exec "$sipplab" plan --instance "$1" --config "$4" -o "$3"
E2
sweeps honest "${unlimited[@]}"
says 'empty:9x9 .* 2/2 '
equal "$(row honest 'status, valid, limit_struck IS NULL, planning_time_ns > 1000000, peak_memory_bytes > 1000000')" \
  'solved|1|1|1|1' 'an honest planner'
expect 0 bench --suite smoke --map empty:9x9 --robots 4 --count 2 --ssi 3 --reschedule none --order shortest --db planners.db
equal "$(sqlite3 planners.db "SELECT count(*), count(DISTINCT plan_hash) FROM v_results
    WHERE planner IN ('cmd:honest', 'sipplab')")" '4|2' 'its plans are the same'

options=(--any-angle --connectedness 2)

# From where one stands, by program or by script, and whatever TMPDIR is.
for command in './honest' 'sh ./honest' "sh ../$(basename "$work")/honest"; do
  TMPDIR=. expect 0 bench --suite smoke --map empty:9x9 --robots 4 --count 2 --ssi 3 --reschedule none --order shortest "${options[@]}" \
    --db "$work/planners.db" --planner "cmd:$command {instance} {scen} {out} {config}" --planner-name "by $command" "${unlimited[@]}"
  equal "$(sqlite3 planners.db "SELECT count(*), sum(status = 'solved') FROM v_results WHERE planner = 'cmd:by $command'")" '2|2' \
    "a planner called as $command"
done
TMPDIR=. expect 0 bench --suite smoke --map empty:9x9 --robots 4 --count 2 --ssi 3 --reschedule none --order shortest "${options[@]}" \
  --db "$work/named.db" --planner "cmd:sh ./honest {instance} {scen} {out} {config}" --json "${unlimited[@]}"
says '"cmd:honest"'
export TMPDIR=/nowhere/at/all
expect 2 bench --map empty:9x9 --robots 4 --count 2 --db planners.db --planner "cmd:$work/honest {instance} {scen} {out} {config}"
says '/nowhere/at/all: is no folder.*TMPDIR' err
unset TMPDIR

planner counts_on_sigpipe <<'E2'
[ $((0x$(awk '/SigIgn/ { print $2 }' /proc/self/status) & 0x1000)) -eq 0 ] || exit 3
"$sipplab" plan --instance "$1" -o "$3"
E2
sweeps counts_on_sigpipe "${unlimited[@]}"
equal "$(row counts_on_sigpipe 'status, message')" 'solved|' 'signals are as a shell has them'

planner exits_with_255 <<'E2'
"$sipplab" plan --instance "$1" -o "$3"
exit 255
E2
sweeps exits_with_255 "${unlimited[@]}"
equal "$(row exits_with_255 'status, valid')" 'solved|1' 'an exit code that is no signal'

planner exits_with_1 <<'E2'
"$sipplab" plan --instance "$1" -o "$3"
exit 1
E2
sweeps exits_with_1 "${unlimited[@]}"
equal "$(row exits_with_1 'status, valid')" 'solved|1' 'a plan counts, not the exit code'

planner names_its_file <<'E2'
exec "$sipplab" plan --instance "$1" -o "$(dirname "$3")/task_log.xml"
E2
sweeps names_its_file "${unlimited[@]}"
equal "$(row names_its_file 'status, valid')" 'solved|1' 'a file with another name is found'

# Straight paths at speed 1, in plain lines; the scenario has start and goal in columns 5 to 8.
planner straight <<'E2'
awk 'NF > 8 { printf "robot %d: (%d,%d,0) -> (%d,%d,%.6f)\n", n++, $5, $6, $7, $8, sqrt(($7-$5)^2+($8-$6)^2) }' "$2" >"$3"
E2
expect 0 bench --suite smoke --map empty:9x9 --robots 1 --count 3 --ssi 0 --reschedule none --order shortest "${options[@]}" \
  --db planners.db --planner "cmd:$work/straight {instance} {scen} {out}" --planner-name 'plain lines'
equal "$(sqlite3 planners.db "SELECT count(*), sum(valid) FROM v_results WHERE planner = 'cmd:plain lines'")" '3|3' \
  'plain lines, rounded to a millionth'
expect 0 bench --suite smoke --map empty:9x9 --robots 1 --count 3 --ssi 0 --reschedule none --order shortest "${options[@]}" \
  --db planners.db --planner "cmd:$work/straight {instance} {scen} {out}" --planner-name strict --rounding 1e-12
equal "$(sqlite3 planners.db "SELECT sum(valid) < 3 FROM v_results WHERE planner = 'cmd:strict'")" 1 \
  'no rounding is allowed'

planner liar <<'E2'
awk 'NF > 8 { printf "%d: (%d,%d,0) (%d,%d,0.5)\n", n++, $5, $6, $7, $8 }' "$2" >"$3"
E2
sweeps liar
equal "$(row liar "status, valid, message LIKE 'agent % takes %' OR message <> ''")" 'invalid|0|1' 'a claim of success'
says ' 0/2 .* 0\.00 '

planner nonsense <<'E2'
echo "0: I give up" >"$3"
E2
sweeps nonsense
equal "$(row nonsense "status, message LIKE 'solution:1: %'")" 'invalid|1' 'nonsense'

planner silent <<'E2'
echo "no idea" >&2
E2
sweeps silent
equal "$(row silent 'status, message')" "failed|left no solution, ended with exit code 0: 'no idea'" 'nothing'

planner crashes <<'E2'
echo "about to fall" && kill -SEGV $$
E2
sweeps crashes
equal "$(row crashes "status, message LIKE 'ended by signal 11 (Segmentation fault)%'")" 'failed|1' 'a crash'

planner hangs <<'E2'
trap '' TERM INT
sleep "$hangs" &
sleep "$hangs_too"
E2
sweeps hangs --time-limit 0.2
equal "$(row hangs "status, limit_struck, message, planning_time_ns >= 1200000000, $minutes")" \
  'limit|time|killed after 1.2 s|1|1' 'a planner that hangs'
gone "$hangs"
gone "$hangs_too"

planner leaves_a_child <<'E2'
sleep "$outlives" &
exec "$sipplab" plan --instance "$1" --config "$4" -o "$3"
E2
sweeps leaves_a_child "${unlimited[@]}"
equal "$(row leaves_a_child "status, $minutes")" 'solved|1' 'a child is not waited for'
gone "$outlives"

planner floods_memory <<'E2'
head -c 4000000000 /dev/zero | tail
E2
sweeps floods_memory --memory-limit 64
equal "$(row floods_memory "status, limit_struck, message LIKE 'killed with % MiB in memory', peak_memory_bytes > 67108864")" \
  'limit|memory|1|1' 'memory'

# Memory is what is held: 600 idle threads reserve gigabytes and hold little.
if cat >threads.c <<'E2' && cc -O1 -pthread threads.c -o many_threads 2>/dev/null; then
#include <pthread.h>
#include <unistd.h>
static void* idle(void* none) { sleep(1); return none; }
int main(void) {
  pthread_t threads[600];
  for (int i = 0; i < 600; ++i) if (pthread_create(&threads[i], 0, idle, 0)) return 3;
  for (int i = 0; i < 600; ++i) pthread_join(threads[i], 0);
  return 0;
}
E2
  planner threads <<'E2'
"$(dirname "$0")/many_threads" && exec "$sipplab" plan --instance "$1" --config "$4" -o "$3"
E2
  sweeps threads
  equal "$(row threads 'status, message')" 'solved|' 'threads that hold nothing'
fi

# Its own last words, not the shell's.
planner aborts <<'E2'
echo "what(): the map is too large"
kill -ABRT $$
E2
sweeps aborts
equal "$(row aborts message)" "ended by signal 6 (Aborted): 'what(): the map is too large'" 'last words'

# Giving up is no lie, and two files are two.
planner gives_up <<'E2'
: >"$3"
echo "no plan"
E2
sweeps gives_up
equal "$(row gives_up 'status, message')" "failed|solution is empty, ended with exit code 0: 'no plan'" 'an empty solution'
planner says_unsolved <<'E2'
printf 'agents=4\nsolved=0\nsolution=\n' >"$3"
E2
sweeps says_unsolved
equal "$(row says_unsolved 'status, message')" 'failed|solution says solved=0, ended with exit code 0' 'solved=0'
planner two_files <<'E2'
for name in plan.txt other.txt; do "$sipplab" plan --instance "$1" -o "$(dirname "$3")/$name"; done
E2
sweeps two_files
equal "$(row two_files 'status, message')" 'failed|left 2 new files, other.txt and plan.txt, expected one, or {out}' 'two files'

# Other options make another planner, of other programs as well.
expect 0 bench --suite smoke --map empty:9x9 --robots 2 --count 1 --ssi 3 --reschedule none --order shortest --weight 1,1.5 \
  --db planners.db --planner "cmd:$work/honest {instance} {scen} {out} {config}" --planner-name weighted "${unlimited[@]}"
equal "$(sqlite3 planners.db "SELECT group_concat(planner || '=' || weight, '; ') FROM
    (SELECT DISTINCT planner, weight FROM v_cases WHERE planner LIKE 'cmd:weighted%' AND any_angle ORDER BY weight)")" \
  'cmd:weighted=1.0; cmd:weighted weight:1.5=1.5' 'options of another planner'

# One name is one command.
cp honest other_honest
refused "cmd:honest is another command in run [0-9a-f]{8} .*expected --planner-name" bench --suite smoke --map empty:9x9 \
  --robots 4 --count 2 --ssi 3 --db planners.db --planner "cmd:$work/other_honest {instance} {scen} {out} {config}" --planner-name honest

# Two planners on the same instances are compared.
run_of() { sqlite3 planners.db "SELECT run FROM v_results WHERE planner = '$1' LIMIT 1"; }
expect 0 compare "$(run_of sipplab)" "$(run_of cmd:honest)" --db planners.db
says 'cmd:honest against sipplab'
says 'all 8 plannings'

planner floods_output <<'E2'
exec cat /dev/zero
E2
sweeps floods_output
equal "$(row floods_output "status, message LIKE 'ended by signal 25%'")" 'failed|1' 'a file without end'

refused "expected cmd:COMMAND" bench --planner "honest {task}"
refused "expected \{task\}, \{instance\} or \{scen\}" bench --planner "cmd:honest {map}"

# Plans in discrete time are judged with the earliest times for their paths, and kept as given beside that.
planner stepwise <<'E2'
exec "$sipplab" plan --task "$2" --method complete --format tracker -o "$3"
E2
sweeps stepwise --retime "${unlimited[@]}"
says 'empty:9x9 .* 2/2 '
equal "$(sqlite3 planners.db "SELECT count(*), sum(status = 'solved'), sum(unit_step_cost = given_flowtime_s),
    sum(flowtime_s > 0), sum(retime_s >= 0) FROM v_retimed WHERE planner = 'cmd:stepwise'")" '2|2|2|2|2' 'plans in unit steps'

# A planner of the table, by its name: one that jumps, and says how long it took.
planner leaper <<'E2'
while [ $# -gt 0 ]; do
  case "$1" in
    -o) printf 'runtime,solution cost,solver name\n0.5,7,leaper\n' >"$2" && shift ;;
    --outputPaths=*) printf 'Agent 0: (0,0)->(8,8)->\n' >"${1#*=}" ;;
  esac
  shift
done
E2
expect 0 bench --suite smoke --map empty:9x9 --robots 4 --count 2 --ssi 3 --reschedule none --order shortest "${options[@]}" \
  --db planners.db --planner "pbs:$work/leaper" --retime "${unlimited[@]}"
equal "$(row pbs 'status, valid')" 'invalid|0' 'a planner that jumps'
equal "$(row pbs "message LIKE 'solution:1: robot 0 %'")" 1 'what it did is said'
equal "$(sqlite3 planners.db "SELECT count(*) FROM v_retimed WHERE planner = 'cmd:pbs'")" 0 'nothing was re-timed'
refused 'pbs:, expected pbs:PATH, the path of the program' bench --planner pbs: --db planners.db
refused '/nowhere/pbs: no such file, expected a program' bench --planner pbs:/nowhere/pbs --db planners.db
expect 0 planners
says 'lacam3 .*LaCAM3'
says 'tracker '

# Planners side by side: this one, and one that is named; as a table and as a page.
mkdir paper
"$sipplab" generate --map empty:9x9 --agents 4 --count 2 --seed 5 -o paper >/dev/null
cat >fake_lacam <<'E2'
#!/bin/sh
for word; do last=$word; done
"$sipplab" plan --task "$4" --method complete --format tracker -o moves.csv && exec awk -v out="$last" '
  BEGIN { robots = 0 }
  FNR == NR { if (split($0, field, "\t") > 5) { x[robots] = field[5]; y[robots] = field[6]; ++robots } next }
  FNR > 1 { # a line for each robot: 3r2u, of which the first follows other columns
    robot = FNR - 2
    sub(/^[^"]*"/, robot == 0 ? "" : "&")
    gsub(/"/, "")
    way[robot, 0] = "(" x[robot] "," y[robot] "),"
    while (match($0, /^[0-9]*[a-z]/)) {
      run = RLENGTH > 1 ? substr($0, 1, RLENGTH - 1) : 1
      letter = substr($0, RLENGTH, 1)
      $0 = substr($0, RLENGTH + 1)
      for (; run > 0; --run) {
        x[robot] += (letter == "r") - (letter == "l")
        y[robot] += (letter == "u") - (letter == "d")
        way[robot, ++last[robot]] = "(" x[robot] "," y[robot] "),"
      }
    }
    if (last[robot] > steps) steps = last[robot]
  }
  END {
    printf "solved=1\nsolution=\n" >out
    for (step = 0; step <= steps; ++step) {
      printf "%d:", step >out
      for (robot = 0; robot < robots; ++robot) printf "%s", way[robot, step < last[robot] ? step : last[robot] + 0] >out
      printf "\n" >out
    }
  }' "$4" moves.csv
E2
chmod +x fake_lacam
expect 0 reproduce solvers --planner "lacam:$work/fake_lacam" --instances paper --no-suite --time-limit 30 --db side.db -o side
says '^[^ ]*paper +4 +cmd:lacam +2 +[0-2] +2 +0 +1 '
says '^[^ ]*paper +4 +sipplab'
[ -s side/index.html ] || complain 'no page of planners side by side'
grep -q '<td>cmd:lacam</td>' side/index.html || complain 'the page does not name the planner'
ls side/success-*.svg side/seconds-*.svg >/dev/null 2>&1 || complain 'no pictures of planners side by side'

# What another program says of its run is kept, under its own names.
planner talker <<'E2'
printf 'solved=1\nsoc_lb=3\nsolution=\n0:' >"$3"
awk -F'\t' 'NR > 1 { printf "(%d,%d),", $5, $6 }' "$2" >>"$3"
E2
sweeps talker --solution-format lacam "${unlimited[@]}"
equal "$(sqlite3 planners.db "SELECT count(*), min(name), min(value) FROM v_reported WHERE planner = 'cmd:talker'")" \
  '2|soc_lb|3.0' 'what a program says of its run'

# A scenario of MovingAI: our plan in unit steps, the best that is known, and a plan to begin with.
mkdir scenario
printf 'type octile\nheight 2\nwidth 5\nmap\n.....\n.....\n' >scenario/lane.map
printf 'version 1\n0\tlane.map\t5\t2\t0\t0\t4\t0\t4\n0\tlane.map\t5\t2\t4\t0\t0\t0\t4\n' >scenario/lane-random-7.scen
expect 0 plan --task scenario/lane-random-7.scen --method complete --format tracker
equal "$(head -n 2 out | tail -n 1 | cut -d, -f1-5)" 'lane,random,7,2,8' 'a row for MAPF-tracker'
cp out lane.csv
expect 1 plan --task scenario/lane-random-7.scen --format tracker --max-expansions 1
expect 0 bench --instances scenario --method complete --retime --db planners.db
printf 'map_name,scen_type,type_id,agents,lower_cost,solution_cost\nlane,random,7,2,8,9\nlane,random,7,2,7,12\n' >known.csv
expect 0 import tracker known.csv lane.csv --db planners.db
says 'known.csv: 2 best known costs'
equal "$(sqlite3 planners.db "SELECT lower_cost, solution_cost, planner, unit_step_cost >= 8,
    above_best_known = unit_step_cost - 9 FROM v_best_known")" '8|9|sipplab any-angle:no method:complete|1|1' 'the best that is known'
# All of it comes with a merge.
counts='SELECT (SELECT count(*) FROM v_retimed), (SELECT count(*) FROM v_reported), (SELECT count(*) FROM v_best_known)'
printf 'map_name,scen_type,type_id,agents,lower_cost,solution_cost\nlane,random,7,2,0,30\n' >worse.csv
expect 0 import tracker worse.csv --db merged.db
expect 0 merge planners.db --db merged.db
equal "$(sqlite3 merged.db "$counts")" "$(sqlite3 planners.db "$counts")" 'what is merged'
equal "$(sqlite3 merged.db 'SELECT lower_cost, solution_cost FROM best_known')" '8|9' 'the best of both histories'
expect 0 doctor --db merged.db
expect 0 retime --task scenario/lane-random-7.scen --solution lane.csv -o lane.json
says 'retimed +valid'
expect 0 retime --task scenario/lane-random-7.scen --solution lane.csv --format tracker
cmp -s out lane.csv || complain 'a plan of unit steps comes back otherwise from its re-timing'
expect 0 plan --task scenario/lane-random-7.scen --solution lane.csv --improve 50i --json
says '"status": "solved"'
flowtime() { sed -n 's/^  "flowtime": \([0-9.]*\),*$/\1/p' "$1"; }
awk -v now="$(flowtime out)" -v given="$(flowtime lane.json)" 'BEGIN { exit !(now > 0 && now < given) }' ||
  complain 'a plan in unit steps is not improved'
printf 'r\n4l\n' >broken.txt
refused 'invalid also with other times|not executable' plan --task scenario/lane-random-7.scen --solution broken.txt

if [ "$broken" -gt 0 ]; then
  printf '%d promises are broken\n' "$broken"
  exit 1
fi
