#!/bin/sh
# build_and_test.sh SOURCE PRESET FOLDER OPTION…: configures a preset in a folder of its own, builds it and runs the unit
# tests.
set -eu
source=$1 preset=$2 folder=$3
shift 3
cd "$source"
cmake --preset "$preset" -B "$folder" -DTHERMFIT_BUILD_TESTS=ON "$@" >/dev/null
cmake --build "$folder"
ctest --test-dir "$folder" -j "$(nproc)" -LE 'slow|extern' --output-on-failure
