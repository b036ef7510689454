#!/usr/bin/env bash
# A rig whose bed is saved as a state (--save-bed bed.h5): a run that starts from it ends with the same bytes in its CSV
# files as the one that made it, and settings of another bed are refused in words, before earlier results are lost. Other
# programs read the state: h5dump (Debian's hdf5-tools) tells a place for each grain, with its unit.
#
#   bed_state.sh <rig> <output folder> <options>...
set -euo pipefail

rig=$1 output=$2
shift 2
export OMP_NUM_THREADS=2

refuse() {
  echo "$1"
  tail -n 20 "$output"/*.txt
  exit 1
}

if "$rig" --resume --output "$output/none" 2>&1 | grep -q 'needs HDF5'; then
  echo "the rig was built without HDF5: not tested"
  exit 77
fi

rm -rf "$output"
mkdir -p "$output"
"$rig" "$@" --save-bed "$output/bed.h5" --output "$output/made" > "$output/made.txt" 2>&1 || refuse "the run that makes the bed ended with $?"
[ -s "$output/bed.h5" ] || refuse "it left no bed"
"$rig" "$@" --bed-file "$output/bed.h5" --output "$output/taken" > "$output/taken.txt" 2>&1 || refuse "the run from the bed ended with $?"
for file in "$output"/made/*.csv; do
  cmp "$file" "$output/taken/$(basename "$file")" || refuse "$(basename "$file") is not what it is where the bed is made"
done
if ! command -v h5dump > /dev/null; then
  echo "no h5dump: other programs' view is not tested"
else
  h5dump -d /grains/position/x "$output/bed.h5" > "$output/places.dump" || refuse "h5dump does not read the bed"
  grep -q '(0): "m"' "$output/places.dump" || refuse "places have no unit"
  grains=$(h5dump -d /grains/count "$output/bed.h5" | sed -n 's/.*(0): //p') || refuse "h5dump does not read the number of grains"
  rows=$(sed -n 's/.*SIMPLE { ( \([0-9]*\) ) .*/\1/p' "$output/places.dump" | head -n 1)
  [ "$grains" -gt 0 ] && [ "$rows" = "$grains" ] || refuse "there are $rows places of $grains grains"
fi
# refused <words> <options>...: and earlier results stay.
refused() {
  local words=$1
  shift
  if "$rig" "${all[@]}" --output "$output/taken" "$@" > "$output/other.txt" 2>&1; then refuse "not refused: $*"; fi
  grep -q -- "$words" "$output/other.txt" || refuse "not refused in words: $*"
  [ -s "$output/taken/results.csv" ] || refuse "earlier results are lost: $*"
}
all=("$@")
refused "was made with --seed 1, but here it is 7" --bed-file "$output/bed.h5" --seed 7
refused "was made with --fall-speed 0, but here it is 0.3" --bed-file "$output/bed.h5" --fall-speed 0.3
refused "was made with --stable-share 0.8, but here it is 0.5" --bed-file "$output/bed.h5" --stable-share 0.5
refused "was made with --strike-off 0.02, but here it is 0.3" --bed-file "$output/bed.h5" --strike-off 0.3
refused "give another place" --save-bed "$output/taken/checkpoint/bed.h5"
echo "The same from the state of the bed"
