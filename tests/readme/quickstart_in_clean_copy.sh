#!/usr/bin/env bash
# quickstart_in_clean_copy.sh SOURCE: what a stranger does first, from the files under version control alone.
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$1"
if git rev-parse --git-dir >/dev/null 2>&1; then git ls-files -z; else find . -type f -not -path './build*' -print0; fi |
  tar --null -T - -c | tar -x -C "$scratch"
for round in first second; do
  "$scratch/apps/quickstart.sh" >"$scratch/output" || { cat "$scratch/output"; exit 1; }
  grep -q 'S_mean' "$scratch/output" && grep -q '5\.72' "$scratch/output" || { cat "$scratch/output"; exit 1; }
  echo "$round run: coefficients and robustness printed"
done
