#!/usr/bin/env bash
# Builds the library, examples and tests, and runs all tests but the validation and the checks; installs the packages they
# need first.
# An argument names another workflow of CMakePresets.json, e.g. asan or validation.
set -euo pipefail

cd "$(dirname "$0")/.."

extra=()
[ "${1:-}" != tsan ] || extra=(clang libomp-dev)
bash cmake/packages.sh "${extra[@]}"
# As many compilers as cores: Ninja takes more, and each may take 3 GB of memory.
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
CTEST_PARALLEL_LEVEL=${CTEST_PARALLEL_LEVEL:-$(nproc)} cmake --workflow --preset "${1:-test}"
