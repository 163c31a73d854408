#!/usr/bin/env bash
# Writes down what thermfit does now as the golden answer of the cases given, or of all. Then read `git diff`.
set -eu
[ $# -ge 1 ] || { echo "usage: $0 FOLDER_OF_THERMFIT [CASE…]" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd) program=$1
shift
[ $# -gt 0 ] || set -- "$here"/cases/*/*/
for case in "$@"; do "$here/run_case.sh" "$program" "$case" --write; done
