#!/usr/bin/env bash
# A golden run of the commands around the history: trend, report, merge, import, doctor, shards,
# and every question of the cookbook. Prints one line per promise that is broken.
#
#   golden_history.sh PATH_OF_SIPPLAB PATH_OF_COOKBOOK
cookbook=$(realpath "$2")
. "$(dirname "${BASH_SOURCE[0]}")/golden_support.sh"
mkdir -p build/release
ln -s "$sipplab" build/release/sipplab
sipplab=$work/build/release/sipplab
ask() { sqlite3 "${2:-sipplab.db}" "$1"; }
sweep=(--suite smoke --robots 8 --ssi 0,3 --count 3)
bench() { expect 0 bench "${sweep[@]}" "$@"; }

# --- shards: the parts are the whole, and join up -----------------------------------------

# plannings_of_each_case: "plan/.../iterations:3/manual_time" of all shards summed up.
plannings_of_each_case() { sed -E 's|(.*)/iterations:([0-9]+)/manual_time|\1 \2|' | awk '{n[$1] += $2} END {for (c in n) print c, n[c]}' | sort; }
expect 0 bench --suite smoke --benchmark_list_tests
plannings_of_each_case <out >whole
: >parts
for shard in 1/3 2/3 3/3; do
  expect 0 bench --suite smoke --shard "$shard" --benchmark_list_tests
  cat out >>parts
done
cmp -s whole <(plannings_of_each_case <parts) || complain "three shards are not the suite"
expect 0 bench --suite smoke --robots 64 --ssi 5 --reschedule none --map empty:32x32 --order shortest --shard 3/3 --benchmark_list_tests
says '/iterations:1/' # one case of three instances over three shards
refused "'4/3', expected I/N" bench --shard 4/3
refused "no planning is left for it, expected at most 144 shards" bench --suite smoke --shard 999/999

# All of it by one process, to compare with; times apart the parts are to be the same.
outcomes="SELECT environment, robots, ssi_s, reschedule, initial_order, planner, instance_hash, position, repetition, status,
  makespan_s, flowtime_s, tries, expansions, plan_hash FROM v_results ORDER BY 1, 2, 3, 4, 5, 6, 7, 8, 9"
bench --db whole.db --repetitions 2
ask "$outcomes" whole.db >whole

bench --repetitions 2 --shard 1/2 --db a.db
bench --repetitions 2 --shard 2/2 --db b.db
refused 'expected --resume to go on with it, or --sweep' bench "${sweep[@]}" --repetitions 2 --shard 2/2 --db b.db
expect 0 merge a.db
equal "$(ask 'SELECT shard, status FROM v_sweeps')" "1/2|finished" "one part"
echo 'a letter' >text.db
expect 2 merge a.db text.db b.db
says '^2 files: 0 runs, [0-9]+ cells, [0-9]+ results'
says '^text.db: not a database, expected a sipplab history$' err
equal "$(ask 'SELECT count(*), shard, status, missing, attempts, machines FROM v_sweeps')" "1||finished|0|2|1" "the sweep of two parts"
ask "$outcomes" >merged
cmp -s whole merged || complain "two parts are not what one process makes"
expect 0 doctor
rm -f both.db*
bench --repetitions 2 --shard 2/2 --db both.db
bench --repetitions 2 --shard 1/2 --db both.db
says '0 of [0-9]+ plannings are there' err
equal "$(ask 'SELECT count(*), shard, status, missing, attempts FROM v_sweeps' both.db)" "1||finished|0|2" "two parts in one file"
# A repetition of the sweep has another name.
bench --repetitions 2 --shard 1/2 --sweep again --db both.db
equal "$(ask 'SELECT count(*) FROM v_sweeps' both.db)" 2 "sweeps after a repetition"
before=$(ask 'SELECT count(*) FROM result')
expect 0 merge b.db a.db --json
says '"added": \{\}'
equal "$(ask 'SELECT count(*) FROM result')" "$before" "results after merging again"
equal "$(ask 'SELECT group_concat(DISTINCT origin) FROM run')" "a.db" "origins"
# From a medium that cannot be written, where one can be mounted.
if unshare --mount --map-root-user true 2>/dev/null; then
  mkdir -p medium && cp a.db b.db whole.db medium
  runs 0 unshare --mount --map-root-user bash -c '
    mount --bind medium medium && mount -o remount,bind,ro medium && "$1" merge medium/a.db medium/b.db medium/whole.db --db fresh.db' _ "$sipplab"
  equal "$(ask 'SELECT group_concat(status) FROM v_sweeps' fresh.db)" "finished,finished" "sweeps from a read-only folder"
  : >medium/a.db-journal && printf 'half of a transaction' >medium/a.db-journal
  runs 2 unshare --mount --map-root-user bash -c '
    mount --bind medium medium && mount -o remount,bind,ro medium && "$1" merge medium/a.db --db other.db' _ "$sipplab"
  says 'a program that was killed left medium/a.db-journal' err
  rm -f fresh.db* other.db*
