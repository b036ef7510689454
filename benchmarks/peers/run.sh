#!/usr/bin/env bash
# The beds of settled_bed in LAMMPS and LIGGGHTS beside dem, in turn on one machine: million grain-steps a second, one line a
# run. The beds are settled once and kept in the folder (some ten minutes on two cores).
#
#   run.sh <settled_bed> <folder> [repeats]
#
# Needs Debian's lammps, liggghts and python3. Other programs that run at the same time spoil the figures.
set -euo pipefail

bed=$(realpath "$1")
decks=$(cd "$(dirname "$0")" && pwd)
repeats=${3:-3}
mkdir -p "$2"
cd "$2"
export OMP_NUM_THREADS=1 # of LAMMPS and LIGGGHTS, which run as processes

# mpi <processes> <program> <deck> <variables>...: it is done when its loops are, as LIGGGHTS' quit counts as a failure
mpi() {
  local launch=() processes=$1 program=$2 deck=$3
  shift 3
  if [ "$processes" -gt 1 ]; then launch=(mpirun --allow-run-as-root --bind-to core -np "$processes"); fi
  "${launch[@]}" "$program" -in "$decks/$deck" -log "$deck.$processes.log" "$@" > "$deck.$processes.out" 2>&1 || true
  if grep -q '^ERROR' "$deck.$processes.out" || ! grep -q '^Loop time' "$deck.$processes.log"; then
    echo "$program failed, see $PWD/$deck.$processes.out" >&2
    exit 1
  fi
}
# settle <bed> <program> <deck> <steps>, two at a time
settle() { [ -s "$1" ] || mpi 1 "$2" "$3" -var settle "$4"; }
[ -s spheres.data ] || python3 "$decks/lattices.py" .
cp "$decks/cube.multisphere" .
settle spheres0.settled lmp spheres.lammps 50000 &
first=$!
settle spheres_l.restart liggghts spheres.liggghts 50000
wait $first
settle cubes.restart lmp cubes.lammps 60000 &
first=$!
settle cubes_l.restart liggghts cubes.liggghts 60000
wait $first

line() { # <work> <program> <processes> <grains>: from the last loop, of 5,000 steps
  awk -v what="$1 $2 $3" -v grains="$4" '/^Loop time/ { t = $4 } END { printf "%s %.3g\n", what, grains * 5000 / t / 1e6 }' \
    "$1.$2.$3.log"
}
echo "work program cores rate"
for _ in $(seq "$repeats"); do
  for cores in 1 2; do
    mpi $cores lmp spheres.lammps && line spheres lammps $cores 20000
    mpi $cores liggghts spheres.liggghts && line spheres liggghts $cores 20000
    mpi $cores lmp cubes.lammps && line cubes lammps $cores 4000
  done
  mpi 1 liggghts cubes.liggghts && line cubes liggghts 1 4000
done
"$bed" --one --work cubes --threads 2 --settle 22000 --steps 5000 --repeats "$repeats"
"$bed" --one --work spheres --threads 2 --settle 40000 --steps 5000 --repeats "$repeats"
