#!/usr/bin/env bash
# The script that drives a map of slopes and densities, with a stand-in for the car: each cell is driven once, from the
# bed of its density, with the options that it is for; one that was stopped goes on, and no other is driven again.
#
#   map.sh <examples/humvee_soil/map.sh> <output folder>
set -euo pipefail

map=$1 output=$2
rm -rf "$output"
mkdir -p "$output"
cat > "$output/car" << 'CAR'
#!/usr/bin/env bash
[ "$1" != --resume ] || exit 1  # asked whether it can
echo "$*" >> ../runs.txt
while [ $# -gt 0 ]; do [ "$1" != --output ] || out=$2; shift; done
mkdir -p "$out"
echo grains > "$out/bed.txt"
[ ! -e ../fail ] || [ "$out" != density_0.5_slope_20 ] || { mkdir -p "$out/checkpoint" && touch "$out/checkpoint/drive.h5" && exit 1; }
printf 'ended,way_m,speed_m_per_s,slip_(omega*r-v)/max,resistance_N,weight_N,energy_per_metre_J_per_m\n' > "$out/results.csv"
printf 'arrived,3,1.5,0.1,4000,48000,\n' >> "$out/results.csv"
CAR
chmod +x "$output/car"

touch "$output/fail"
SLOPES="10 20" DENSITIES="0 0.5" bash "$map" "$output/car" "$output/map" --half-edge 30e-3 > "$output/first.txt" 2>&1
[ "$(grep -c ' arrived ' "$output/first.txt")" = 3 ] || { cat "$output/first.txt" && exit 1; }
rm "$output/fail"
SLOPES="10 20" DENSITIES="0 0.5" bash "$map" "$output/car" "$output/map" --half-edge 30e-3 > "$output/second.txt" 2>&1
[ "$(grep -c ' arrived  *3.00  *1.50  *0.10  *0.083  *-$' "$output/second.txt")" = 4 ] || { cat "$output/second.txt" && exit 1; }
diff <(LC_ALL=C sort "$output/runs.txt" | sed 's/ --checkpoint-every 600//; s/ --threads 1 --no-vtk --no-replay//') - << 'RUNS'
--scene slope --slope 10 --half-edge 30e-3 --output density_0_slope_10
--scene slope --slope 10 --relative-density 0.5 --half-edge 30e-3 --output density_0.5_slope_10
--scene slope --slope 20 --bed-file density_0.5_slope_10/bed.txt --half-edge 30e-3 --resume --output density_0.5_slope_20
--scene slope --slope 20 --bed-file density_0.5_slope_10/bed.txt --half-edge 30e-3 --output density_0.5_slope_20
--scene slope --slope 20 --bed-file density_0_slope_10/bed.txt --half-edge 30e-3 --output density_0_slope_20
RUNS