fi

# --- tasks of an array -----------------------------------------------------------------------

mkdir odd
refused 'odd/sweep.json: cannot be read' task run odd 1
echo '{}' >odd/sweep.json
refused 'not a plan of tasks' task collect odd --db none.db
[ ! -e none.db ] || complain 'a history was made by collecting nothing'
bench --plan-tasks tasks --tasks 5
says '^[0-9]+ plannings in 5 tasks'
for useless in --benchmark_list_tests=true --benchmark_out=all.json; do
  refused "runs no case.*${useless%%=*}" bench --suite smoke --plan-tasks useless "$useless"
done
refused 'seconds-per-task.*nan' bench --suite smoke --plan-tasks useless --seconds-per-task nan
[ ! -e useless ] && [ ! -e all.json ] || complain "a sweep that was refused left files"
refused 'holds a sweep' bench --suite smoke --plan-tasks tasks
refused 'no task: expected its number' task run tasks
refused "'6', expected a number from 1 to 5" task run tasks 6
expect 0 task missing tasks
equal "$(cat out)" "1-5" "missing tasks"
expect 1 task collect tasks --db collected.db
# Counted from 1 by one scheduler, from 0 by another.
runs 0 env SGE_TASK_ID=1 JOB_ID=17 "$sipplab" task run tasks
expect 0 task run tasks 0
runs 0 env SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_JOB_ID=9 SLURM_JOB_ID=11 SLURM_RESTART_COUNT=3 SIPPLAB_SUBMITTED=1 "$sipplab" task run tasks
equal "$(ask "SELECT scheduler, job, task, restarts, queued_s > 1e9, cores > 0 FROM v_attempts" tasks/2.db)" "slurm|9|2|3|1|1" "an attempt in Slurm"
equal "$(cat tasks/*.exit | sort -u)" 0 "exit codes"
expect 1 task collect tasks --db collected.db
says 'of tasks 3-4' err
expect 0 task missing tasks
equal "$(cat out)" "3-4" "missing tasks"
# A task that runs again does nothing.
expect 0 task run tasks 2
equal "$(ask 'SELECT count(*) FROM v_attempts' tasks/2.db)" 1 "attempts of a task that ran twice"
expect 0 task run tasks 3
expect 0 task run tasks 4
expect 0 task collect tasks --db collected.db --json
says '"missing": 0'
expect 0 task collect tasks --db collected.db
says '0 new'
equal "$(ask 'SELECT status, missing, attempts FROM v_sweeps' collected.db)" "finished|0|5" "the collected sweep"
equal "$(ask 'SELECT command_line FROM run' collected.db)" "sipplab bench ${sweep[*]}" "its command"
mkdir 'a folder'
bench --db 'a folder/one.db'
says "^next: .* show --db 'a folder/one.db' [0-9a-f]+, or .* runs --db 'a folder/one.db'$" err
bench --plan-tasks 'a folder/tasks'
says "sipplab task collect 'a folder/tasks'" err
cmp -s <(ask "$outcomes" collected.db) <(ask "$outcomes" 'a folder/one.db') || complain "five tasks are not what one process makes"
expect 0 doctor --db collected.db
# A task's disk that fills up, has room again, and cannot be written any more, where one can be mounted.
if unshare --mount --map-root-user true 2>/dev/null; then
  expect 0 bench --suite density --robots 2 --map empty:9x9 --count 2000 --max-restarts 0 --ssi 0 --reschedule none --plan-tasks small --tasks 2
  mkdir disk
  runs 0 unshare --mount --map-root-user bash -c '
    mount -t tmpfs -o size=450k none disk && cp small/sweep.json disk
    "$1" task run disk 1 >/dev/null 2>full; echo "$? $(cat disk/1.exit) $(grep -Evc "^(WARNING|\[)" full)"
    sqlite3 disk/1.db "PRAGMA integrity_check"
    "$1" task missing disk 2>&1
    mount -o remount,size=10m disk && "$1" task run disk 1 >/dev/null 2>&1; echo "$? $(cat disk/1.exit)"
    sqlite3 disk/1.db "SELECT count(*) FROM result"
    mount -o remount,ro disk; "$1" task run disk 2 >/dev/null 2>readonly; echo "$? $(grep -Evc "^(WARNING|\[)" readonly)"
    "$1" task collect disk --db small.db 2>&1 || true' _ "$sipplab"
  equal "$(grep -v '^run ' out)" "2 2 1
ok
2
task 1 failed by itself: exit code 2
0 0
1000
2 1
1000 plannings are missing; of tasks 2" "a disk that fills up"
  says '1000 of 2000 plannings, 1000 new, from 1 of 2 tasks'
  says 'disk/1.db: no space left while .*; what was committed before is kept' full
  says 'disk/2.db: .*expected' readonly
fi
# One that fails by itself is named, and not run again.
echo 70 >tasks/3.exit
expect 0 task missing tasks
equal "$(cat out)" "" "missing tasks"
says 'task 3 failed by itself: exit code 70' err
# Another program, or other instances, are kept out.
sed -i 's/"binary_hash": "[^"]*"/"binary_hash": "0123456789abcdef"/' tasks/sweep.json
refused 'was planned by another build' task run tasks 3
cmp -s <(ask "$outcomes" collected.db) <(expect 0 task collect tasks --db collected.db && ask "$outcomes" collected.db) || complain "a task that was refused changed results"

refused 'merged into itself' merge sipplab.db
refused 'none.db: no such file' merge none.db
refused 'none.db: no such file.*nothing is merged' merge a.db none.db b.db
: >empty.db
refused 'empty.db: an empty file' merge empty.db --db fresh.db
refused 'none.db: no such file' merge none.db --db fresh.db
[ ! -e fresh.db ] || complain "a history was made by merging nothing"

# --- a history of versions ---------------------------------------------------------------

rm -f sipplab.db*
# Both maps and all rules, with one set of options each.
sweep=(--suite smoke --robots 8,16 --ssi 0,3 --count 3 --any-angle --connectedness 2)
for _ in 1 2; do bench; done
equal "$(ask "SELECT count(*) > 0, sum(flowtime_bound_s IS NULL), sum(status = 'solved' AND flowtime_gap IS NULL), sum(cpu_time_s IS NULL),
  sum(flowtime_s < flowtime_bound_s - 1e-9), sum(makespan_s < makespan_bound_s - 1e-9) FROM v_results")" '1|0|0|0|0|0' \
  'bounds of every instance that was planned, below every cost; processor time of every planning'
# Ten more versions of the newest run, of which the last five solve one instance less, measured in some
# other order. Plain SQL, as a user would: the doctor has to notice that summaries are missing.
for version in 1 2 3 4 5 6 7 8 9 10; do
  ask "PRAGMA foreign_keys = ON;
    INSERT INTO commit_ (hash, committed_utc, subject, first_parent_hash, ancestor_count, first_parent_count)
      VALUES (printf('%02d%038d', $version, 0), printf('2031-01-%02dT00:00:00Z', $version), 'Version $version', '', 100000 + $version, 0);
    INSERT INTO run (uuid, suite, started_utc, ended_utc, status, commit_id, machine_id, build_id, branch, command_line,
                     options, seed, time_limit_s, writer)
      SELECT printf('00000000-0000-4000-8000-%012x', $version), suite, printf('2031-01-%02dT00:00:00.000Z', 10 + $version * 3 % 11),
             '2031-02-01T00:00:00.000Z', 'finished', (SELECT max(id) FROM commit_), machine_id, build_id, 'main', '', options,
             seed, time_limit_s, '' FROM run WHERE id = 2;
    INSERT INTO cell (run_id, case_id, finished_utc, result_count)
      SELECT (SELECT max(id) FROM run), case_id, finished_utc, result_count FROM cell WHERE run_id = 2;
    INSERT INTO result SELECT new.id, instance_id, position, repetition,
             iif($version > 5 AND position = 0, 1, status), planning_time_ns, makespan_s, flowtime_s, tries, expansions,
             generations, plan_hash, valid, violations, min_clearance_cells, peak_memory_bytes, limit_struck, message, made_by, ssi_kept_s, instructions, cpu_time_ns, attempt_id
      FROM cell AS old JOIN result ON result.cell_id = old.id
      JOIN cell AS new ON new.case_id = old.case_id AND new.run_id = (SELECT max(id) FROM run) WHERE old.run_id = 2;"
done
expect 1 doctor
says 'cells whose summary is missing'
says 'sipplab doctor --fix'
expect 0 doctor --fix --json
says '"fixed": true'
expect 0 doctor
says ': sound$'
expect 0 doctor --quick
refused 'no such file' doctor --db none.db

expect 0 trend success --case robots=8,ssi=3,environment=empty,reschedule=deterministic
says '▁'
says '^  0600000000\+? 2031-01-06 Version 6$'
says '^ .* 1 -> 0.6667 \(-33.3 points, worse\)'
equal "$(grep -cE '^[01][0-9]0{8}\+? ' out)" 10 "versions in the table"
grep -oE '^[01][0-9]0{8}\+? ' out | sort -c || complain "versions are not in the order of commits"
expect 0 trend success --svg trend.svg --json
says '"after": 0.666'
says '<path' trend.svg
says '</svg>' trend.svg
expect 0 trend success --svg trend.pdf
equal "$(head -c 5 trend.pdf)" '%PDF-' 'a picture of a trend that is called .pdf'
refused 'trend.png: no picture, expected a name that ends in .svg or .pdf' trend success --svg trend.png
[ ! -e trend.png ] || complain 'a picture of a trend that was refused'
expect 0 trend runtime --rows 3
expect 0 trend success --case 1 --min-effect 0.5
says 'no change of level'
expect 4 trend success --case robots=999
expect 4 trend property-cases
refused 'property-cases is not of a case' trend property-cases --suite smoke
refused "'speed', expected one of success" trend speed
refused "'density=3', expected the number of a case" trend success --case density=3
worst=00000000-0000-4000-8000-000000000006
expect 0 runs --exclude "$worst" --reason 'swapping' --json
says '"excluded": true'
expect 0 trend success --case robots=8,ssi=3,environment=empty,reschedule=deterministic
grep -q '^0600000000' out && complain "an excluded run is in the trend"
expect 0 runs --include "$worst"
refused 'is not excluded' runs --include "$worst"
expect 0 trend success --case robots=8,ssi=3,environment=empty,reschedule=deterministic
says '^0600000000'

expect 0 report 00000000-0000-4000-8000-000000000007 --base 00000000-0000-4000-8000-000000000001 -o report
says '^report/index.html$'
says '</html>' report/index.html
says 'Version 6' report/index.html
says '<td class="bad">lost</td>' report/index.html
grep -qE '(src|href)="?https?:|<script|@import|url\(' report/index.html && complain "the page asks for something from elsewhere"
[ "$(find report -name 'success-*.svg' | wc -l)" -ge 2 ] || complain "no success curves"
[ "$(find report -name 'runtime-*.svg' | wc -l)" -ge 2 ] || complain "no runtime curves"
if command -v xmllint >/dev/null; then
  xmllint --noout report/*.svg trend.svg 2>err || complain "SVG that is no XML: $(head -c 200 err)"
fi
refused 'expected latest, a UUID' report xyz -o report
# Two runs of one program: plans are equal, times are not, and no test judges those. Nothing is marked.
rm -rf one.db two
bench --db one.db
bench --db one.db
ask "UPDATE result SET planning_time_ns = planning_time_ns * 3 WHERE cell_id IN (SELECT id FROM cell WHERE run_id = 2)" one.db
expect 0 doctor --fix --db one.db
expect 0 report --db one.db -o two --json
says '"base"'
says 'same: all [0-9]+ plannings' two/index.html
sed -n '/id="base"/,/id="trends"/p' two/index.html >part
grep -nE 'class="[^"]*(bad|good)' part >marked && complain "something is marked between two runs of one program: $(head -3 marked)"
refused 'is a file|File exists|Not a directory|expected a folder' report --db one.db -o trend.svg/x

# --- imports -----------------------------------------------------------------------------

cat >report.json <<'JSON'
{"context": {"date": "2026-01-31T13:00:00+01:00", "host_name": "elsewhere", "executable": "./sort_bench", "num_cpus": 4,
             "library_build_type": "release"},
 "benchmarks": [
  {"name": "sort/8", "run_name": "sort/8", "run_type": "iteration", "repetition_index": 0, "iterations": 10,
   "real_time": 1.5, "cpu_time": 1.25, "time_unit": "us", "items_per_second": NaN, "items": 8},
  {"name": "sort/8", "run_name": "sort/8", "run_type": "iteration", "repetition_index": 1, "iterations": 10,
   "real_time": 2, "cpu_time": 2, "time_unit": "us", "items": -inf},
  {"name": "nan/inf \"quoted\"", "run_type": "iteration", "iterations": 0, "real_time": 0, "cpu_time": 0,
   "error_occurred": true, "error_message": "no input", "time_unit": "ns"},
  {"name": "on_gpu", "run_type": "iteration", "iterations": 0, "real_time": 0.0, "cpu_time": 0.0, "time_unit": "ns",
   "skipped": true, "skip_message": "no GPU here"},
  {"name": "sort/8_mean", "run_name": "sort/8", "run_type": "aggregate", "aggregate_name": "mean", "iterations": 2,
   "real_time": 1.75, "cpu_time": 1.6, "time_unit": "us"}]}
JSON
expect 0 import google-benchmark report.json --commit 0123456789abcdef --subject 'Sort faster'
says 'suite sort_bench, 4 measurements$'
expect 0 import google-benchmark report.json --commit 0123456789abcdef --json
says '"known": true'
equal "$(ask "SELECT group_concat(real_time_ns) FROM v_measurements WHERE benchmark = 'sort/8'")" 1500.0,2000.0 "imported times"
expect 0 trend benchmark-time
says '^sort/8, sort_bench, elsewhere release$'
says '0123456789  2026-01-31 +1.75 us +2 .*Sort faster'
equal "$(ask "SELECT error FROM v_measurements WHERE benchmark LIKE 'nan/inf%'")" "no input" "imported error"
equal "$(ask "SELECT error, real_time_ns IS NULL FROM v_measurements WHERE benchmark = 'on_gpu'")" \
  'skipped: no GPU here|1' "what was skipped took no time"
equal "$(ask "SELECT started_utc || counters FROM v_measurements WHERE benchmark = 'sort/8' AND repetition = 0")" \
  '2026-01-31T12:00:00.000Z{"items":8.0}' "imported time and counters"
for date in 2026-04-31T12:00:00+01:00 2026-01-31T25:00:00+01:00 2026-01-31T12:00:00+01:75 2026-01-31T12:00:00x01:00 yesterday; do
  sed "s/2026-01-31T13:00:00+01:00/$date/" report.json >dated.json
  refused '^dated.json:1: no date' import google-benchmark dated.json
done
sed 's/2026-01-31T13:00:00+01:00/2026-03-01T00:30:00Z/; s/elsewhere/in UTC/' report.json >dated.json
expect 0 import google-benchmark dated.json --commit 0123456789abcdef
equal "$(ask "SELECT DISTINCT v_measurements.started_utc FROM v_measurements JOIN run ON run.uuid = run WHERE host = 'in UTC'")" \
  '2026-03-01T00:30:00.000Z' "a date in UTC"
cat >aggregates.json <<'JSON'
{"context": {"date": "2020-06-09 17:58:05", "executable": "C:\\bench\\other.exe", "compiler": "gcc 14"}, "benchmarks": [
  {"name": "only/mean_mean", "run_name": "only/mean", "run_type": "aggregate", "aggregate_name": "mean", "threads": 4,
   "iterations": 2, "real_time": 1.75, "cpu_time": 1.6, "time_unit": "us", "label": "-O3"}]}
JSON
expect 0 import google-benchmark aggregates.json
equal "$(ask "SELECT suite, context, threads, label, aggregate FROM v_measurements WHERE benchmark = 'only/mean'")" \
  'other|compiler=gcc 14|4|-O3|mean' "what an imported measurement says of itself"
printf '{"context": {}\n, "benchmarks": [' >cut.json
refused '^cut.json:2: not JSON' import google-benchmark cut.json
echo '{"context": {}, "benchmarks": [{"name": "a", "real_time": 1e400}]}' >large.json
refused 'beyond those of 64 bits' import google-benchmark large.json
echo '{"a": 1}' >other.json
refused "no list 'benchmarks'" import google-benchmark other.json
refused 'cannot be read' import google-benchmark none.json
expect 0 doctor

# --- questions ---------------------------------------------------------------------------

expect 0 sql --list
says '^v_run_cells: '
expect 0 sql --list --json
views=$(ask "SELECT count(*) FROM sqlite_schema WHERE type = 'view'")
equal "$(grep -c '"view"' out)" "$views" "views listed"
# No view needs more than a plain shell.
for view in $(ask "SELECT name FROM sqlite_schema WHERE type = 'view'"); do
  ask "SELECT * FROM $view LIMIT 3" >/dev/null 2>err || complain "sqlite3 cannot read $view: $(head -c 200 err)"
done
expect 0 sql 'SELECT :x + 1 AS y, :run = (SELECT uuid FROM run WHERE uuid = :run) AS known' --param x=41 --json
says '"y": 42'
says '"known": 1'
refused 'no value for :x' sql 'SELECT :x'
refused 'parameter @x, expected one that begins with a colon' sql 'SELECT @x'
refused 'parameter y, expected one that stands as :y' sql 'SELECT 1' --param y=1
refused "expected NAME=VALUE" sql 'SELECT 1' --param y
refused 'no query' sql
printf -- '-- from a file\nSELECT 40 + :y AS from_file;\n' >q.sql
expect 0 sql --file q.sql --param y=2 --format csv
says '^42'
"$sipplab" sql --format csv <q.sql >out 2>err --param y=3 || complain "sql does not read standard input: $(cat err)"
says '^43'
"$sipplab" sql - --format csv <q.sql >out 2>err --param y=4 || complain "sql - does not read standard input: $(cat err)"
says '^44'
refused 'none.sql' sql --file none.sql
refused 'no query' sql --file /dev/null
# Who has seen enough goes away: no word about it, and the code of a program that a pipe ends.
"$sipplab" sql --format csv "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 300000) SELECT * FROM n" 2>err |
  head -1 >/dev/null
equal "${PIPESTATUS[0]}" 141 'exit code with a closed pipe'
equal "$(cat err)" '' 'words about a closed pipe'
# Several files are named, line by line: the reader has gone before the second.
mkfifo gone
exec 5<>gone 4>gone 5>&-
"$sipplab" report -o report 2>err >&4
equal "$?" 141 'exit code of several lines with a closed pipe'
equal "$(cat err)" '' 'words about several lines and a closed pipe'
exec 4>&-
refused 'too big while running the query' sql 'SELECT zeroblob(2000000000)'

# Every command of the cookbook answers, and with at least one row where this history has any.
questions=0
while IFS= read -r line; do
  questions=$((questions + 1))
  bash -c "$line" >out 2>err </dev/null || complain "the cookbook's '$line': $(head -c 300 err)"
  [[ $line == *property* || $line == *finding* || $line == *v_progress* || $line == *" plot "* ]] || [ "$(wc -l <out)" -gt 2 ] || complain "no answer: $line"
done < <(sed -n 's/^    \(build\/release\/sipplab .*\)/\1/p' "$cookbook")
[ "$questions" -ge 10 ] || complain "$questions questions in the cookbook, expected 10 or more"

# What compare can see of success is in points, as in its reports.
trials=("$(dirname "$cookbook")/../scripts/trials" compare --runs sipplab.db 00000000-0000-4000-8000-000000000001
  00000000-0000-4000-8000-000000000002 --build "$sipplab" --equal 0 --worse success 0.5 1 --worse flowtime 0.2 1)
runs 0 "${trials[@]}"
says '^success 0.5 .*, from [0-9.]+ points$'
says '^flowtime 0.2 .*, from [0-9.]+ %$'

# Failures are never fast: what takes means or quantiles of times, here or in the examples of the views, says the same
# however long failures took. Rows with a status beside are of single plannings.
cp sipplab.db failures.db
ask "UPDATE result SET planning_time_ns = planning_time_ns * 1024, cpu_time_ns = cpu_time_ns * 1024 WHERE status <> 0" failures.db
expect 0 doctor --fix --db failures.db
{
  sed -n 's/^    build\/release\/sipplab sql "\(.*\)"$/\1/p' "$cookbook"
  "$sipplab" sql --list | sed -n 's/^    SELECT/SELECT/p'
} | grep -v ' status,' >asked
[ "$(wc -l <asked)" -gt 40 ] || complain "$(wc -l <asked) questions about times, expected those of every view"
while IFS= read -r line; do
  expect 0 sql "$line" && cp out sooner
  expect 0 sql "$line" --db failures.db
  cmp -s sooner out || complain "times of failures are in the answer: $line"
done <asked

[ "$broken" -eq 0 ] && echo "history: everything as promised, $questions questions of the cookbook"
exit "$((broken > 0))"
