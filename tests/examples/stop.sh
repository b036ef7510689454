#!/usr/bin/env bash
# A rig that is asked to stop (SIGTERM, as by Ctrl-C) saves where it is, however seldom it saves by itself, and goes on
# from there: it ends with the same bytes in all its CSV files as a run that was never stopped.
#
#   stop.sh <rig> <output folder> <text of the progress at which it is stopped> <options>...
set -euo pipefail

rig=$1 output=$2 after=$3
shift 3
export OMP_NUM_THREADS=2

refuse() {
  echo "$1"
  [ ! -e "$output/stopped.txt" ] || tail -n 40 "$output/stopped.txt"
  exit 1
}

if "$rig" --resume --output "$output/none" 2>&1 | grep -q 'needs HDF5'; then
  echo "the rig was built without HDF5: not tested"
  exit 77
fi

rm -rf "$output"
mkdir -p "$output"
trap 'kill -KILL "$run" 2> /dev/null || true' EXIT
"$rig" "$@" --output "$output/whole" > "$output/whole.txt" 2>&1 & run=$!
wait "$run" || refuse "the run that is not stopped ended with $?"

"$rig" "$@" --output "$output/stopped" --checkpoint-every 1e6 > "$output/stopped.txt" 2>&1 & run=$!
for ((k = 0; k < 3000; ++k)); do
  ! grep -q "$after" "$output/stopped.txt" || break
  sleep 0.02
done
kill -TERM "$run" || refuse "the run was over before '$after' was seen"
status=0
wait "$run" || status=$?
[ $status = 130 ] || refuse "a run that was asked to stop ended with $status, not 130"
(($(ls "$output"/stopped/checkpoint/*.h5 | wc -l) >= ${PARTS:-1})) || refuse "it did not save all parts that it was in"

"$rig" "$@" --output "$output/stopped" --resume > "$output/stopped.txt" 2>&1 & run=$!
wait "$run" || refuse "the run that went on ended with $?"
grep -q '^Going on' "$output/stopped.txt" || refuse "it began anew"
for file in "$output"/whole/*.csv; do
  cmp "$file" "$output/stopped/$(basename "$file")" || refuse "$(basename "$file") is not what it is without a stop"
done
echo "The same after a stop"
