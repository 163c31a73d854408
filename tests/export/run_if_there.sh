#!/bin/sh
# run_if_there.sh 'NEEDED;…' COMMAND…: runs the command, or says what is missing and exits 77 (skipped).
needed=$1
shift
IFS=';'
for one in $needed; do
  case $one in
    /*) test -e "$one" ;;
    *) command -v "$one" >/dev/null ;;
  esac || { echo "skipped: $one is not on this machine (tests/run.sh --all installs it)"; exit 77; }
done
exec "$@"
