#!/usr/bin/env bash
# The programs that the pages show are those that are compiled and tested: each block of C++ in a part of a page stands,
# letter by letter, in a source of its example or test.
set -euo pipefail

cd "$(dirname "$0")/.."

# check <page> <first line of the part> <line after it> <folder of the sources>
check() {
  local page=$1 first=$2 last=$3 folder=$4 block="" inside=false count=0 line sources
  sources=$(cat "$folder"/*.hpp "$folder"/*.cpp 2> /dev/null || true)$'\n'  # which the shell cut off
  while IFS= read -r line; do
    if [ "$line" = '```cpp' ]; then
      inside=true block=""
    elif [ "$line" = '```' ] && $inside; then
      inside=false count=$((count + 1))
      [[ $sources == *"$block"* ]] && continue
      echo "$page: this block is not in $folder; make them the same:"
      printf '%s' "$block"
      exit 1
    elif $inside; then
      block+=$line$'\n'
    fi
  done < <(awk -v first="$first" -v last="$last" 'index($0, first) == 1 { on = 1 } index($0, last) == 1 { on = 0 } on' "$page")
  [ "$count" -gt 0 ] || { echo "$page: no block of C++ from '$first' to '$last'"; exit 1; }
}

check README.md "# dem" "## Use it" examples/first_steps
check README.md "## Use it" "## The direct shear test" tests/pages
check ARCHITECTURE.md "### Constants from measurements" "### Your own law" tests/pages
check ARCHITECTURE.md "### Your own law" "### Your own shape" examples/own_law
check ARCHITECTURE.md "### Your own shape" "## The step" examples/own_shape
check include/dem/vehicle/README.md "# Your own vehicle" "## The points" tests/unit/vehicle
check include/dem/README.md "# dem inside your program" "(none)" tests/pages
check include/dem/terramechanics/README.md "# Soil by equations" "(none)" tests/unit/terramechanics
check include/dem/io/checkpoint/README.md "## A program that goes on" "## Files" examples/bucket
check include/dem/rig/README.md "## Your own rig" "## The direct shear test" examples/blade
check include/dem/rig/README.md "## The direct shear test" "(none)" tests/unit/rig
