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
expect_out 'holds now'
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

# Two targets at a time, which break at one place; a reduction that never ends keeps what it has reached.
for target in first second; do
  mkdir sources/corpus/$target
  cat >programs/$target <<'ENGINE'
#!/usr/bin/env bash
for argument in "$@"; do case $argument in -artifact_prefix=*) prefix=${argument#*=} ;; esac; done
here=$(dirname "$0") own=$(basename "$0")
case $own in first) other=second ;; *) other=first ;; esac
: >"$here/began-$own"
for ((i = 0; i < 600; ++i)); do [ -e "$here/began-$other" ] && break || sleep 0.1; done
[ -e "$here/began-$other" ] && printf '0123456789' >"${prefix}crash-0"
exit 77
ENGINE
  cat >programs/replay_$target <<'REPLAY'
#!/usr/bin/env bash
if [ "$1" = --judge ]; then
  grep -q 5 "$2" || exit 0
  printf '%s\n' sanitizer heap-buffer-overflow "read_cell < $(basename "$0")" 'AddressSanitizer: heap-buffer-overflow' \
    '    #0 0x1 in read_cell(char) /src/planner/io/movingai.cpp:139:40'
  exit 1
fi
printf '5\\%%\n\x01'"'" >"$3"
sleep 98764
REPLAY
  chmod +x programs/$target programs/replay_$target
done
pair=("$sipplab" fuzz run --programs programs --sources sources --work work --target first --target second --workers 2)
expect_code 1 "${pair[@]}" --seconds 6
expect_sql '2|6' "SELECT count(*), max(length(minimal)) FROM finding WHERE target IN ('first', 'second')"
grep -qF 'movingai.cpp:139:40' err || fail 'no stack in the log'
again=$(sed -n "s/^  again: \\(printf .*\\) >input .*replay_first --judge input$/\\1/p" err)
expect_code 0 "$sipplab" findings list --format csv
first=$(sed -n 's/^\([0-9]*\),[a-z]*,first,.*/\1/p' out)
"$sipplab" findings show "$first" -o smallest >/dev/null
eval "$again" | cmp - smallest || fail "'$again' is not the smallest input"
place=$(sed -n 's/^\([0-9]*\),[a-z]*,\(first\|second\),.*/\1/p' out | head -n 1)
[ "$(grep -cE "^[0-9]+,[a-z]+,(first|second),sanitizer,heap-buffer-overflow,read_cell,$place," out)" -eq 2 ] ||
  { cat out >&2 && fail 'one place is not seen as one'; }
expect_code 1 "$sipplab" findings replay "$first" --programs programs
grep -qF 'movingai.cpp:139:40' err || fail 'a replay hides the report'

# What was found is recorded before it is made smaller: nothing is lost to a signal.
sqlite3 "$SIPPLAB_DB" "DELETE FROM finding_event; DELETE FROM finding WHERE target IN ('first', 'second')"
"${pair[@]}" --seconds 3600 >out 2>err &
campaign=$!
both() { [ "$(sqlite3 "$SIPPLAB_DB" "SELECT count(*) FROM finding WHERE target IN ('first', 'second')")" = 2 ]; }
for ((i = 0; i < 1200; ++i)); do both && break || sleep 0.1; done
kill -TERM "$campaign"
code=0
wait "$campaign" || code=$?
[ "$code" -eq 143 ] || { cat err >&2 && fail "exit code $code after a signal, expected 143"; }
expect_sql '2' "SELECT count(*) FROM finding WHERE target IN ('first', 'second')"
grep -q '^finding .* in .*/findings/' err || { cat err >&2 && fail 'a signal left no file of a finding'; }

# The programs of another build beside this one are found.
mkdir -p builds/release builds/fuzz
ln -s "$sipplab" builds/release/sipplab
ln -s "$folder/programs" builds/fuzz/fuzz
expect_code 1 builds/release/sipplab findings replay --all
expect_out 'still breaks'
grep -q 'not run' out && fail 'programs of another build are not found'
mv builds/fuzz builds/elsewhere
expect_code 3 builds/release/sipplab findings replay --all
expect_out 'not run: no replay_first in'

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
