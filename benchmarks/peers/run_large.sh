#!/usr/bin/env bash
# 300,000 spheres in LAMMPS beside dem, in turn on one machine: million grain-steps a second, one line a run. LAMMPS's bed is
# settled once and kept in the folder (three minutes).
#
#   run_large.sh <settled_bed> <folder> [repeats]
#
# Needs Debian's lammps and python3. Other programs that run at the same time spoil the figures.
set -euo pipefail

bed=$(realpath "$1")
decks=$(cd "$(dirname "$0")" && pwd)
repeats=${3:-1}
mkdir -p "$2"
cd "$2"

lammps() { # <processes> <variables>...
  local processes=$1
  shift
  OMP_NUM_THREADS=1 mpirun --allow-run-as-root --bind-to core -np "$processes" lmp -in "$decks/spheres.lammps" \
    -log "large.$processes.log" -var periodic 1 "$@" > "large.$processes.out"
}
[ -s spheres.data ] || python3 "$decks/lattices.py" .
[ -s spheres1.settled ] || lammps 1 -var settle 50000

echo "program cores rate contacts-a-grain"
for _ in $(seq "$repeats"); do
  for cores in 1 2; do
    lammps $cores -var nx 5 -var ny 3 -var steps 500
    # The rate is that of the last loop; contacts are printed before that of the first.
    awk -v cores=$cores '/^Loop time/ { t = $4; if (!contacts) contacts = last } { last = $4 }
      END { printf "lammps %d %.3g %.2f\n", cores, 300000 * 500 / t / 1e6, contacts / 300000 }' "large.$cores.log"
  done
  "$bed" --work spheres --threads 2 --sizes 300000 --settle 40000 --steps 500 --repeats 3
done
