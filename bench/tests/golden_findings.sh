#!/usr/bin/env bash
# A finding's whole life, with a target that is wrong on purpose and a small script in the
# engine's place: found, made smaller, drawn, recorded, seen again, fixed, regressed.
# usage: golden_findings.sh SIPPLAB REPLAY_PROGRAM
set -euo pipefail
sipplab=$(realpath "$1")
replay=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# A history of the test's own, and sqlite3 as it is without anybody's settings.
export HOME=/nowhere XDG_CONFIG_HOME=/nowhere
export SIPPLAB_DB=$folder/history.db
mkdir -p programs sources/corpus/planted_bug sources/corpus/quiet

fail() { printf 'FAILED: %s\n' "$1" >&2 && exit 1; }
expect_code() { # CODE COMMAND...
  local code=$1 got=0
  shift
  "$@" >out 2>err || got=$?
  [ "$got" -eq "$code" ] || { cat out err >&2 && fail "exit code $got of '$*', expected $code"; }
}
expect_out() { grep -qF -- "$1" out || { cat out err >&2 && fail "no '$1' in the output"; }; }
expect_sql() { # ANSWER SQL
  local answer
  answer=$(sqlite3 "$SIPPLAB_DB" "$2")
  [ "$answer" = "$1" ] || fail "'$answer' from '$2', expected '$1'"
}

