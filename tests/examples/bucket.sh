#!/usr/bin/env bash
# A program with stages of its own, which keeps its world by save() and load(): stopped by SIGTERM while its bed is made,
# and killed while it digs, it ends with the same bytes as a run that was not.
#
#   bucket.sh <bucket> <output folder>
set -euo pipefail

bucket=$1 output=$2
options=(--half-edge 4e-3 --seconds 0.4)
export OMP_NUM_THREADS=2

refuse() {
  echo "$1"
  exit 1
}
rm -rf "$output"
mkdir -p "$output"
trap '[ -z "$run" ] || kill -KILL "$run" 2> /dev/null || true' EXIT
run=

# until_there <file>: waits for what a run writes on its way.
until_there() {
  while [ ! -e "$1" ]; do
    kill -0 "$run" 2> /dev/null || refuse "the run ended before it wrote $1"
    sleep 0.05
  done
}

"$bucket" "${options[@]}" --output "$output/whole" > "$output/whole.txt" || refuse "the run that is not stopped ended with $?"
[ -e "$output/whole/bed.h5" ] && [ ! -e "$output/whole/digging.h5" ] || refuse "a bed is to be left, and nothing of the digging"

# What lies in the bucket weighs what the sensor reads. Some grains lie on its rims: with these coarse ones 0.39 N were
# counted where the sensor read 0.40 N, with those of half the size 0.50 and 0.52 N. A grain more or less is 3 % here.
awk '/weigh/ { share = $9 / $14 } END { exit !(share > 0.7 && share < 1.1) }' "$output/whole.txt" || refuse "$(tail -n 1 "$output/whole.txt")"

"$bucket" "${options[@]}" --every 0.2 --output "$output/stopped" > "$output/stopped.txt" & run=$!
until_there "$output/stopped/bed.h5"
kill -TERM "$run"
code=0
wait "$run" || code=$?
run=
[ "$code" = 130 ] || refuse "after SIGTERM it ended with $code"
[ ! -e "$output/stopped/digging.h5" ] || refuse "it was stopped too late: it dug already"

"$bucket" "${options[@]}" --every 0.2 --output "$output/stopped" > "$output/stopped.txt" & run=$!
until_there "$output/stopped/digging.h5"
kill -KILL "$run"
wait "$run" 2> /dev/null || true
run=
rm -f "$output"/stopped/*.tmp  # of a save that was under way

"$bucket" "${options[@]}" --output "$output/stopped" > "$output/stopped.txt" || refuse "the run that goes on ended with $?"
diff "$output/whole.txt" "$output/stopped.txt" || refuse "it tells something else"
diff -rq -x '*.png' "$output/whole" "$output/stopped" || refuse "files differ"
echo "the same after a stop and a kill"
