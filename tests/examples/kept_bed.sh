#!/usr/bin/env bash
# settle_ranks with a bed that is kept: one process settles it, two go on from the file to the state of a run that was not
# broken off, also where it is laid of tiles; another number of grains is refused. What it refuses is told once, in
# words, and ends both with 1.
#
#   kept_bed.sh <mpiexec> <settle_ranks> <output folder>
set -euo pipefail

mpiexec=$1 program=$2 output=$3
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

rm -rf "$output"
mkdir -p "$output"
# on <ranks> <name> <options>...: the state at the end.
on() {
  local ranks=$1 name=$2
  shift 2
  "$mpiexec" -n "$ranks" "$program" --steps 50 --threads 1 --output "$output/$name" "$@" | tee "$output/$name.txt" | grep '^state'
}
whole=$(on 1 whole --grains 600 --settle 200)
made=$(on 1 made --grains 600 --settle 200 --bed "$output/bed.h5")
taken=$(on 2 taken --grains 600 --bed "$output/bed.h5")
if [ "$whole" != "$made" ] || [ "$whole" != "$taken" ]; then
  echo "unbroken: $whole; as the bed is kept: $made; on two processes from the file: $taken"
  exit 1
fi
# A bed of tiles that two processes lay is that of one, and goes on from the file.
alone=$(on 1 alone --grains 1200 --tiles 5 --settle 2000)
laid=$(on 2 laid --grains 1200 --tiles 5 --settle 2000 --bed "$output/tiles.h5")
again=$(on 1 again --grains 1200 --tiles 5 --bed "$output/tiles.h5")
if [ "$alone" != "$laid" ] || [ "$alone" != "$again" ]; then
  echo "tiles of one process: $alone; of two: $laid; from the file: $again"
  exit 1
fi
# refused <text> <options>...: two processes end in these words, with 1.
refused() {
  local text=$1 status=0
  shift
  "$mpiexec" -n 2 "$program" --threads 1 "$@" > "$output/refused.txt" 2>&1 || status=$?
  if [ $status != 1 ] || [ "$(grep -c "$text" "$output/refused.txt")" != 1 ] || grep -q "terminate called" "$output/refused.txt"; then
    echo "$*: ended with $status, and not once in the words '$text':"
    cat "$output/refused.txt"
    exit 1
  fi
}
refused "has 600 grains, but --grains is 601" --grains 601 --bed "$output/bed.h5" --output "$output/refused"
refused "tiles 7 must divide" --grains 1200 --tiles 7
refused "settle_ranks: --grain is no option of this program" --grain 600
# A file stands where the folder is to be, which the process that writes finds alone.
touch "$output/file"
refused "rank 0 of 2: settle_ranks: cannot make the folder" --grains 600 --settle 10 --steps 10 --output "$output/file"
"$mpiexec" -n 2 "$program" --help | grep -q -- "--grains 20000 "
