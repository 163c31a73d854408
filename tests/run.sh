#!/bin/sh
# Installs what is missing, builds Release and runs the tests. --all adds the slow ones and those that need other
# programs (LinuxCNC, ARM tools, Python packages); other words go to ctest.
set -eu
cd "$(dirname "$0")/.."
labels="-LE slow|extern"
sections="build test"
if [ "${1:-}" = --all ]; then
  shift
  labels=
  sections="build test extern"
fi
# shellcheck disable=SC2086  # several words
sh apps/install_packages.sh $sections
if [ -z "$labels" ]; then sh tests/install_python_packages.sh; fi
cmake --preset release -DTHERMFIT_BUILD_TESTS=ON >/dev/null
cmake --build --preset release
# shellcheck disable=SC2086
exec ctest --preset release -j "$(nproc)" $labels "$@"
