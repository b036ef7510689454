#!/usr/bin/env bash
# What the direct shear example left of its smallest run holds what it promises: tables and plots in report.html, the
# grains' fields for ParaView.
#
#   report.sh <direct_shear> <output folder, unused> <packing file in the folder of the finished run>
set -euo pipefail

run=$(dirname "$3")
page=$run/report.html

fail() {
  echo "$1"
  exit 1
}

for table in 'Shear strength beside table 3.3' 'Angle of friction and cohesion'; do
  grep -q "<caption>$table" "$page" || fail "report.html has no table '$table'"
done
# normal, maximum, thesis's, difference, place, residual, bulk and relative density, dilation
number='<td[^>]*>[-+0-9.]+</td>' value='<td[^>]*>[1-9][0-9]*\.[0-9]+</td>'
grep -Eq "<td[^>]*>44\.145</td>$value<td[^>]*>33\.79</td>$number$number$value<td[^>]*>[12][0-9]{3}</td>$number$number" "$page" ||
  fail "report.html does not hold the numbers of the load"
if command -v gnuplot > /dev/null; then
  [ "$(grep -o 'data:image/svg+xml' "$page" | wc -l)" = 3 ] || fail "report.html does not hold three plots"
  for plot in shear_stress dilation mohr_coulomb; do
    [ -s "$run/$plot.png" ] || fail "There is no $plot.png"
  done
fi
for field in velocity_m_s net_contact_force_N coordination; do
  grep -aq "Name=\"$field\"" "$run/load_44.1kPa/grains_000020.vtp" || fail "The grains have no $field"
done
for field in velocity_m_s force_of_grains_N; do
  grep -aq "Name=\"$field\"" "$run/load_44.1kPa/boxes_000020.vtp" || fail "The boxes have no $field"
done
