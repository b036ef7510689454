#!/usr/bin/env bash
# Loose sand is weaker than dense sand: the quick grains of the direct shear rig, 6 mm, at densities 0 and 0.5, three
# loads each. Takes 2 to 8 minutes on two cores.
#
#   density.sh <direct_shear> <output folder>
set -euo pipefail

rig=$1 output=$2

rm -rf "$output"
mkdir -p "$output"
for density in 0 0.5; do
  echo "Relative density $density"
  "$rig" --size quick --travel 0.006 --no-vtk --relative-density "$density" --output "$output/$density" > "$output/$density.log" 2>&1 ||
    { tail -n 20 "$output/$density.log" && exit 1; }
done

# Columns of results.csv: 2 normal stress, 3 maximum of the shear stress (Pa), 12 whether the load was finished.
#
# Maxima: the dense packing was 1.8 to 2.3 times as strong at each load (RESULTS.md), and two packings of one density
# differ by up to 12 %: 1.3 times is five such differences away.
# Angles, of the line through the origin: the loose packings came to 32.0 and 34.9 deg, the dense one to 52.3; 12 % of
# the strength at one load, which scatters by chance, are 2 deg of three loads together. Both bands are 4 such wide each
# way, and do not meet.
awk -F, '
  function refuse(why) { print why; failed = 1 }
  FNR == 1 { dense = FILENAME ~ /\/0\.5\/results\.csv$/; next }
  $12 != 1 { refuse("a load was not finished: " $0) }
  { normal[FNR] = $2; strength[dense, FNR] = $3; sum[dense] += $2 * $3; squares[dense] += $2 * $2; ++loads[dense] }
  END {
    if (loads[0] != 3 || loads[1] != 3) { print "not three loads each"; exit 1 }
    for (k = 2; k <= 4; ++k) {
      printf "%.1f kPa: loose %.2f kPa, dense %.2f kPa\n", normal[k] / 1e3, strength[0, k] / 1e3, strength[1, k] / 1e3
      if (!(strength[1, k] > 1.3 * strength[0, k])) refuse("the dense packing is not 1.3 times as strong")
    }
    for (d = 0; d <= 1; ++d) angle[d] = atan2(sum[d], squares[d]) * 180 / atan2(0, -1)
    printf "phi through the origin: loose %.1f deg, dense %.1f deg\n", angle[0], angle[1]
    if (!(angle[0] > 25.5 && angle[0] < 41.5)) refuse("loose, it is not 33.5 +- 8 deg")
    if (!(angle[1] > 44 && angle[1] < 60)) refuse("dense, it is not 52 +- 8 deg")
    exit failed
  }' "$output/0/results.csv" "$output/0.5/results.csv"
