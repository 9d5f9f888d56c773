#!/usr/bin/env bash
# What a user of the scripts gets wrong: one line that says what was expected, exit code 2, and
# nothing built, installed or written before it.
#
#   scripts.sh FOLDER
set -uo pipefail
scripts=$1/scripts
work=$(mktemp -d)
trap 'rm -rf "$work" "$work".{out,err}' EXIT
cd "$work" || exit 1
broken=0

refused() { # PATTERN SCRIPT ARGUMENTS...
  local pattern=$1 code=0
  shift
  local script=$1
  shift
  # A script that does not refuse would build for minutes; refusing takes moments, and longer on a busy machine.
  timeout 120 "$scripts/$script" "$@" >"$work.out" 2>"$work.err" || code=$?
  if [ "$code" -ne 2 ] || ! head -n 1 "$work.err" | grep -Eq -- "$pattern" || [ -s "$work.out" ]; then
    printf 'BROKEN: scripts/%s %s: exit code %d, "%s"\n' "$script" "$*" "$code" "$(head -n 1 "$work.err")"
    broken=1
  fi
}

refused 'usage' fuzz
refused 'usage' fuzz --frobnicate
refused "time 'x', expected" fuzz --for x
refused '--target, expected a value' fuzz --smoke --target
refused "--workers '0', expected a number" fuzz --nightly --workers 0
refused "--workers 'x', expected a number" fuzz --nightly --workers x
refused 'usage' nightly --frobnicate
refused "time '5', expected" nightly --fuzz-for 5
refused "--long 'soon', expected minutes" test --long soon
refused '--all --quick, expected one of them' test --quick --all
refused '--all, expected before the arguments of ctest' test -R property --all
refused 'HEAD~1 and HEAD, expected one of the two' pull-request HEAD~1 HEAD
refused 'usage' pull-request
refused '-o, expected a value' pull-request HEAD -o
refused 'expected a commit' pull-request no/such/commit -o here
refused "--programs 'no/such', expected two programs" pull-request --programs no/such /bin/true
refused 'expected one of the two' pull-request --programs /bin/true /bin/true HEAD
refused '-o, expected a folder' package -o
refused '-x, expected' package -x
refused "suite '/', expected a name" test-fresh /
refused '--frobnicate, expected' test-fresh --frobnicate
refused '--frobnicate, expected' pull-request --frobnicate HEAD
refused '--frobnicate, expected' trials gate --frobnicate
refused 'usage' trials
refused "--worse 'makespan', expected" trials compare --worse makespan 0.1 3
refused "build 'nothing', expected one of: expansions-count-to-165 " trials build nothing
refused 'build, expected one of' trials build
refused 'usage' bisect HEAD
refused 'expected a commit' bisect HEAD no/such/commit
refused "--calibrate 'x', expected" pull-request HEAD --calibrate x
refused "--count '0', expected a number" pull-request HEAD --count 0
refused "--inconclusive 'x', expected pass or fail" pull-request HEAD --inconclusive x
refused "--count 'x', expected a number" bisect HEAD~1 HEAD --count x
refused 'usage' slurm
refused '--dir, expected a value' slurm --dir
refused "--tasks 'x', expected a number" slurm --tasks x --suite smoke
refused "--missing '.*', expected a folder" slurm --missing no/such
refused "time 'x', expected" slurm --fuzz x
refused "--program 'no/such', expected a program" slurm --program no/such --suite smoke
refused "--seed 'x', expected a number" test-slurm --seed x
refused '--frobnicate, expected' test-slurm --frobnicate
# Planted changes follow the code that they change.
for patch in "$1"/bench/gate/planted/*.patch; do
  git -C "$1" apply --check "$patch" || { echo "BROKEN: $patch does not apply" && broken=1; }
done
[ -z "$(ls -A)" ] || { echo "BROKEN: something was written: $(ls -A)" && broken=1; }

# --- the judge of commits -----------------------------------------------------------

# A project of six commits whose builds are this script: what the gate answers of each is in the file `code`.
complain() { echo "BROKEN: $*" && broken=1; }
mkdir -p toy/scripts/support programs && cd toy || exit 1
cp "$scripts"/{pull-request,bisect} scripts/ && cp "$scripts/support/build_commit.sh" scripts/support/
printf '#!/bin/sh\n' >scripts/setup && chmod +x scripts/setup
cat >sipplab.sh <<'TEXT'
#!/bin/sh
case "$1" in
  bench) echo "$@" >>"$LOG" && printf '{\n  "run": "of %s"\n}\n' "$(cat "$(dirname "$0")/code")" ;;
  sql) printf 'count(*)\r\n0\r\n' ;;
  gate)
    echo "$@" >>"$LOG"
    [ "$2" != --calibrate ] || exit 0
    head=''
    while [ $# -gt 0 ]; do [ "$1" = --head ] && head=$2; shift; done
    code=$(cat "$(dirname "$head")/code")
    echo "**VERDICT $code**"
    exit "$code"
    ;;
esac
TEXT
cat >../programs/cmake <<'TEXT'
#!/bin/sh
case "$1 $2" in
  '--preset release') exit 0 ;;
esac
mkdir -p build/release && cp sipplab.sh build/release/sipplab && chmod +x build/release/sipplab && cp code build/release/code
[ "$(cat code)" -ne 9 ]
TEXT
chmod +x ../programs/cmake
export LOG=$work/log
git init -q . && printf 'build\n' >.gitignore
save() { git add -A && git -c user.name=t -c user.email=t@t commit -qm "$1"; }
n=0
for code in 0 5 9 3 0 1 1; do # equivalent, changed, broken, unclear, equivalent, worse, worse
  echo "$code" >code && echo "$((n += 1))" >number && save "number $n"
done
judge() { PATH=$work/programs:$PATH timeout 120 "$@" >"$work.out" 2>"$work.err"; }
judge scripts/bisect HEAD~6 HEAD || complain "bisect: exit code $?, $(tail -n 2 "$work.err" "$work.out")"
grep -q "$(git rev-parse HEAD~1) is the first bad commit" "$work.out" || complain "bisect did not name the first bad commit: $(tail -n 5 "$work.out")"
judge scripts/bisect --changed HEAD~6 HEAD~4 && grep -q "$(git rev-parse HEAD~5) is the first bad commit" "$work.out" ||
  complain "bisect --changed did not name the commit with other plans: $(tail -n 5 "$work.out")"
# What cannot be judged, because its folder cannot be made for example, is not worse.
rm -rf build/bisect/"$(git rev-parse HEAD~2)" && touch build/bisect/"$(git rev-parse HEAD~2)"
judge scripts/bisect HEAD~6 HEAD
sed '1,/could be any of/d' "$work.out" | grep -q "$(git rev-parse HEAD~1)" || complain 'bisect calls worse what was not judged'
[ "$(git status --porcelain)" = '' ] && [ "$(cat number)" -eq 7 ] || complain 'bisect changed the checkout'

# A build with a planted change, of the commit that is checked out, and kept for it.
mkdir -p bench/gate/planted && cp "$scripts/trials" scripts/
echo 7 >code && git diff code >bench/gate/planted/sevenfold.patch && git checkout -q code
git config commit.gpgsign true && git config gpg.program false # who signs commits need not sign these
for round in first second; do
  judge scripts/trials build sevenfold
  program=$(cat "$work.out")
  [ "$(cat "$(dirname "$program")/code")" = 7 ] || complain "trials build: $round build is '$program', $(tail -n 2 "$work.err")"
  grep -q '^' "$work.err" && [ "$round" = second ] && complain 'trials build: the same build is made twice'
done
sed -i 's/^+7/+8/' bench/gate/planted/sevenfold.patch && judge scripts/trials build sevenfold
[ "$(cat build/planted/sevenfold/build/release/code)" = 8 ] || complain 'trials build: an edited change is not built again'
[ "$(git -C build/planted/sevenfold log -1 --format=%s)" = 'Planted: sevenfold' ] || complain 'the planted change is no commit'
git config --unset commit.gpgsign && rm -rf bench scripts/trials

# Other plans fail until a commit says that they are expected; the base is built once.
git checkout -q HEAD~5
: >"$LOG"
judge scripts/pull-request HEAD~1
[ $? -eq 5 ] && ! grep -q -- --expect-changes "$LOG" || complain "pull-request: other plans that nobody expected"
grep -q 'Plans: changed' build/pull-request/summary.md || complain 'pull-request does not say how other plans are expected'
[ "$(head -n 1 build/pull-request/summary.md)" = '**VERDICT 5**' ] || complain 'the verdict is not the first line'
# More than a pipe holds follows the line, which is the first that git writes.
{ printf 'A long line\n\nPlans: ' && head -c 300000 /dev/zero | tr '\0' x; } >"$work/message"
git -c user.name=t -c user.email=t@t commit -q --allow-empty -F "$work/message"
git -c user.name=t -c user.email=t@t commit -q --allow-empty -m 'A note

Plans: changed'
judge scripts/pull-request HEAD~3
grep -q -- --expect-changes "$LOG" || complain 'pull-request did not see the line of the commit'
rm -f build/base/*/build/release/code # a build that is there is not made again
: >"$LOG" && judge scripts/pull-request HEAD~3 --expect-changes
grep -q -- --expect-changes "$LOG" || complain 'pull-request did not pass on what is expected'
[ -z "$(find build/base -name code -path '*release*')" ] || complain 'the base was built twice'
: >"$LOG" && judge scripts/pull-request HEAD~3 --calibrate 2
grep -q -- '--calibrate --comparisons 2' "$LOG" || complain 'pull-request did not measure the noise'
! grep ': line [0-9]*: \[' "$work.err" || complain 'pull-request compares what is no number'

