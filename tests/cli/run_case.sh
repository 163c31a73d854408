#!/usr/bin/env bash
# Runs one golden case and compares what it did with what is written down; with --write, writes it down instead.
# A case is a folder with `command` (run by bash in a scratch copy of the folder, where `thermfit` is the one under test
# and `data` is the project's data folder), `stdout`, `stderr` and `exit` (absent: empty, empty, 0), and, in `expected/`,
# files that the command must have written. Review rewritten cases by their diff.
set -u
[ $# -ge 2 ] || { echo "usage: $0 FOLDER_OF_THERMFIT CASE [--write]" >&2; exit 2; }
program=$(cd "$1" && pwd) case=$(cd "$2" && pwd) mode=${3:-compare}
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cp -R "$case" "$scratch/case"
ln -s "$source/data" "$scratch/case/data"
(cd "$scratch/case" && rm -rf stdout stderr exit expected &&
  PATH="$program:$PATH" NO_COLOR=1 bash ./command) >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
echo $? >"$scratch/exit"

if [ "$mode" = --write ]; then
  rm -f "$case"/{stdout,stderr,exit}
  for part in stdout stderr; do [ ! -s "$scratch/$part" ] || cp "$scratch/$part" "$case/$part"; done
  [ "$(cat "$scratch/exit")" = 0 ] || cp "$scratch/exit" "$case/exit"
  [ ! -d "$case/expected" ] || (cd "$case/expected" && find . -type f -exec cp "$scratch/case/{}" {} \;)
  exit 0
fi

failed=0
same() { diff -u --label "expected $3" --label "found $3" "$1" "$2" || failed=1; }
for part in stdout stderr; do [ -f "$case/$part" ] && same "$case/$part" "$scratch/$part" $part ||
  same /dev/null "$scratch/$part" $part; done
[ -f "$case/exit" ] && same "$case/exit" "$scratch/exit" exit || same <(echo 0) "$scratch/exit" exit
if [ -d "$case/expected" ]; then
  while read -r file; do same "$case/expected/$file" "$scratch/case/$file" "$file"; done \
    < <(cd "$case/expected" && find . -type f | sort)
fi
exit $failed
