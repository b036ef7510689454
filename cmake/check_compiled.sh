#!/usr/bin/env bash
# What stands within `#if DEM_DEFINES` is defined by dem/compiled.cpp, or by nothing in a program that links dem::compiled:
# that source reaches each header that has some.
set -euo pipefail

cd "$(dirname "$0")/../include"

reached=$(${CXX:-g++} -std=c++20 -MM -MG -I. dem/compiled.cpp | tr ' \\' '\n\n' | grep '^dem/' | sort -u)
missing=$(grep -rl --include='*.hpp' '^#if DEM_DEFINES' dem | sort | comm -23 - <(echo "$reached"))
if [ -n "$missing" ]; then
  printf 'dem/compiled.cpp does not include these, so dem::compiled lacks what they define:\n%s\n' "$missing" >&2
  exit 1
fi