# Enough instances to see a loss, unless another suite is asked for.
grep -q -- 'bench --suite smoke --count 20 ' "$LOG" || complain "pull-request plans too few instances: $(cat "$LOG")"
: >"$LOG" && judge scripts/pull-request HEAD~3 --suite density
! grep -q -- --count "$LOG" || complain "pull-request does not plan the suite as it is: $(cat "$LOG")"
: >"$LOG" && judge scripts/pull-request HEAD~3 --suite density --count 7
grep -q -- 'bench --suite density --count 7 ' "$LOG" || complain "pull-request does not plan as many: $(cat "$LOG")"

# What is inconclusive is what the caller makes of it.
git checkout -q -b unclear && echo 3 >code && save 'unclear'
for said in '3' '0 --inconclusive pass' '1 --inconclusive fail'; do
  code=${said%% *}
  # shellcheck disable=SC2086
  judge scripts/pull-request HEAD~3 ${said#"$code"}
  [ $? -eq "$code" ] || complain "pull-request, inconclusive, not $said: $(cat "$work.err")"
done
[ "$(head -n 1 build/pull-request/summary.md)" = '**VERDICT 3**' ] || complain 'what is inconclusive is not called so'
git checkout -q - 

# What landed on the base branch since is not the change's: the base is where the branch left it.
left=$(git rev-parse HEAD~3)
git branch change && git checkout -q "$left"
echo 1 >code && echo landed >number && save 'landed on the base branch, and said: Plans: changed'
git branch landed && git checkout -q change
: >"$LOG" && judge scripts/pull-request landed
grep -q -- "--base $PWD/build/base/$left/build/release/sipplab" "$LOG" ||
  complain "pull-request did not compare with where the branch left: $(cat "$LOG" "$work.err")"
[ ! -e "build/base/$(git rev-parse landed)" ] || complain 'pull-request built what it does not compare with'
grep -q "^scripts/pull-request: .* $left" "$work.err" || complain 'pull-request does not say with which commit it compares'
git checkout -q --orphan stranger && git rm -rq --cached . && git add -f number && save 'no common commit'
git checkout -qf change
judge scripts/pull-request stranger
[ $? -eq 2 ] && grep -q 'stranger and the checkout, expected' "$work.err" || complain "pull-request with a stranger: $(cat "$work.err")"
# A shallow clone, of which continuous integration likes to make its checkout, may lack that commit.
git clone -q --depth 1 --no-single-branch "file://$PWD" ../shallow && cd ../shallow || exit 1
judge scripts/pull-request origin/landed
[ $? -eq 2 ] && grep -q 'expected a clone with all commits' "$work.err" || complain "pull-request in a shallow clone: $(cat "$work.err")"
cd ../toy || exit 1

# --- packages -----------------------------------------------------------------------

# A machine that has everything, one library only for another architecture.
cat >../programs/dpkg-query <<'TEXT'
#!/bin/sh
for package in "$@"; do :; done
case "$package" in
  libyaml-cpp-dev) echo 'arm64 installed' ;;
  libgtest-dev) echo 'amd64 installed' && echo 'arm64 installed' ;;
  nlohmann-json3-dev) echo 'all installed' ;;
  *) echo 'amd64 installed' ;;
esac
TEXT
echo 'echo amd64' >../programs/dpkg
echo 'echo "$@" >>"$LOG"' >../programs/apt-get
echo 'echo "  Depends: clang-14"' >../programs/apt-cache
echo 'exec "$@"' >../programs/sudo
sed -i '1{/^#!/!s/^/#!\/bin\/sh\n/}' ../programs/* && chmod +x ../programs/*
: >"$LOG" && judge "$scripts/setup"
grep 'install ' "$LOG" | grep -q ' libyaml-cpp-dev' || complain "setup took a package of another architecture for ours: $(cat "$LOG" "$work.err")"
! grep -Eq 'libgtest|nlohmann|cmake' "$LOG" || complain "setup installs what is there: $(cat "$LOG")"

[ "$broken" -eq 0 ] && echo 'scripts: bad arguments are refused, commits are judged'
exit "$broken"