# The engine: says what libFuzzer says, and leaves an input behind for the target that is wrong.
cat >programs/planted_bug <<'ENGINE'
#!/usr/bin/env bash
for argument in "$@"; do case $argument in -artifact_prefix=*) prefix=${argument#*=} ;; esac; done
{
  echo '#1024 pulse  cov: 500 ft: 900 corp: 12/340b lim: 80 exec/s: 512 rss: 40Mb'
  echo '#4096 DONE   cov: 559 ft: 1498 corp: 23/8671b lim: 80 exec/s: 2048 rss: 72Mb'
  echo 'stat::slowest_unit_time_sec:    0'
  echo 'stat::peak_rss_mb:              72'
} >&2
if [ "$(basename "$0")" = quiet ]; then exit 0; fi
cat >"${prefix}crash-0" <<'CASE'
.....
.@...
.....
robot 0 0 to 4 0 radius 0.25
robot 4 0 to 0 0 speed 2
robot 0 2 to 4 2
obstacle 2 2 radius 0.25 until 1 at 3 2
ssi 2.5
CASE
exit 77
ENGINE
chmod +x programs/planted_bug
cp programs/planted_bug programs/quiet
ln -s "$replay" programs/replay_planted_bug
ln -s "$replay" programs/replay_quiet
run=("$sipplab" fuzz run --programs programs --sources sources --work work --executions 10)

# Bad usage writes nothing.
expect_code 2 "$sipplab" fuzz run --programs nowhere --sources sources --executions 10
expect_code 2 "${run[@]}" --target unknown
expect_code 2 "$sipplab" fuzz run --programs programs --sources sources
[ ! -e "$SIPPLAB_DB" ] || fail 'bad usage made a history'

# Found, reduced to the least that breaks the claim, drawn.
expect_code 1 "${run[@]}" --json
python3 -m json.tool out >/dev/null 2>&1 || ! command -v python3 >/dev/null || fail 'no JSON document'
expect_sql 'planted_bug|findings|1|559|1498' 'SELECT target, status, crashes, edges, features FROM v_fuzz_runs WHERE crashes > 0'
expect_sql 'quiet|clean' "SELECT target, status FROM v_fuzz_runs WHERE target = 'quiet'"
expect_sql '2' "SELECT count(*) FROM fuzz_snapshot JOIN v_fuzz_runs ON id = fuzz_run_id WHERE target = 'quiet'"
expect_sql 'new|claim|result is whole|2|1' 'SELECT state, kind, claim, robots, times_found FROM finding'
expect_sql '1' 'SELECT cells <= 4 FROM finding'
grep -q '<svg' work/findings/1.svg || fail 'no picture of the finding'
grep -q '^robot' work/findings/1.case || fail 'no smallest case of the finding'

# Listed, shown, replayed from the database alone.
rm -rf work sources/corpus/quiet
expect_code 0 "$sipplab" findings list --open
expect_out 'result is whole'
expect_code 0 "$sipplab" findings show 1 -o minimal.case --svg it.svg
expect_out 'broken claim: result is whole: two robots and an obstacle'
"$replay" --judge minimal.case >/dev/null && fail 'the smallest input holds'
expect_code 1 "$sipplab" findings replay 1 --programs programs
expect_out 'still breaks'
expect_sql 'reproduced' 'SELECT state FROM finding'
expect_code 3 "$sipplab" findings replay 1 --programs nowhere
expect_code 2 "$sipplab" findings show 7
expect_code 2 "$sipplab" findings replay

# Fixed: the program holds. Then the bug is back, and the same finding comes up.
rm programs/replay_planted_bug
printf '#!/bin/sh\necho holds\n' >programs/replay_planted_bug
chmod +x programs/replay_planted_bug
expect_code 0 "$sipplab" findings replay --all --programs programs
expect_out 'holds by now'
expect_sql 'fixed' 'SELECT state FROM finding'
expect_code 0 "$sipplab" findings list --open
if grep -q 'result is whole' out; then fail 'a fixed finding is open'; fi
ln -sf "$replay" programs/replay_planted_bug
expect_code 1 "${run[@]}"
expect_sql 'regressed|2' 'SELECT state, times_found FROM finding'
expect_sql 'found reproduced fixed regressed' "SELECT group_concat(event, ' ') FROM (SELECT event FROM finding_event ORDER BY happened_utc)"

# A program that was fuzzed for a time without findings is left out; one that cannot run is said.
mkdir sources/corpus/quiet
expect_code 0 "${run[@]}" --target quiet --skip-known
grep -q 'skipped' err || fail 'a known program is not left out'
printf '#!/bin/sh\nexit 1\n' >programs/quiet
expect_code 3 "${run[@]}" --target quiet
expect_sql 'broken' "SELECT status FROM v_fuzz_runs WHERE target = 'quiet' ORDER BY id DESC LIMIT 1"

# The machine slept, or was busy: an input that alone is quick was no slow one.
mkdir sources/corpus/stalled
cat >programs/stalled <<'ENGINE'
#!/usr/bin/env bash
for argument in "$@"; do case $argument in -artifact_prefix=*) prefix=${argument#*=} ;; esac; done
printf '...\nrobot 0 0 to 2 0\n' >"${prefix}timeout-0"
exit 70
ENGINE
chmod +x programs/stalled
# replay_stalled COMMAND: judges as ever, after this.
replay_stalled() { printf '#!/bin/sh\n%s\nexec "%s" "$@"\n' "$1" "$replay" >programs/replay_stalled; }
replay_stalled 'sleep 3'
chmod +x programs/replay_stalled
expect_code 0 "${run[@]}" --target stalled
expect_sql 'clean|1' "SELECT status, timeouts FROM v_fuzz_runs WHERE target = 'stalled'"
expect_code 0 "${run[@]}" --target stalled --skip-known
if grep -q 'skipped' err; then fail 'a program that was not fuzzed to the end is left out'; fi
expect_sql '1' 'SELECT count(*) FROM finding'
# One that takes three seconds of processor time is slow, and no more than that can be said of it.
replay_stalled '[ -e spent ] || { : >spent; (ulimit -t 3 && while :; do :; done); }'
expect_code 1 "${run[@]}" --target stalled
expect_sql 'flaky|timeout' "SELECT kind, claim FROM finding WHERE target = 'stalled'"

# Coverage as llvm-cov sums it up.
cat >summary.json <<'JSON'
{"data": [{"files": [
  {"filename": "/src/planner/io/text.cpp", "summary": {"lines": {"count": 80, "covered": 72}}},
  {"filename": "/usr/include/fmt/core.h", "summary": {"lines": {"count": 900, "covered": 1}}}]}]}
JSON
expect_code 0 "$sipplab" fuzz coverage summary.json --format csv
expect_out 'planner/io,80,72,0.9'
expect_code 2 "$sipplab" fuzz coverage minimal.case
expect_sql 'ok' 'PRAGMA integrity_check'
expect_sql '' 'PRAGMA foreign_key_check'
echo 'findings: all as expected'
