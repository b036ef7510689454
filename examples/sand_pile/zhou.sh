#!/usr/bin/env bash
# Spheres with rolling resistance, left on the floor of a box that is emptied through a slot, beside the fit of
# Zhou, Xu, Yu and Zulli (Powder Technology 125, 2002): phi = 68.61 mu_pp^0.27 mu_pw^0.22 m_pp^0.06 m_pw^0.12 d^-0.2,
# with the rolling lengths m and the diameter d in mm. Prints a table. Runs that are there already are not made again.
# Rolling meets a constant torque, as in the simulations of the fit. KIND=sphere-rolling has springs instead.
#
# WIDTH and LENGTH are those of the box in diameters (20, 28), GRAINS the spheres in it (8333).
#
#   zhou.sh <sand_pile> <folder> [seeds]
set -euo pipefail

[ $# -ge 2 ] || { sed -n 's/^#   //p' "$0" >&2 && exit 2; }
rig=$(realpath "$1")
seeds=${3:-1}
kind=${KIND:-sphere-braked}
length_d=${LENGTH:-28} width_d=${WIDTH:-20} grains=${GRAINS:-8333}
mkdir -p "$2"
cd "$2"

# d, mu_pp, mu_pw, m_pp, m_pw: diameter (mm), sliding friction of grains and of walls, rolling lengths (mm).
points="10 0.4 0.5 0.05 0.1
10 0.2 0.2 1 1
10 0.4 0.4 0.2 0.2
10 0.6 0.6 0.1 0.1
10 0.4 0.5 0.5 0.5
5 0.4 0.5 0.05 0.1"

echo "$kind, piles of each: $seeds"
echo "  d    mu_pp mu_pw  m_pp  m_pw    fit   here  (deg)"
while read -r d mu_pp mu_pw m_pp m_pw; do
  name=${kind}_x${seeds}_${length_d}x${width_d}_${grains}_d${d}_${mu_pp}_${mu_pw}_${m_pp}_${m_pw}
  # A floor 28 d long, filled 11 d high: a slope of 22 deg reaches its back wall. It is 20 d wide, as the box of the fit
  # was with 10 mm (1 x 1 x 0.2 m): between closer walls slopes stand steeper. A sphere of diameter d has the volume of a
  # cube of half-edge 0.403 d. K is about as soft as the 1 MPa of the fit: 3.6 kN/m for 10 mm.
  read -r half width slot length m1 m2 <<< "$(awk -v d="$d" -v a="$m_pp" -v b="$m_pw" -v w="$width_d" -v l="$length_d" 'BEGIN {
    print d * 4.02998e-4, 1e-3 * w * d, 5e-3 * d, 1e-3 * l * d, 1e-3 * a, 1e-3 * b }')"
  # A run that was stopped is made again.
  awk -F, 'NR > 1 && $15 != 1 { open = 1 } END { exit open || NR < 2 }' "$name/results.csv" 2> /dev/null || "$rig" --size quick --method drain --plate flat --kinds "$kind" --density 2400 \
    --half-edge "$half" --grains "$grains" --box-width "$width" --slot-width "$slot" --box-length "$length" \
    --friction "$mu_pp" --plate-friction "$mu_pw" --rolling-length "$m1" --plate-rolling-length "$m2" \
    --stiffness 200 --rest-limit 2 --creep-time 0.2 --seeds "$seeds" --no-vtk --no-replay \
    --threads "${THREADS:-1}" --output "$name" > "$name.log" 2>&1 || echo "  $name: not all piles were made, see $name.log" >&2
  awk -F, -v d="$d" -v a="$mu_pp" -v b="$mu_pw" -v m="$m_pp" -v n="$m_pw" '
    NR > 1 && $15 == 1 && $3 != "" { sum += $3; ++count }
    END { if (count) printf "%4g %7g %5g %5g %5g  %5.1f  %5.1f\n", d, a, b, m, n,
                            68.61 * a^0.27 * b^0.22 * m^0.06 * n^0.12 * d^-0.2, sum / count }' "$name/results.csv"
done <<< "$points"
