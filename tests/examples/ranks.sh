#!/usr/bin/env bash
# The program of a rig on several processes: two have the same bytes in all their results as one, and so have three that
# go on where two were killed. One that cannot write its results ends all of them, in words.
#
#   ranks.sh <mpiexec> <rig> <output folder> <text of the progress at which it is killed> <options>...
set -euo pipefail

mpiexec=$1 rig=$2 output=$3 after=$4
shift 4
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMP_NUM_THREADS=1

refuse() {
  echo "$1"
  tail -n 40 "$output"/*.txt
  exit 1
}
# on <ranks> <name> <options>...: runs the rig with results in a folder of this name.
on() {
  local ranks=$1 name=$2
  shift 2
  "$mpiexec" -n "$ranks" "$rig" "$@" --output "$output/$name" > "$output/$name.txt" 2>&1
}
compare() {
  local name=$1
  for file in $(cd "$output/one" && find . -type f ! -name report.html ! -name settings.toml); do
    cmp "$output/one/$file" "$output/$name/$file" || refuse "$name: $file differs from that of one process"
  done
}

rm -rf "$output"
mkdir -p "$output"
on 1 one "$@" || refuse "one process ended with $?"
on 2 two "$@" || refuse "two processes ended with $?"
compare two
[ "$(grep -c 'of wall time' "$output/two.txt")" = 1 ] || refuse "the report was not printed once"

on 2 killed "$@" --checkpoint-every 0.3 & run=$!
trap 'kill -KILL "$run" 2> /dev/null || true' EXIT
for ((k = 0; k < 3000; ++k)); do
  ! grep -qs "$after" "$output/killed.txt" || break
  sleep 0.02
done
pkill -KILL -f -- "--output $output/killed" || refuse "the run was over before '$after' was seen"
wait "$run" || true
sleep 0.5
on 3 killed "$@" --resume || refuse "three processes that went on ended with $?"
grep -q "Going on where" "$output/killed.txt" || refuse "nothing was gone on with"
compare killed

# A file stands where the folder is to be: the process that writes finds it, the others do not.
touch "$output/file"
status=0
"$mpiexec" -n 2 "$rig" "$@" --output "$output/file/results" > "$output/refused.txt" 2>&1 || status=$?
[ $status != 0 ] || refuse "a run without a folder to write to ended with 0"
grep -q "cannot make the folder" "$output/refused.txt" || refuse "it is not said that the folder cannot be made"
