#!/usr/bin/env bash
# The full-size runs behind RESULTS.md: three packings, and on each of them half the time step and half the shearing
# speed; a loose and a dense packing; the predictor-corrector; the thesis's poured block, and its softer grains. Prints a
# table. Runs that are there already are not made again, so it may be stopped (Ctrl-C) and called again. Several of it
# may share a folder and so the work, best with different parts: a run that another one is at is waited for.
#
#   study.sh <direct_shear> <folder> [seeds|half_step|half_speed|density|integrator|poured|soft ...]
#
# THREADS (1 unless it is set) is how many threads a run has. A packing and its three loads take 35 to 40 minutes on one
# core at 2.3 GHz; all of them, by that, more than ten hours.
set -euo pipefail

[ $# -ge 2 ] || { sed -n 's/^#   //p' "$0" >&2 && exit 2; }
rig=$(realpath "$1")
folder=$2
shift 2
[ $# -gt 0 ] || set -- seeds half_step half_speed density integrator poured soft
mkdir -p "$folder"
cd "$folder"
[ -w . ] || { echo "cannot write in $folder" >&2 && exit 1; }

is_done() { [ -s "$1/results.csv" ] && [ "$(grep -c ',1$' "$1/results.csv")" = 3 ]; }

# run <name> <options>...: unless it is done. One script at a time makes a run: the others wait for its lock, a folder,
# which only one of them can make.
lock=
trap '[ -z "$lock" ] || rmdir "$lock"' EXIT
trap 'exit 130' INT TERM # when the rig has ended, so that its lock lasts as long as it does
run() {
  local name=$1 told= status=0
  shift
  until mkdir "$name.lock" 2> /dev/null; do
    ! is_done "$name" || return 0
    [ -n "$told" ] || echo "$name: waiting, another study is at it; if none is, remove the folder $folder/$name.lock"
    told=1
    sleep 5
  done
  lock=$name.lock
  if ! is_done "$name"; then
    echo "$name: $*"
    "$rig" --size full --no-vtk --threads "${THREADS:-1}" --output "$name" "$@" > "$name.log" 2>&1 || status=$?
    [ $status != 130 ] || { echo "  interrupted, see $folder/$name.log" && exit 130; }
    [ $status = 0 ] || echo "  ended early, see $folder/$name.log"
  fi
  rmdir "$lock"
  lock=
}
# The step that a finished run took (s), halved.
half_step_of() { sed -n 's/^Time step \([0-9.e-]*\) s.*/\1/p' "$1.log" | awk '{print $1 / 2}'; }

for part in "$@"; do
  case $part in
    seeds) for seed in 1 2 3; do run "seed_$seed" --seed "$seed"; done ;;
    half_step)
      for seed in 1 2 3; do
        run "seed_$seed" --seed "$seed"
        run "half_step_$seed" --packing-file "seed_$seed/packing.txt" --time-step "$(half_step_of "seed_$seed")"
      done ;;
    half_speed)
      for seed in 1 2 3; do
        run "seed_$seed" --seed "$seed"
        run "half_speed_$seed" --packing-file "seed_$seed/packing.txt" --shear-speed 0.01
      done ;;
    density)
      run loose --relative-density 0
      run dense --relative-density 0.5 ;;
    integrator)
      run seed_1 --seed 1
      run predictor_corrector --packing-file seed_1/packing.txt --integrator predictor-corrector ;;
    poured) run poured --packing poured ;;
    soft) run soft --stiffness 2000 ;;
    *)
      echo "no part '$part'; there are seeds, half_step, half_speed, density, integrator, poured and soft" >&2
      exit 1 ;;
  esac
done

# table <column of results.csv> <what it is>: kPa, and of the maxima (column 3) the difference to table 3.3 of the thesis,
# which has no others, in per cent; means over the seeds of each kind of run. A maximum is sharp to some per cent only, as
# stress swings while grains rearrange; the mean over the last quarter of the travel tells finer what step or speed change.
table() {
  echo
  awk -F, -v column="$1" -v title="$2" '
    FNR == 1 { run = FILENAME; sub("/results.csv", "", run); if (!(run in seen)) order[++runs] = run; seen[run] = 1; next }
    $12 == 1 {
      thesis = $2 < 3e4 ? 13.483 : $2 < 6e4 ? 33.794 : 56.129
      k = $2 < 3e4 ? 1 : $2 < 6e4 ? 2 : 3
      stress = $column / 1e3
      text[run, k] = sprintf("%6.2f", stress)
      if (column == 3) text[run, k] = text[run, k] sprintf(" (%+5.1f %%)", 100 * (stress / thesis - 1))
      kind = run; sub("_[0-9]+$", "", kind)
      if (!(kind in known)) { kinds[++n] = kind; known[kind] = 1 }
      sum[kind, k] += stress; count[kind, k]++
    }
    END {
      printf "%-22s %17s %17s %17s\n", title, "16.9 kPa", "44.1 kPa", "71.4 kPa"
      for (i = 1; i <= runs; i++) printf "%-22s %17s %17s %17s\n", order[i], text[order[i], 1], text[order[i], 2], text[order[i], 3]
      for (i = 1; i <= n; i++) {
        printf "%-22s", "mean of " kinds[i]
        for (k = 1; k <= 3; k++) printf " %10.2f of %2d  ", count[kinds[i], k] ? sum[kinds[i], k] / count[kinds[i], k] : 0, count[kinds[i], k]
        print ""
      }
    }' ./*/results.csv | sed 's/\.\///'
}
table 3 "maximum shear"
table 5 "mean of last quarter"
