#!/usr/bin/env bash
# Builds and runs the direct shear example; installs the packages it needs first. Arguments go to the example, e.g.
# `--size full`; by default it runs the quick one. Relative paths are taken from where this is called.
set -euo pipefail

root=$(dirname "$(dirname "$(realpath "$0")")")

bash "$root/cmake/packages.sh"
(cd "$root" && cmake --workflow --preset main)
"$root/build/release/examples/direct_shear" "$@"
