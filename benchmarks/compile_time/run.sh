#!/usr/bin/env bash
# What compiling costs: CPU seconds and peak memory of the compiler, beside the budgets, as the table of RESULTS.md.
#
#   run.sh [repeats]       CXX names another compiler than g++
#
# Needs GNU time (Debian's package `time`) and an idle machine: of the repeats (3) the fastest counts. The first line
# compiles Eigen alone, which tells how fast the machine is.
set -euo pipefail

repeats=${1:-3}
compiler=${CXX:-g++}
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

[ -x /usr/bin/time ] || { echo "Install GNU time: apt-get install time" >&2; exit 1; }
eigen=$(pkg-config --cflags-only-I eigen3 2> /dev/null | sed 's/^-I//; s/ *$//')
flags=(-std=c++20 -fopenmp -march=native -fno-math-errno -fno-trapping-math "-I$root/include"
       -isystem "${eigen:-/usr/include/eigen3}")

printf '#include <Eigen/Core>\nint main() {}\n' > "$work/eigen.cpp"
printf '#include <dem/dem.hpp>\nint main() {}\n' > "$work/empty.cpp"
# README's first block of C++ that includes the machines, its statements in a main function.
awk '/^```cpp$/ { on = 1; text = ""; next }
     /^```$/ { if (on && text ~ /<dem\/mbd\/mbd\.hpp>/) { printf "%s", text; exit } on = 0 }
     on { text = text $0 "\n" }' "$root/README.md" > "$work/block"
[ -s "$work/block" ] || { echo "README.md has no block that includes <dem/mbd/mbd.hpp>" >&2; exit 1; }
{
  # A block may leave out what every program has.
  printf '#include <dem/integrator/predictor_corrector.hpp>\n#include <fmt/core.h>\n'
  grep '^#include' "$work/block"
  printf 'int main() {\n'
  grep -v '^#include' "$work/block"
  printf '}\n'
} > "$work/machine.cpp"

# line <what> <options> <budget in seconds> <budget in MB> <source> [<options, if they are not those shown>]
line() {
  local seconds= megabytes= user system kilobytes
  for ((k = 0; k < repeats; ++k)); do
    # shellcheck disable=SC2086  # several options
    /usr/bin/time -f '%U %S %M' -o "$work/time" "$compiler" "${flags[@]}" ${6:-$2} -c "$5" -o "$work/object"
    read -r user system kilobytes < "$work/time"
    read -r seconds megabytes < <(awk -v u="$user" -v s="$system" -v m="$kilobytes" -v best="$seconds" -v most="$megabytes" '
      BEGIN {
        t = u + s
        m /= 1000
        if (best == "" || t < best) best = t
        if (most == "" || m > most) most = m
        printf "%.2f %.0f\n", best, most
      }')
  done
  echo "| $1 | \`$2\` | $seconds | $3 | $megabytes | $4 |"
}

echo "$("$compiler" --version | head -n 1), $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo
echo "| what | | CPU (s) | budget (s) | memory (MB) | budget (MB) |"
echo "|---|---|---|---|---|---|"
line "\`#include <Eigen/Core>\`, an empty main" -O2 "" "" "$work/eigen.cpp"
line "what \`dem::compiled\` compiles once" "-O2 -DDEM_COMPILED" "" "" "$root/include/dem/compiled.cpp"
# programs <options besides the level> [<what is shown of them>]: LEVEL in the options is the level's number.
programs() {
  local shown=${2:-$1}
  line "\`#include <dem/dem.hpp>\`, an empty main" "-O2$shown" 2.5 450 "$work/empty.cpp" "-O2${1//LEVEL/2}"
  line "\`#include <dem/mbd/mbd.hpp>\`, the README's machine" "-O2$shown" 4 "" "$work/machine.cpp" "-O2${1//LEVEL/2}"
  line "\`examples/first_steps\`" "-O0$shown" 6 700 "$root/examples/first_steps/first_steps.cpp" "-O0${1//LEVEL/0}"
  line "\`examples/first_steps\`" "-O2$shown" 10 700 "$root/examples/first_steps/first_steps.cpp" "-O2${1//LEVEL/2}"
}
# As CMake's dem_compile_fast has it: dem.hpp precompiled, and more memory for g++.
fast=" -DDEM_COMPILED"
[[ $("$compiler" --version) == *clang* ]] || fast+=" --param ggc-min-heapsize=1000000"
printf '#include <dem/dem.hpp>\n' > "$work/dem.hpp"
for level in 2 0; do
  line "\`dem.hpp\`, precompiled once" "-O$level (dem_compile_fast)" "" "" "$work/dem.hpp" "-O$level$fast -x c++-header"
  mv "$work/object" "$work/level_$level.gch"
done
programs "$fast -Winvalid-pch -include $work/level_LEVEL" " (dem_compile_fast)"
programs " -DDEM_COMPILED"
programs ""
