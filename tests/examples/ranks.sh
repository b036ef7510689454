#!/usr/bin/env bash
# The program of a rig on several processes: two have the same bytes in all their results as one, and so have three that
# go on where two were killed, and two that go on after one of them was killed, which ended the other within seconds. One
# that cannot write its results ends all of them, in words.
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

trap 'pkill -KILL -f -- "--output $output/" || true' EXIT
# begin <name> <options>...: starts a run of two processes, and waits until it has come far enough to be killed.
begin() {
  local name=$1
  shift
  on 2 "$name" "$@" --checkpoint-every 0.3 & run=$!
  for ((k = 0; k < 3000; ++k)); do
    ! grep -qs "$after" "$output/$name.txt" || break
    sleep 0.02
  done
}

begin killed "$@"
pkill -KILL -f -- "--output $output/killed" || refuse "the run was over before '$after' was seen"
wait "$run" || true
sleep 0.5
on 3 killed "$@" --resume || refuse "three processes that went on ended with $?"
grep -q "Going on where" "$output/killed.txt" || refuse "nothing was gone on with"
compare killed

# One process alone dies: the launcher ends the other, and says what happened.
begin bereft "$@"
dead=
for process in $(pgrep -f -- "--output $output/bereft"); do
  ! grep -zEqx '(OMPI_COMM_WORLD_RANK|PMI_RANK)=1' "/proc/$process/environ" || dead=$process
done
[ -n "$dead" ] || refuse "there is no process 1 of a run that has come to '$after'"
died=$(date +%s)
kill -KILL "$dead"
status=0
timeout 60 tail --pid="$run" -f /dev/null || refuse "the other process still ran a minute after one was killed"
wait "$run" || status=$?
((status != 0)) || refuse "a run of which one process was killed ended with 0"
(($(date +%s) - died <= 15)) || refuse "the other process ended $(($(date +%s) - died)) s after one was killed"
grep -Eqi 'signal 9|killed' "$output/bereft.txt" || refuse "it is not said that a process was killed"
for ((k = 0; k < 50; ++k)); do  # one that was killed may still be on its way out
  pgrep -f -- "--output $output/bereft" > /dev/null || break
  sleep 0.1
done
((k < 50)) || refuse "a process outlived the run of which one was killed"
on 2 bereft "$@" --resume || refuse "two processes that went on after one was killed ended with $?"
grep -q "Going on where" "$output/bereft.txt" || refuse "nothing was gone on with after one process was killed"
compare bereft

# A file stands where the folder is to be: the process that writes finds it, the others do not.
touch "$output/file"
status=0
"$mpiexec" -n 2 "$rig" "$@" --output "$output/file/results" > "$output/refused.txt" 2>&1 || status=$?
[ $status != 0 ] || refuse "a run without a folder to write to ended with 0"
grep -q "cannot make the folder" "$output/refused.txt" || refuse "it is not said that the folder cannot be made"
