#!/usr/bin/env bash
# Ctrl-C while the direct shear example shears: it ends with 130, and what was there by then is saved and reported. And
# while it makes its packing, of which there is nothing to save yet: it says so, and ends with 130 too.
#
#   interrupt.sh <direct_shear> <output folder> <packing file>
set -euo pipefail

rig=$1 output=$2 packing=$3

# Whoever started this script in the background has had the signal ignored, and so would the rig.
if ! env --default-signal=INT true 2> /dev/null; then
  echo "env cannot give a signal its default action back: not tested"
  exit 77
fi

rm -rf "$output"
mkdir -p "$output"
trap 'kill -KILL "$run" 2> /dev/null || true' EXIT

refuse() {
  echo "$1"
  cat "$log"
  exit 1
}

# interrupted <pattern> <options>...: starts the rig, and stops it as soon as what it prints matches the pattern.
interrupted() {
  local pattern=$1 status=0
  shift
  : > "$log"
  env --default-signal=INT "$rig" --size smoke --no-vtk "$@" > "$log" 2>&1 &
  run=$!
  for ((k = 0; k < 1200; ++k)); do
    ! grep -q "$pattern" "$log" || break
    kill -0 "$run" 2> /dev/null || refuse "The run ended before it printed '$pattern'"
    sleep 0.1
  done
  grep -q "$pattern" "$log" || refuse "The run did not print '$pattern' in two minutes"
  kill -INT "$run"
  wait "$run" || status=$?
  [ "$status" = 130 ] || refuse "The run ended with $status, not with 130"
}

log=$output/pouring.txt
interrupted 'pour: ' --output "$output/pouring"
grep -q 'The packing was not finished' "$log" || refuse "The run does not say that the packing was not finished"
[ ! -e "$output/pouring/packing.txt" ] || refuse "A packing was saved that was not finished"
! grep -q 'no finite data' "$log" || refuse "A run that had nothing to draw yet blames its plots"

log=$output/log.txt
interrupted 'shear at 44.1 kPa: [1-9][0-9]* %' --packing-file "$packing" --travel 0.006 --output "$output"

for file in report.html results.csv load_44.1kPa.csv settings.toml; do
  [ -s "$output/$file" ] || refuse "$file is missing or empty"
done
grep -q 'shear at 44.1 kPa: stopped' "$log" || refuse "The run does not say that it was stopped"
grep -q 'The run was interrupted' "$output/report.html" || refuse "report.html does not say that the run was interrupted"
grep -q 'breaking-factor=' "$output/report.html" || refuse "report.html does not hold all settings"
[ "$(grep -c ',0$' "$output/results.csv")" = 1 ] || refuse "results.csv has no row of a load that was not finished"
rows=$(($(wc -l < "$output/load_44.1kPa.csv") - 1))
((rows >= 50 && rows < 600)) || refuse "load_44.1kPa.csv has $rows rows, but a tenth of the travel are 60 samples"
echo "Interrupted after $rows samples"
