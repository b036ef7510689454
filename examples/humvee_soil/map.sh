#!/usr/bin/env bash
# A mobility map on grains: the car on slopes of soils of several relative densities, side by side, one run on each
# thread. Prints a table: how each run ended, its speed and its energy for a metre. A map that was stopped goes on with
# the same command: runs that have ended are not made again, one that was stopped goes on from what it kept.
#
#   map.sh <humvee_soil> <folder> [more options of humvee_soil]
#
# SLOPES (percent), DENSITIES (0 to 1; 0: as rained), JOBS and KEEP (s, after which a run is kept again; 0: never, as in a
# program without HDF5) are taken from the environment.
set -euo pipefail

[ $# -ge 2 ] || { sed -n 's/^#   //p' "$0" >&2 && exit 2; }
car=$(realpath "$1")
mkdir -p "$2"
cd "$2"
shift 2
slopes=${SLOPES:-0 10 20}
densities=${DENSITIES:-0 0.5}
jobs=${JOBS:-$(nproc)}
export keep=${KEEP:-600}
if "$car" --resume --output none 2>&1 | grep -q 'needs HDF5'; then keep=0; fi

# drive <name> <options>...: a run, unless it is there.
drive() {
  local name=$1
  shift
  [ ! -e "$name/done" ] || return 0
  local kept=()
  [ "$keep" = 0 ] || kept=(--checkpoint-every "$keep")
  if compgen -G "$name/checkpoint/*.h5" > /dev/null; then kept+=(--resume); fi
  if "$car" "$@" "${kept[@]}" --threads 1 --no-vtk --no-replay --output "$name" > "$name.log" 2>&1; then
    touch "$name/done"
  else
    echo "$name did not end well: see $PWD/$name.log" >&2
  fi
}
export -f drive
export car

first=${slopes%% *}
options_of() {
  local scene=(--scene slope --slope "$2")
  [ "$2" != 0 ] || scene=(--scene level)
  [ "$1" = 0 ] || scene+=(--relative-density "$1")
  echo "${scene[@]}"
}
# The first slope of each soil makes its bed, and all others start from it.
for density in $densities; do
  echo "density_${density}_slope_$first" $(options_of "$density" "$first") "$@"
done | xargs -P "$jobs" -L 1 bash -c 'drive "$@"' drive
for density in $densities; do
  for slope in $slopes; do
    bed=density_${density}_slope_$first/bed.txt
    [ "$slope" = "$first" ] || [ ! -s "$bed" ] ||
      echo "density_${density}_slope_$slope" $(options_of 0 "$slope") --bed-file "$bed" "$@"
  done
done | xargs -r -P "$jobs" -L 1 bash -c 'drive "$@"' drive

echo "density  slope [%]  ended       way [m]  speed [m/s]  slip   of the weight  energy [kJ/m]"
for density in $densities; do
  for slope in $slopes; do
    csv=density_${density}_slope_$slope/results.csv
    [ -e "${csv%results.csv}done" ] || continue
    awk -F, -v d="$density" -v s="$slope" '
      function cell(name, scale, digits) { return $at[name] == "" ? "-" : sprintf("%.*f", digits, scale * $at[name]) }
      NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k }
      NR == 2 { printf "%-7s  %-9s  %-10s  %7s  %11s  %5s  %13s  %13s\n", d, s, $at["ended"], cell("way_m", 1, 2),
                       cell("speed_m_per_s", 1, 2), cell("slip_(omega*r-v)/max", 1, 2), cell("resistance_N", 1 / $at["weight_N"], 3),
                       cell("energy_per_metre_J_per_m", 1e-3, 1) }' "$csv"
  done
done
