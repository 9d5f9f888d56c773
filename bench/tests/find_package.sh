#!/usr/bin/env bash
# The library as another project uses it: installs into an empty folder, then builds and
# runs the example, which finds it by find_package(sipplab).
#
#   find_package.sh BUILD_FOLDER CXX_COMPILER
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }; }
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
flags=$(cached SIPPLAB_SANITIZE)

quietly cmake --install "$build" --prefix "$work/prefix"
# The same build tool: a fresh machine has no other.
quietly cmake -S "$work/prefix/share/doc/sipplab/example" -B "$work/build" -G "$(cached CMAKE_GENERATOR)" \
  -DCMAKE_CXX_COMPILER="$2" -DCMAKE_PREFIX_PATH="$work/prefix" ${flags:+-DCMAKE_CXX_FLAGS=-fsanitize=$flags}
quietly cmake --build "$work/build"
"$work/build/example"

# The manual page has every command, flag and line of text that --help has; the completion offers the first two.
program=$work/prefix/bin/sipplab
gzip -dc "$work/prefix/share/man/man1/sipplab.1.gz" | tr -d '\\' >"$work/manual"
# No pipe into grep -q: it ends at the first match, and what still writes then fails.
offers() { # WORD WORDS...: whether completion of the words offers the first
  local word=$1
  shift
  COMP_WORDS=(sipplab "$@") COMP_CWORD=$# COMPREPLY=()
  _sipplab
  [[ " ${COMPREPLY[*]} " == *" $word "* ]]
}
# shellcheck disable=SC1091 # made by the build
source "$work/prefix/share/bash-completion/completions/sipplab"
commands=$("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]\{1,\}\) .*/\1/p')
[ "$(wc -l <<<"$commands")" -ge 15 ] || { echo "commands of --help: $commands" && exit 1; }
for command in $commands; do
  grep -q "^.SS $command" "$work/manual" || { echo "the manual lacks $command" && exit 1; }
  offers "$command" "$command" || { echo "$command is not completed" && exit 1; }
  while IFS= read -r line; do
    grep -qF -- "$line" "$work/manual" || { echo "the manual lacks a line of $command: $line" && exit 1; }
  done < <("$program" "$command" --help | grep -vE '^( |$|Usage:|[A-Z][A-Za-z ]*:$)')
  for flag in $("$program" "$command" --help | grep -o '^  [^ ].*' | grep -o -- '--[a-z][a-z-]*' | sort -u); do
    grep -q -- "$flag" "$work/manual" || { echo "the manual lacks $command $flag" && exit 1; }
    case $flag in
      --no-*) ;; # the opposite of a flag that is offered
      *) offers "$flag" "$command" "$flag" || { echo "$command $flag is not completed" && exit 1; } ;;
    esac
  done
done
echo 'manual and completion: all that --help has'
