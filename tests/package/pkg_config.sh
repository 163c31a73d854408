#!/bin/sh
# pkg_config.sh PC_FOLDER COMPILER SOURCE BUILD_FOLDER: compiles and runs SOURCE with nothing but pkg-config's flags.
set -eu
flags=$(PKG_CONFIG_PATH=$1 pkg-config --cflags thermfit)
# shellcheck disable=SC2086  # flags are several words
$2 -std=c++17 -O1 $flags "$3" -o "$4/pkg_config_consumer"
"$4/pkg_config_consumer"
