#!/usr/bin/env bash
# The same plan from every compiler: plans seeded instances and compares status and plan
# hash with golden_plans.txt, bit by bit.
#
#   golden_plans.sh PATH_OF_SIPPLAB            compare
#   golden_plans.sh PATH_OF_SIPPLAB --update   after a change of plans that was meant
set -euo pipefail
golden=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/golden_plans.txt
sipplab=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=99" UBSAN_OPTIONS="${UBSAN_OPTIONS:-}:exitcode=99"

# "MAP AGENTS SEED [FLAGS OF generate] | OPTIONS" in, the same with "| STATUS HASH" out.
plan_line() {
  local instance=$1 options=$2 map agents seed bodies code=0
  read -r map agents seed bodies <<<"$instance"
  read -ra bodies <<<"$bodies"
  read -ra options <<<"$options"
  "$sipplab" generate --map "$map" --agents "$agents" --seed "$seed" "${bodies[@]}" -o "$work/instance" >/dev/null
  "$sipplab" plan --instance "$work/instance/0.xml" "${options[@]}" --json >"$work/plan.json" || code=$?
  if [ "$code" -gt 1 ]; then
    printf '%s | %s | exit code %d\n' "$instance" "${options[*]}" "$code"
    return
  fi
  printf '%s | %s | %s %s\n' "$instance" "${options[*]}" "$(value status)" "$(value plan_hash)"
}
value() { sed -n "s/^  \"$1\": \"\\{0,1\\}\\([^\",]*\\)\"\\{0,1\\},\\{0,1\\}\$/\\1/p" "$work/plan.json"; }

grep '^#' "$golden" >"$work/now"
while IFS='|' read -r instance options _; do
  read -r instance <<<"$instance"
  plan_line "$instance" "$options" >>"$work/now"
done < <(grep -v '^#' "$golden")

if [ "${2:-}" = --update ]; then
  cp "$work/now" "$golden"
elif ! diff "$golden" "$work/now"; then
  echo "plans differ from golden_plans.txt; if that is meant: $0 $1 --update"
  exit 1
fi
