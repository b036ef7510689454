#!/usr/bin/env bash
# Runs that a rig makes side by side, one a thread, end with the same bytes in all their results as on one thread, where
# they go one after the other, and on more threads than there are runs.
#
#   side_by_side.sh <rig> <output folder> <options>...
set -euo pipefail

rig=$1 output=$2
shift 2

refuse() {
  echo "$1"
  tail -n 40 "$output"/*.txt
  exit 1
}

rm -rf "$output"
mkdir -p "$output"
for threads in 1 2 5; do
  "$rig" "$@" --threads $threads --output "$output/$threads" > "$output/$threads.txt" 2>&1 ||
    refuse "the run on $threads threads ended with $?"
  for file in $(cd "$output/1" && find . -type f ! -name report.html ! -name settings.toml); do
    cmp "$output/1/$file" "$output/$threads/$file" || refuse "$file differs on $threads threads"
  done
done
echo "The same side by side"
