# What the golden tests of the command line share. They source it first: then $sipplab is the program that
# their first argument names, and the working folder, $work, is a scratch folder that vanishes with them.
set -uo pipefail
sipplab=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# A sanitizer's finding must not look like a negative verdict.
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=99" UBSAN_OPTIONS="${UBSAN_OPTIONS:-}:exitcode=99"
# What a user has set up must not decide: a history of his own, sqlite3's output, the order of sort.
unset SIPPLAB_DB
export HOME=/nowhere XDG_CONFIG_HOME=/nowhere LC_ALL=C

broken=0
complain() {
  printf 'BROKEN: %s\n' "$*"
  broken=$((broken + 1))
}

# runs CODE COMMAND...: its output goes into the files out and err.
runs() {
  local code=$1 got=0
  shift
  "$@" >out 2>err </dev/null || got=$?
  [ "$got" -eq "$code" ] || complain "exit code $got, not $code: $* ($(head -c 300 err) $(tail -n 1 out | head -c 300))"
}

# expect CODE ARGUMENTS...: the same for sipplab.
expect() {
  local code=$1
  shift
  runs "$code" "$sipplab" "$@"
}

# refused PATTERN ARGUMENTS...: exit code 2, one line on stderr that holds PATTERN,
# nothing on stdout.
refused() {
  local pattern=$1
  shift
  expect 2 "$@"
  [ "$(wc -l <err)" -eq 1 ] || complain "$(wc -l <err) lines on stderr, not 1: sipplab $* ($(head -c 300 err))"
  grep -qE -- "$pattern" err || complain "no '$pattern' in: $(head -c 300 err)"
  [ ! -s out ] || complain "something on stdout: sipplab $*"
}

# says PATTERN [FILE], equal GOT WANTED WHAT
says() { grep -qE -- "$1" "${2:-out}" || complain "no '$1' in ${2:-out}: $(head -c 500 "${2:-out}")"; }
equal() { [ "$1" = "$2" ] || complain "$3: '$1' is not '$2'"; }

# comes COMMAND...: whether it succeeds before long. What is waited for takes moments, and on a
# machine with other work longer; where it never comes, the test says so instead of hanging.
comes() {
  local end=$((SECONDS + 120))
  until "$@"; do
    [ "$SECONDS" -lt "$end" ] || return 1
    sleep 0.02
  done
}
