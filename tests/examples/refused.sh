#!/usr/bin/env bash
# Settings that make no sense, or can be seen not to work: the direct shear example ends with 2, says why in the names
# of its options, and leaves an earlier run's results as they are. What it accepts, it starts anew, and says so.
#
#   refused.sh <direct_shear> <output folder> <packing file>
set -euo pipefail

rig=$1 output=$2 packing=$3
earlier=$output/earlier log=$output/log.txt

fail() {
  echo "$1"
  cat "$log"
  exit 1
}

rm -rf "$output"
mkdir -p "$earlier/load_44.1kPa"
for file in settings.toml packing.txt report.html results.csv load_44.1kPa.csv load_44.1kPa/grains_000000.vtp; do
  echo "of an earlier run" > "$earlier/$file"
done
printf 'dem-packing 1\nhalf_edge 0.003\nbox 0.06 0.06\nnote -\ngrains 0\n' > "$output/empty.txt"

contents() { find "$earlier" -exec cksum {} + 2> /dev/null | sort; }
before=$(contents)

# refuse <words of the message> <option>...
refuse() {
  local words=$1 status=0
  shift
  "$rig" --size smoke --output "$earlier" "$@" > "$log" 2>&1 || status=$?
  [ "$status" = 2 ] || fail "With $* the run ended with $status, not with 2"
  grep -q -e "$words" "$log" || fail "With $* it does not say '$words'"
  ! grep -q 'time_step\|overlap_limit\|save_packing\|machine()' "$log" || fail "With $* it names what is no option"
  [ "$(contents)" = "$before" ] || fail "With $* it touched the results of an earlier run"
}

refuse 'cannot read' --packing-file "$output/none.txt"
refuse 'make one with --save-packing' --packing-file "$earlier/results.csv"
refuse 'has no grains' --packing-file "$output/empty.txt"
refuse 'give --half-edge 0.003' --packing-file "$packing" --half-edge 0.0025
refuse '--shape is polyhedron' --packing-file "$packing" --shape polyhedron
refuse 'higher --box-height' --packing-file "$packing" --box-height 0.02
refuse 'insist with --allow-unstable-time-step' --packing-file "$packing" --time-step 1e-3
refuse 'insist with --allow-unstable-time-step' --time-step 1e-3
refuse 'cannot make the folder' --save-packing "$earlier/results.csv/packing.txt"
refuse 'is a folder' --save-packing "$output"
refuse 'even without gaps' --grains 3000
refuse 'fits nowhere' --packing poured --grains 500 --tilt 30
refuse 'too few to measure a density' --grains 100
refuse 'counts only with --packing random' --packing poured --seed 2

earlier=$earlier/results.csv
before=$(contents)
refuse 'cannot make the folder' --packing-file "$packing"
earlier=$output/earlier

"$rig" --size smoke --output "$earlier" --packing-file "$packing" --time-step 3e-5 --allow-unstable-time-step \
  --travel 1e-4 --smoothing 1e-5 --ramp-time 0.002 --no-vtk > "$log" 2>&1 || fail "What is insisted on is refused"
grep -q 'earlier run with other settings left .* load_44.1kPa.csv, report.html, results.csv' "$log" ||
  fail "It does not say which results it replaces"
! grep -q 'of an earlier run' "$earlier/results.csv" "$earlier/settings.toml" || fail "Earlier results are still there"
[ ! -e "$earlier/load_44.1kPa" ] || fail "Earlier frames are still there"
grep -q 'of an earlier run' "$earlier/packing.txt" || fail "The earlier run's packing is gone"
