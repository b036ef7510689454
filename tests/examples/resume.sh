#!/usr/bin/env bash
# A rig that is killed at random moments, again and again, and goes on each time, ends with the same bytes in all its
# files (CSV, frames, beds, scripts of plots) as a run that was never stopped, and with the same numbers in what it prints.
# It goes on with its folder written otherwise. Only kills that hit a running program count. A run that comes to its end
# before there were enough of them is compared, and the next one is begun.
#
#   resume.sh <rig> <output folder> <kills> <options>...
#
# Lines that match TOLD_ONCE, if it is set, are those that a run which goes on does not tell again.
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

# All but what a second of the run took, which is another each time: a column of its own, the last of a table.
timeless() { awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^computing/) at = i } { if (at) $at = ""; print }' "$1"; }
numbers() {
  sed -n '/^Report/!{/wall time/!p}' "$1" | grep -v -e ': started' -e ' %, ' -e ': done in' -e 'Going on' -e anew -e "^Replacing${TOLD_ONCE:+\|$TOLD_ONCE}" |
    awk '/ computing *$/ { cut = 1 } /^ *$/ { cut = 0 } { if (cut) sub(/ +[^ ]+ *$/, ""); print }' || true
}
# The killed run, which is at its end, is as the whole one.
compare() {
  for file in "$output"/whole/*.csv "$output"/whole/*.pvd "$output"/whole/*.txt; do
    [ -e "$file" ] || continue
    cmp <(timeless "$file") <(timeless "$output/killed/$(basename "$file")") || refuse "$(basename "$file") is not what it is without a stop"
  done
  # All that is in the folders below, and frames: no pages, which tell the wall time, nor settings, which name the folder.
  local differing
  differing=$(diff -rq "$output/whole" "$output/killed" |
    grep -v -e report.html -e settings.toml -e '\.png' -e '/whole/[^/]*\.csv and ' || true)
  [ -z "$differing" ] || refuse "$differing"
  diff <(numbers "$output/whole.txt") <(numbers "$output/killed.txt") || refuse "the printed report differs"
  [ ! -e "$output/killed/checkpoint" ] || refuse "files to go on from are left"
}

# A kill may hit a run that has just removed what it could go on from, as its last act.
has_ended() { grep -q 'has ended, or kept nothing' "$output/killed.txt"; }

# Each kill comes after up to a fifth of the run, so that it dies in all its stages, at times before anything is kept anew.
killed=0 gone_on=0 ends=0 resume=()
while ((killed < kills && ends <= kills)); do
  "$rig" "$@" --output "$output/${resume[0]:+./}killed" --checkpoint-every "$every" "${resume[@]}" > "$output/killed.txt" 2>&1 & run=$!
  wait_s=$(awk -v w="$whole" -v r="$RANDOM" -v n="$kills" 'BEGIN { print 0.02 + 1e-3 * w * (0.6 / n + 0.2 * r / 32768) }')
  sleep "$wait_s"
  kill -KILL "$run" 2> /dev/null || true
  status=0
  wait "$run" 2> /dev/null || status=$?
  ! grep -q '^Going on' "$output/killed.txt" || gone_on=$((gone_on + 1))
  case $status in
    137) killed=$((killed + 1)) ;;
    0)
      compare
      ends=$((ends + 1))
      rm -rf "$output/killed"
      ;;
    *)
      has_ended || refuse "run $((killed + ends + 1)) ended with $status by itself"
      rm -rf "$output/killed"
      ;;
  esac
  resume=()
  [ ! -s "$output/killed/settings.toml" ] || resume=(--resume)
done
((killed == kills)) || refuse "only $killed of $kills kills hit a running program, which came to its end $ends times"
for ((end = 0; end < 2; ++end)); do
  "$rig" "$@" --output "$output/${resume[0]:+./}killed" "${resume[@]}" > "$output/killed.txt" 2>&1 & run=$!
  status=0
  wait "$run" || status=$?
  ((status != 0)) || break
  has_ended || refuse "the last run ended with $status"
  rm -rf "$output/killed"
  resume=()
done
! grep -q '^Going on' "$output/killed.txt" || gone_on=$((gone_on + 1))
compare
((gone_on > 0)) || refuse "no run went on from where it was kept"
echo "The same after $killed kills that hit a running program, $gone_on of which it went on after"
