#!/usr/bin/env bash
# fill.sh <sand_pile> <folder>: a pile keeps its fill, another one starts from it, and no run starts from what it would
# replace.
set -euo pipefail

rig=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
small=(--size smoke --grains 60 --cylinder-radius 0.02 --creep-time 0.02 --rest-limit 0.1 --no-vtk --no-replay --threads 1)

"$rig" "${small[@]}" --kinds cube8 --output a > a.log 2>&1
[ "$(sed -n 2p a/cube8_1_filled.txt)" = "shape cube8" ]
"$rig" "${small[@]}" --kinds cube8-viscous --seed 3 --fill-file a/cube8_1_filled.txt --output b > b.log 2>&1
grep -q '^cube8-viscous,3,' b/results.csv
grep -q 'grains start from' b/report.html
if "$rig" "${small[@]}" --kinds cube8 --fill-file a/cube8_1_filled.txt --output a > own.log 2>&1; then
  echo "a run started from a fill that it replaces" >&2 && exit 1
fi
grep -q "fill-file is .*which the run replaces by a result of its own" own.log
[ -s a/cube8_1_filled.txt ]
