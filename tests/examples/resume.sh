#!/usr/bin/env bash
# A rig that is killed at random moments, again and again, and goes on each time, ends with the same bytes in all its CSV
# files as a run that was never stopped, and with the same numbers in what it prints.
#
#   resume.sh <rig> <output folder> <kills> <options>...
set -euo pipefail

rig=$1 output=$2 kills=$3
shift 3
RANDOM=${SEED:-1}
export OMP_NUM_THREADS=2

refuse() {
  echo "$1"
  [ ! -e "$output/killed.txt" ] || tail -n 40 "$output/killed.txt"
  exit 1
}
milliseconds() { date +%s%3N; }

[ -x "$rig" ] || refuse "there is no program '$rig'; build it first"
if ! "$rig" --help | grep -q -- --resume || "$rig" --resume --output "$output/none" 2>&1 | grep -q 'needs HDF5'; then
  echo "the rig was built without HDF5: not tested"
  exit 77
fi

rm -rf "$output"
mkdir -p "$output"
trap 'kill -KILL "$run" 2> /dev/null || true' EXIT
start=$(milliseconds)
"$rig" "$@" --output "$output/whole" > "$output/whole.txt" 2>&1 & run=$!
wait "$run" || refuse "the run that is not stopped ended with $?"
whole=$(($(milliseconds) - start))
# Often enough to go on from within each stage, and seldom enough for most of the time to go into the run.
every=$(awk -v w="$whole" 'BEGIN { e = 2e-5 * w; print (e > 0.05 ? e : 0.05) }')

# Each kill comes after up to a tenth of the run: so it dies in all its stages, at times before anything is kept anew.
done=0 gone_on=0 resume=()
for ((kill = 1; kill <= kills && done == 0; ++kill)); do
  "$rig" "$@" --output "$output/killed" --checkpoint-every "$every" "${resume[@]}" > "$output/killed.txt" 2>&1 & run=$!
  wait_s=$(awk -v w="$whole" -v r="$RANDOM" -v k="$kill" -v n="$kills" 'BEGIN { print 0.02 + 1e-3 * w * (3 / n + 0.1 * r / 32768) }')
  sleep "$wait_s"
  if kill -KILL "$run" 2> /dev/null; then
    wait "$run" 2> /dev/null || true
  else
    wait "$run" || refuse "run $kill ended with $? by itself"
    done=1
  fi
  ! grep -q '^Going on' "$output/killed.txt" || gone_on=$((gone_on + 1))
  [ ! -s "$output/killed/settings.toml" ] || resume=(--resume)
done
killed=$((kill - 1))
if ((done == 0)); then
  "$rig" "$@" --output "$output/killed" --resume > "$output/killed.txt" 2>&1 & run=$!
  wait "$run" || refuse "the last run ended with $?"
fi
((gone_on > 0)) || refuse "no run went on from where it was kept"

# All but what a second of the run took, which is another each time.
timeless() { awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^computing/) at = i } { if (at) $at = ""; print }' "$1"; }
for file in "$output"/whole/*.csv "$output"/whole/*.pvd "$output"/whole/*.txt; do
  [ -e "$file" ] || continue
  cmp <(timeless "$file") <(timeless "$output/killed/$(basename "$file")") || refuse "$(basename "$file") is not what it is without a stop"
done
diff -rq "$output/whole" "$output/killed" | grep -v -e report.html -e settings.toml -e '\.png' || true
numbers() { sed -n '/^Report/!{/wall time/!p}' "$1" | grep -v -e ': started' -e ' %, ' -e ': done in' -e 'Going on' -e anew -e '^Replacing' || true; }
diff <(numbers "$output/whole.txt") <(numbers "$output/killed.txt") || refuse "the printed report differs"
[ ! -e "$output/killed/checkpoint" ] || refuse "files to go on from are left"
echo "The same after $killed kills, $gone_on of which it went on after"
