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
refused 'usage' gate-trials --frobnicate
refused 'usage' slurm
refused '--dir, expected a value' slurm --dir
refused "--tasks 'x', expected a number" slurm --tasks x --suite smoke
refused "--missing '.*', expected a folder" slurm --missing no/such
refused "time 'x', expected" slurm --fuzz x
refused "--program 'no/such', expected a program" slurm --program no/such --suite smoke
refused "--seed 'x', expected a number" test-slurm --seed x
refused '--frobnicate, expected' test-slurm --frobnicate
[ -z "$(ls -A)" ] || { echo "BROKEN: something was written: $(ls -A)" && broken=1; }
[ "$broken" -eq 0 ] && echo 'scripts: bad arguments are refused'
exit "$broken"
