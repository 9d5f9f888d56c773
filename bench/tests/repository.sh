#!/usr/bin/env bash
# What is in the repository, and no more: nothing new at the top level, and each
# Markdown file begins with its title. Prints one line for each file that is not as it should be.
#
#   repository.sh FOLDER
set -uo pipefail
cd "$1" || exit 1
files=$(git ls-files 2>/dev/null)
if [ -z "$files" ]; then
  echo 'skipped: no checkout of git'
  exit 77
fi
broken=0
while read -r name; do
  case "$name" in
    CMakeLists.txt | CMakePresets.json | CHANGELOG.md | CONTRIBUTING.md | LICENSE | README.md | .*) ;;
    planner | bench | fuzz | property_tests | db | scripts) ;;
    *) echo "BROKEN: $name at the top level" && broken=1 ;;
  esac
done < <(cut -d/ -f1 <<<"$files" | sort -u)
while read -r name; do
  [ ! -f "$name" ] || head -n 1 "$name" | grep -q '^# [^ ]' || { echo "BROKEN: $name has no title" && broken=1; }
done < <(grep '\.md$' <<<"$files")
[ "$broken" -eq 0 ] && echo 'repository: everything in its place'
exit "$broken"
