#!/bin/sh
# From a clean checkout to coefficients and robustness: installs what is missing, builds Release, studies data/vcenter55.
set -eu
cd "$(dirname "$0")/.."
sh apps/install_packages.sh build
cmake --preset quickstart >build.log 2>&1 &&
  cmake --build --preset quickstart --target thermfit_app >>build.log 2>&1 ||
  { cat build.log; exit 2; }
rm build.log
echo "thermfit: built build/quickstart/thermfit"
exec build/quickstart/thermfit study data/vcenter55/
