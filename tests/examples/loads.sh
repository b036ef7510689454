#!/usr/bin/env bash
# Two loads in one run of the direct shear example: both are tested on the same packing, and a line is fitted to them.
#
#   loads.sh <direct_shear> <output folder> <packing file>
set -euo pipefail

rig=$1 output=$2 packing=$3
log=$output/log.txt

fail() {
  echo "$1"
  cat "$log"
  exit 1
}

rm -rf "$output"
mkdir -p "$output"
# run <name> <loads>
run() {
  "$rig" --size smoke --packing-file "$packing" --travel 1e-3 --no-vtk --output "$output/$1" --loads "$2" \
    > "$log" 2>&1 || fail "The run of $2 kg failed"
}

run second 30
run both 16.2,30
# To the last digit what it is without a load before it: neither its grains nor its rig are those that were sheared.
[ "$(sed -n 3p "$output/both/results.csv")" = "$(sed -n 2p "$output/second/results.csv")" ] ||
  fail "The second load's results depend on the first load"
cmp "$output/both/load_81.8kPa.csv" "$output/second/load_81.8kPa.csv"
[ "$(grep -c ',1$' "$output/both/results.csv")" = 2 ] || fail "results.csv has not two finished loads"

# The line through the origin that fits both: tan phi = sum(sigma tau)/sum(sigma^2); it is printed with two decimals.
angle=$(awk -F, 'NR > 1 { xy += $10 * $3; xx += $10 * $10 } END { print atan2(xy, xx) * 45 / atan2(1, 1) }' \
  "$output/both/results.csv")
fitted=$(sed -n 's/^maximum shear, through the origin *\([0-9.]*\) .*/\1/p' "$log")
awk -v a="$angle" -v b="$fitted" 'BEGIN { exit !(b != "" && a - b < 0.01 && b - a < 0.01) }' ||
  fail "The angle of both loads is '$fitted' deg, but $angle"
grep -q '^maximum shear  ' "$log" || fail "There is no line with cohesion"
echo "Two loads on one packing: $fitted deg"
