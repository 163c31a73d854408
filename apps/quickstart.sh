#!/bin/sh
# From a clean checkout to coefficients and robustness: installs what is missing, builds Release, studies data/vcenter55.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh build
cmake --preset release -DTHERMFIT_BUILD_TESTS=OFF >build.log 2>&1 &&
  cmake --build --preset release --target thermfit_app >>build.log 2>&1 ||
  { cat build.log; exit 2; }
rm build.log
echo "thermfit: built build/release/thermfit"
exec build/release/thermfit study data/vcenter55/
