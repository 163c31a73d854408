#!/usr/bin/env bash
# silently_wrong.sh FOLDER_OF_THERMFIT: runs every line of silently_wrong.txt in a scratch copy of its folder of cases and prints a
# table: kind, files, outcome. Cases lie in $THERMFIT_SHARED (default: ../shared beside the source tree), else it is skipped.
set -u
program=$(cd "$1" && pwd)/thermfit
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
shared=${THERMFIT_SHARED:-$here/../../../shared}
[ -d "$shared/cases/csv" ] || { echo "skipped: set THERMFIT_SHARED to the folder that holds the reference data"; exit 0; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trim() { local text=$1; text=${text#"${text%%[![:space:]]*}"}; printf %s "${text%"${text##*[![:space:]]}"}"; }
zeros=$shared/cases/csv/03-probe-rezeroed-each-session
"$program" fit "$zeros"/zero?.csv -o "$scratch/model08.json" >/dev/null 2>&1
failed=0
while IFS='|' read -r kind folder command code said; do
  kind=$(trim "$kind") folder=$(trim "$folder") code=$(trim "$code") said=${said# }
  rm -rf "$scratch/case" && cp -R "$shared/cases/$folder" "$scratch/case" && chmod -R u+w "$scratch/case"
  read -ra words <<<"${command//MODEL08/$scratch/model08.json}"
  output=$(cd "$scratch/case" && set -f && NO_COLOR=1 "$program" "${words[@]}" 2>&1 </dev/null) && status=0 || status=$?
  outcome=said
  if [ "$status" != "$code" ]; then outcome="exit $status, not $code"; fi
  grep -qE -- "$said" <<<"$output" || outcome="not said: $said"
  [ "$outcome" = said ] || failed=1
  printf '%-36s  %-64s  %s\n' "$kind" "$folder: ${words[*]:1:2}" "$outcome" | sed "s#$scratch/##"
done < <(grep -v '^#' "$here/silently_wrong.txt")
exit $failed
