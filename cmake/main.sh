#!/usr/bin/env bash
# Builds and runs the direct shear example; installs the packages it needs first. Arguments go to the example, e.g.
# `--size full`; by default it runs the quick one.
set -euo pipefail

cd "$(dirname "$0")/.."

bash cmake/packages.sh
cmake --workflow --preset main
build/release/examples/direct_shear "$@"
