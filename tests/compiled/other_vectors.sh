#!/usr/bin/env bash
# Of two sources one is compiled for other vectors than what dem::compiled compiles once: the linker says so, whichever it is.
#
#   other_vectors.sh <compiler> <folder that holds dem/>
set -euo pipefail

compiler=$1 include=$2
[ "$(uname -m)" = x86_64 ] || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf '#include <dem/core/compiled.hpp>\nint main() {}\n' > "$work/main.cpp"
printf '#include <dem/core/compiled.hpp>\n' > "$work/other.cpp"
# compile <source> <object> <option>...
compile() { "$compiler" -std=c++20 "-I$include" -DDEM_COMPILED "${@:3}" -c "$work/$1.cpp" -o "$work/$2.o"; }
compile other library -mavx -DDEM_COMPILING
compile main main -mavx
compile other other -mavx
compile main wrong_main -mno-avx
compile other wrong_other -mno-avx

# refused <object>...
refused() {
  if "$compiler" "${@/#/$work/}" "$work/library.o" -o "$work/program" 2> "$work/words"; then
    echo "$* are linked, but one of them has other vectors" >&2
    exit 1
  fi
  grep -q 'undefined reference.*dem_compiled_cpp_is_compiled_without_avx_as_well' "$work/words"
}
"$compiler" "$work/main.o" "$work/other.o" "$work/library.o" -o "$work/program"
refused wrong_main.o other.o
refused main.o wrong_other.o
