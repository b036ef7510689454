#!/usr/bin/env bash
# What goes wrong beside the test costs no results of the direct shear example: files for ParaView that cannot be
# written, and a density that cannot be measured. What ends a run early is told in its options' names.
#
#   losses.sh <direct_shear> <output folder> <packing file>
set -euo pipefail

rig=$1 output=$2 packing=$3
log=$output/log.txt

fail() {
  echo "$1"
  cat "$log"
  exit 1
}

# run <status> <folder> <option>...
run() {
  local expected=$1 folder=$2 status=0
  shift 2
  "$rig" --size smoke --travel 5e-4 --output "$folder" "$@" > "$log" 2>&1 || status=$?
  [ "$status" = "$expected" ] || fail "The run ended with $status, not with $expected"
  [ "$(grep -c ',1$' "$folder/results.csv")" = 1 ] || fail "results.csv has no finished load"
  [ -s "$folder/report.html" ] || fail "There is no report"
}

rm -rf "$output"
mkdir -p "$output/frames"
echo "a file" > "$output/frames/load_44.1kPa"  # where the folder of the frames should be: no one can write into it
run 1 "$output/frames" --packing-file "$packing"
[ "$(grep -c 'warning: no more files for ParaView' "$log")" = 1 ] || fail "It does not warn once"
grep -q 'Files for ParaView are missing' "$output/frames/report.html" || fail "report.html does not say what is missing"

run 0 "$output/thin" --grains 60 --box-length 0.04 --box-width 0.04 --relative-density 0 --loads 7.2 --no-vtk
[ "$(grep -c 'warning: the density .* is not known' "$log")" = 2 ] || fail "It does not warn of packing and specimen"
grep -q 'solid fraction -' "$log" || fail "It prints a density"
! grep -qi 'nan' "$log" "$output/thin/results.csv" || fail "Something is called nan"
grep -q ',,,' "$output/thin/results.csv" || fail "results.csv has a density"
[ "$(grep -c '^' "$output/thin/packing.txt")" = 66 ] || fail "The packing of 60 grains was not saved"

# Without gnuplot, which is not in this PATH, all but the pictures is there, and it says so.
status=0
env PATH=/nonexistent "$rig" --size smoke --travel 5e-4 --packing-file "$packing" --no-vtk --output "$output/plain" \
  > "$log" 2>&1 || status=$?
[ "$status" = 0 ] || fail "Without gnuplot it ends with $status, not with 0"
grep -q 'the plots were not drawn' "$log" || fail "It does not say that plots are missing"
grep -q '^Report, tables: ' "$log" || fail "It promises plots, or ParaView files, that are not there"
[ -s "$output/plain/shear_stress.gp" ] || fail "The scripts of the plots are missing"

# A terminal that is gone, or full, costs nothing.
gone=$output/gone
short=(--size smoke --travel 1e-4 --smoothing 1e-5 --ramp-time 0.002 --packing-file "$packing" --no-vtk --output "$gone")
for stream in '2>&-' '2> /dev/full' '< /dev/null >&- 2>&-'; do
  rm -rf "$gone"
  echo "$stream" > "$log"
  eval "\"\$rig\" \"\${short[@]}\" > \"$output/printed.txt\" $stream" || fail "It ends with $? when its terminal is gone"
  [ -s "$gone/report.html" ] && [ "$(grep -c ',1$' "$gone/results.csv")" = 1 ] || fail "It loses results with its terminal"
  ! grep -q 'consolidate' "$gone"/*.csv "$gone/settings.toml" || fail "It prints into its files"
done

# A packing alone has nothing to draw, and misses nothing.
"$rig" --size smoke --packing-only --relative-density 0 --output "$output/packed" > "$log" 2>&1 || fail "No packing was made"
grep -q '^Report, tables: ' "$log" || fail "It promises plots, or ParaView files, that are not there"
! grep -q 'not drawn' "$log" "$output/packed/report.html" || fail "It misses plots of nothing"
[ -s "$output/packed/packing.txt" ] || fail "There is no packing"

# What ends a run early is told in the names of the options, and all that is known by then is reported.
status=0
"$rig" --size smoke --packing-file "$packing" --overlap-limit 1e-3 --no-vtk --output "$output/deep" \
  > "$log" 2>&1 || status=$?
[ "$status" = 1 ] || fail "A run that is stopped by an overlap ends with $status, not with 1"
grep -q 'more than --overlap-limit 0.001; raise --stiffness, lower --time-step' "$log" || fail "It names no options"
! grep -q 'overlap_limit\|time_step' "$log" "$output/deep/report.html" || fail "It names what is no option"
[ "$(grep -c ',0$' "$output/deep/results.csv")" = 1 ] || fail "results.csv has no row of the load that was not finished"
