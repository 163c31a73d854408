#!/usr/bin/env bash
# Builds a fuzz target with libFuzzer, address and undefined-behaviour sanitizers and lets it search for a while.
set -eu
[ $# -ge 2 ] || { echo "usage: $0 TARGET SECONDS [FOLDER]   e.g. $0 csv 60" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd) target=$1 seconds=$2 folder=${3:-$(mktemp -d)}
compiler=$(command -v clang++ || command -v clang++-14 || command -v clang++-16) ||
  { echo "needs clang with libFuzzer: apt-get install clang libclang-rt-dev" >&2; exit 77; }
mkdir -p "$folder/found" && cd "$folder"
"$compiler" -std=c++17 -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -DTHERMFIT_LIBFUZZER \
  -DTHERMFIT_HAS_ZLIB -I"$here/../../include" -I"${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" \
  "$here/${target}_fuzz.cpp" -lz -o "${target}_fuzz"
dictionary=$here/$target.dict
"./${target}_fuzz" -max_total_time="$seconds" -max_len=20000 -timeout=10 -rss_limit_mb=1024 -print_final_stats=1 \
  $([ -f "$dictionary" ] && echo "-dict=$dictionary") found "$here/corpus/$target"
