#!/usr/bin/env bash
# Installs what dem is built and tested with, on Debian and its kin. Does nothing when all of it is there. Arguments:
# packages needed besides.
set -euo pipefail

packages=(
  g++ cmake ninja-build        # compiler and build
  libeigen3-dev libfmt-dev     # the library
  libcli11-dev gnuplot-nox libjs-three libnlopt-cxx-dev  # examples: command lines, plots, replays, calibration
  catch2 clang-format hdf5-tools  # tests
  libbenchmark-dev             # benchmarks
  libopenmpi-dev openmpi-bin   # worlds that several processes share
  libhdf5-dev zlib1g-dev       # states that are saved and loaded; compressed files for ParaView
  "$@"
)

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2> /dev/null)" = installed ]; }

missing=()
if command -v apt-get > /dev/null; then
  for package in "${packages[@]}"; do is_installed "$package" || missing+=("$package"); done
else
  echo "There is no apt-get here. If the build stops, install by hand: ${packages[*]}" >&2
fi
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "Neither root nor sudo. As root, run: apt-get update && apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
