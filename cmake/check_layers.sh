#!/usr/bin/env bash
# The layer rule: a header includes only headers of its own folder and of the folders to its left in this list, and
# headers never include each other in a circle. Usage: check_layers.sh [folder that holds dem/]
set -euo pipefail

layers="core math parallel geometry domain law integrator grain mbd coupling world flat io report soil terramechanics vehicle rig"

cd "${1:-$(dirname "$0")/../include}"

check_header='
  function refuse(why) { print FILENAME ":" FNR ": " why > "/dev/stderr"; failed = 1 }
  function layer_of(path, part) { return split(path, part, "/") > 2 ? part[2] : "" }

  BEGIN { count = split(layers, name, " "); for (i = 1; i <= count; ++i) rank[name[i]] = i }

  FNR == 1 {
    layer = layer_of(FILENAME)
    own_rank = layer in rank ? rank[layer] : count
    if (FILENAME == "dem/dem.hpp" || FILENAME == "dem/fwd.hpp") next
    if (layer == "") refuse("only dem.hpp and fwd.hpp stand outside the layers")
    else if (!(layer in rank)) refuse("\"" layer "\" is no layer: there are " layers)
  }

  /^[ \t]*#[ \t]*include[ \t]*"/ { refuse("include in angle brackets, from dem/ down") }

  /^[ \t]*#[ \t]*include[ \t]*<dem\// {
    sub(/^[^<]*</, ""); sub(/>.*/, "")
    if (!(layer_of($0) in rank)) refuse("<" $0 "> is in no layer")
    else if (rank[layer_of($0)] > own_rank) refuse("<" $0 "> is to the right of " layer)
    if ($0 == FILENAME) refuse("includes itself")
    print FILENAME, $0
  }

  END { exit failed }'

# The headers print their edges of the include graph; sorting that graph topologically finds the circles.
find dem -type f \( -name "*.hpp" -o -name "*.cuh" \) -exec awk -v layers="$layers" "$check_header" {} + |
  tsort > /dev/null
