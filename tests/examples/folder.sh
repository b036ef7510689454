#!/usr/bin/env bash
# One run at a time in a folder of the direct shear example; a run writes nothing over its own files; and what no machine
# can do is refused before it is begun.
#
#   folder.sh <direct_shear> <output folder> <packing file>
set -euo pipefail

rig=$1 output=$2 packing=$3
log=$output/log.txt run=

rm -rf "$output"
mkdir -p "$output"
trap '[ -z "$run" ] || kill -KILL "$run" 2> /dev/null || true' EXIT

fail() {
  echo "$1"
  cat "$log"
  exit 1
}

contents() { find "$output/shared" -type f -exec cksum {} + | sort; }

# refuse <words of the message> <option>...
refuse() {
  local words=$1 status=0
  shift
  timeout 60 "$rig" --size smoke --no-vtk "$@" > "$log" 2>&1 || status=$?
  [ "$status" = 2 ] || fail "With $* the run ended with $status, not with 2"
  grep -q -e "$words" "$log" || fail "With $* it does not say '$words'"
}

# Starts a run in the shared folder, and waits until it has begun.
start() {
  "$rig" --size smoke --no-vtk --packing-file "$packing" --travel 0.02 --output "$output/shared" > "$output/first.txt" 2>&1 &
  run=$!
  for ((k = 0; k < 600; ++k)); do
    ! grep -q 'consolidate' "$output/first.txt" || return 0
    sleep 0.1
  done
  fail "The first run does not begin"
}

start
before=$(contents)
refuse "'$output/shared' is in use by process $run (direct_shear)" --packing-file "$packing" --output "$output/shared"
refuse "in use by process $run" --relative-density 0 --output "$output/shared"
[ "$(contents)" = "$before" ] || fail "The second run touched what the first one has written"
kill -KILL "$run"
wait "$run" || true
run=

# A run that was killed holds nothing.
"$rig" --size smoke --no-vtk --packing-file "$packing" --travel 1e-4 --smoothing 1e-5 --ramp-time 0.002 \
  --output "$output/shared" > "$log" 2>&1 || fail "A killed run still holds the folder"
[ ! -e "$output/shared/run.lock" ] || fail "The lock is still there"

# The packing is no result, and goes nowhere where one will be.
before=$(contents)
for file in results.csv settings.toml report.html load_44.1kPa.csv shear_stress.png run.lock ../shared/report.html; do
  refuse 'the run writes a result of its own there' --output "$output/shared" --save-packing "$output/shared/$file"
done
[ "$(contents)" = "$before" ] || fail "A refused run touched earlier results"

refuse '--seed is -1, but must be a whole number' --seed -1
refuse '--grains is -5, but must be a whole number' --grains -5
refuse 'change --half-edge, or give --grains' --half-edge 1e-15
refuse 'take larger grains (--half-edge)' --half-edge 1e-15 --grains 385 --relative-density 0
refuse 'or less --shake-time' --packing poured --shake-time 1e9
refuse 'or less --densify-time' --densify-time 1e9
if (($(awk '/^MemTotal:/ { print $2 }' /proc/meminfo 2> /dev/null || echo 0) < 90000000)); then
  refuse 'GB of memory, but this machine has' --half-edge 5e-5 --grains 1e8
fi
