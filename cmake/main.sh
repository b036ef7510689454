#!/usr/bin/env bash
# Builds and runs the direct shear example; installs the packages it needs first. Arguments go to the example, e.g.
# `--size full`; by default it runs the quick one. Relative paths are taken from where this is called. Other shapes and
# integrators than the default ones are in a second program, which is built when they are asked for.
set -euo pipefail

root=$(dirname "$(dirname "$(realpath "$0")")")

bash "$root/cmake/packages.sh"
(cd "$root" && cmake --workflow --preset main)
status=0
"$root/build/release/examples/direct_shear" "$@" || status=$?
if [ $status = 3 ]; then
  echo "Building direct_shear_all, which takes some minutes" >&2
  (cd "$root" && cmake --build --preset main --target direct_shear_all)
  exec "$root/build/release/examples/direct_shear_all" "$@"
fi
exit $status
