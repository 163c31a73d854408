#!/bin/sh
# Installs what is missing, builds Release and runs the tests. --all adds the slow ones and those that need other
# programs: clang, sanitizers, LinuxCNC, ARM tools, Python packages. Other words go to ctest.
set -eu
cd "$(dirname "$0")/.."
labels="-LE slow|extern"
sections="build test"
targets=all
if [ "${1:-}" = --all ]; then
  shift
  labels=
  sections="build test extern clang"
  targets="all thermfit_slow"
fi
# shellcheck disable=SC2086  # several words
sh apps/install_packages.sh $sections
if [ -z "$labels" ]; then sh tests/install_python_packages.sh; fi
cmake --preset release -DTHERMFIT_BUILD_TESTS=ON >/dev/null
# shellcheck disable=SC2086
cmake --build --preset release --target $targets
# shellcheck disable=SC2086
exec ctest --preset release -j "$(nproc)" $labels "$@"
