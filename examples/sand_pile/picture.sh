#!/usr/bin/env bash
# Draws two piles of cubes of a run beside each other, seen from the side, with the angles of their flanks: writes
# picture.gp into the folder of the run and, where gnuplot is installed, picture.png.
#
#   sand_pile --kinds cube8,cube8-viscous --output out/piles
#   picture.sh out/piles [cube8_1 cube8-viscous_1]
set -euo pipefail

[ $# -ge 1 ] || { sed -n 's/^#   //p' "$0" >&2 && exit 2; }
cd "$1"
left=${2:-cube8_1} right=${3:-cube8-viscous_1}
for pile in "$left" "$right"; do
  [ -s "$pile.txt" ] || { echo "there is no pile '$pile.txt' in '$1'; make it with --kinds ${pile%_*}" >&2 && exit 2; }
done

# balls <pile> <x of its middle>: depth, x, z, radius (mm) and tint of each sphere of its cubes.
balls() {
  awk -v x0="$2" -v wide="$apart" 'NF == 7 && NR > 6 {
      if (2e3 * ($1 < 0 ? -$1 : $1) > wide) next  # of the layer around the pile
      for (k = 0; k < 8; ++k) {
        a = h / 2 * (k % 2 ? 1 : -1); b = h / 2 * (int(k / 2) % 2 ? 1 : -1); c = h / 2 * (k >= 4 ? 1 : -1)
        w = $4; x = $5; y = $6; z = $7
        px = $1 + (1 - 2 * (y * y + z * z)) * a + 2 * (x * y - w * z) * b + 2 * (x * z + w * y) * c
        py = $2 + 2 * (x * y + w * z) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z - w * x) * c
        pz = $3 + 2 * (x * z - w * y) * a + 2 * (y * z + w * x) * b + (1 - 2 * (x * x + y * y)) * c
        printf "%.6f %.3f %.3f %.3f %.2f\n", py, 1e3 * px + x0, 1e3 * pz, 1e3 * h / 2, 0.8 + 0.02 * (NR * 7 % 11)
      }
    }
    $1 == "half_edge" { h = $2 }' "$1.txt"
}
# of <pile> <column of results.csv>
of() { awk -F, -v kind="${1%_*}" -v seed="${1##*_}" -v name="$2" '
  NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) at = i }
  NR > 1 && $1 == kind && $2 == seed { print $at }' results.csv; }
# flank <pile> <x>: both sides of its fitted angle, through the middle of the flank, in mm.
flank() {
  awk -v x0="$2" -v angle="$(of "$1" angle_deg)" -v height="$(of "$1" height_m)" -v from="$(of "$1" flank_from_m)" \
    -v to="$(of "$1" flank_to_m)" 'BEGIN {
      slope = sin(angle * 3.14159265 / 180) / cos(angle * 3.14159265 / 180); middle = (from + to) / 2
      top = height / 2 + slope * middle; foot = middle + height / 2 / slope
      printf "%g 0\n%g %g\n%g 0\n", x0 - 1e3 * foot, x0, 1e3 * top, x0 + 1e3 * foot
    }'
}
label() {
  printf "%s: %.1f°, after %.1f s %.1f°" "$3" "$(of "$1" angle_deg)" "$(of "$1" creep_time_s)" "$(of "$1" angle_after_deg)"
}

# mm, from one pile to the other: the farthest foot of a flank twice, and a gap.
apart=$(printf '%s\n' "$(of "$left" flank_to_m)" "$(of "$right" flank_to_m)" | sort -g | awk 'END { print 2.2e3 * $1 + 8 }')
{
  echo "set terminal pngcairo size 1000,210 font ',13'"
  echo "set output 'picture.png'"
  echo "set size ratio -1; unset border; unset tics; unset key; set style fill solid noborder; set offsets 0, 0, 1, 0"
  echo "set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0"
  echo "set xrange [-$apart/2 : 3*$apart/2]; set yrange [-7 : *]"
  echo "set label 1 \"$(label "$left" 0 "Asperity friction")\" at 0,-4.5 center"
  echo "set label 2 \"$(label "$right" 0 "Coulomb-viscous friction")\" at $apart,-4.5 center"
  echo '$balls << EOD'
  # The nearest are drawn last: they have the smallest y. Farther ones are darker.
  { balls "$left" 0; balls "$right" "$apart"; } | sort -k1,1gr -s |
    awk '{ depth[NR] = $1; line[NR] = $2 " " $3; r[NR] = $4; tint[NR] = $5 }
      END {
        for (k = 1; k <= NR; ++k) {
          s = tint[k] * (0.55 + 0.45 * (depth[1] - depth[k]) / (depth[1] - depth[NR]))
          print line[k], r[k], int(120 * s) * 65536 + int(92 * s) * 256 + int(52 * s)
          print line[k], 0.86 * r[k], int(226 * s) * 65536 + int(188 * s) * 256 + int(120 * s)
        }
      }'
  echo EOD
  echo '$flanks << EOD'
  flank "$left" 0
  echo
  flank "$right" "$apart"
  echo EOD
  echo "plot \$balls using 1:2:3:4 with circles lc rgb variable, \$flanks with lines lw 3 lc rgb 0x2060c0"
} > picture.gp
if command -v gnuplot > /dev/null; then gnuplot --default-settings picture.gp; else echo "gnuplot not found: picture.gp is not drawn"; fi
