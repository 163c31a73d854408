#!/bin/sh
# pkg_config.sh PREFIX COMPILER SOURCE BUILD_FOLDER: compiles and runs SOURCE with nothing but pkg-config's flags, with
# the headers alone and with the compiled library where it was installed.
set -eu
PKG_CONFIG_PATH=$(find "$1" -name pkgconfig -type d | paste -s -d :)
export PKG_CONFIG_PATH
for package in $(find "$1" -name 'thermfit*.pc' -exec basename {} .pc \; | sort); do
  # shellcheck disable=SC2046  # flags are several words
  $2 -std=c++17 "$3" $(pkg-config --cflags --libs "$package") -o "$4/pkg_config_$package"
  "$4/pkg_config_$package"
  echo "$package: built and run"
done
