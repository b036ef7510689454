#!/usr/bin/env bash
# Builds and runs the direct shear example; installs the packages it needs first. Arguments go to the example, e.g.
# `--size full`; without a --size it runs the quick one.
set -euo pipefail

cd "$(dirname "$0")/.."

case " $*" in *" --size"*) ;; *) set -- --size quick "$@" ;; esac

bash cmake/packages.sh
cmake --workflow --preset main
build/release/examples/direct_shear "$@"
