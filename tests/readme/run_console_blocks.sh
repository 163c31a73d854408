#!/usr/bin/env bash
# run_console_blocks.sh README FOLDER_OF_THERMFIT: runs each `$ command` of README's console blocks, one after the other
# in one scratch folder that holds `data`, and compares what is printed (stdout and stderr together) with the lines
# under it. A line `…` stands for any lines. A block after `<!-- not run here: reason -->` is left out.
set -u
readme=$1 program=$(cd "$2" && pwd) source=$(cd "$(dirname "$1")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ln -s "$source/data" "$scratch/data"
ln -s "$source/tests" "$scratch/tests"
ln -s "$source/apps" "$scratch/apps"

# matches EXPECTED FOUND: line by line, `…` skipping ahead to the next place where the following lines fit.
matches() {
  awk -v expected="$1" '
    BEGIN { while ((getline line < expected) > 0) want[++n] = line }
    { have[++m] = $0 }
    function fits(i, j) {
      while (i <= n) {
        if (want[i] == "…") {
          if (i == n) return 1
          for (; j <= m + 1; ++j) if (fits(i + 1, j)) return 1
          return 0
        }
        if (j > m || want[i] != have[j]) return 0
        ++i; ++j
      }
      return j > m
    }
    END { exit !fits(1, 1) }' "$2"
}

failed=0 commands=0 line_number=0 inside=0 skip=0 command=''
: >"$scratch/.expected"
finish() {
  [ -n "$command" ] || return 0
  commands=$((commands + 1))
  (cd "$scratch" && PATH="$program:$PATH" NO_COLOR=1 bash -c "$command") >"$scratch/.found" 2>&1 </dev/null
  if ! matches "$scratch/.expected" "$scratch/.found"; then
    failed=$((failed + 1))
    echo "$readme:$at: \$ $command"
    diff -u --label README --label found "$scratch/.expected" "$scratch/.found"
  fi
  command=
}
while IFS= read -r line; do
  line_number=$((line_number + 1))
  case $line in
    '<!-- not run here:'*) skip=1 ;;
    '```console') if [ $skip = 0 ]; then inside=1; fi; skip=0 ;;
    '```'*) if [ $inside = 1 ]; then finish; inside=0; elif [ "$line" != '```' ]; then skip=0; fi ;;
    '$ '*) if [ $inside = 1 ]; then finish; command=${line#\$ } at=$line_number; : >"$scratch/.expected"; fi ;;
    *) if [ $inside = 1 ]; then printf '%s\n' "$line" >>"$scratch/.expected"; fi ;;
  esac
done <"$readme"
echo "$commands commands of README run, $failed differ"
[ $commands -gt 0 ] && [ $failed = 0 ]
