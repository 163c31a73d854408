#!/bin/sh
# install_packages.sh SECTION...: installs from Debian what apps/packages.txt lists under the sections and is missing.
set -eu
list=$(dirname "$0")/packages.txt
missing=
for section in "$@"; do
  for package in $(sed -n "/^\[$section\]/,/^\[/p" "$list" | sed '/^[[#]/d; s/ .*//; /^$/d'); do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
  done
done
[ -n "$missing" ] || exit 0
echo "thermfit: installing from Debian:$missing"
run=
[ "$(id -u)" -eq 0 ] || run=sudo
if ! { $run apt-get update -qq &&
       $run env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } >/dev/null; then
  echo "thermfit: could not install:$missing; install them by hand and run this again" >&2
  exit 2
fi
