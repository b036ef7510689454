# Draws pull_full.png from the table "The thesis's grains" of RESULTS.md: gnuplot examples/rigid_wheel/pull_full.gp
set terminal pngcairo size 1600,1000 fontscale 2 linewidth 2 noenhanced
set output "examples/rigid_wheel/pull_full.png"
# slip, pull and its standard deviation in time (N), P1, P3 (N)
$a << EOD
-0.5 -31.9 3.1 -21.2 -45.1
-0.1 -13.5 1.0 -14.3 -32.0
0.3 5.4 1.2 57.8 53.5
0.7 16.2 3.1 52.0 46.5
EOD
$b << EOD
-0.7 -39.0 5.0 -31.0 -58.4
-0.3 -23.9 2.2 -13.6 -33.8
0 -6.7 1.0 45.9 53.7
0.1 -1.2 1.2 59.2 55.9
0.5 10.5 2.5 55.2 50.3
EOD
$laws << EOD
-0.7 -31.0 -58.4
-0.5 -21.2 -45.1
-0.3 -13.6 -33.8
-0.1 -14.3 -32.0
-0.05 -20.8 -39.8
0 45.9 53.7
0.1 59.2 55.9
0.3 57.8 53.5
0.5 55.2 50.3
0.7 52.0 46.5
EOD
set title "Drawbar pull on the thesis's grains"
set xlabel "slip s = 1 - v/(ω r)"
set ylabel "drawbar pull [N]"
set xrange [-0.8:0.8]
set border 3
set tics nomirror
set grid linecolor rgb "#d0d0d0" linetype 1 linewidth 0.5
set key below
plot $laws using 1:2 with linespoints linecolor rgb "#d55e00" dashtype 2 pointtype 2 title "P1, Bekker and Wong", \
     $laws using 1:3 with linespoints linecolor rgb "#009e73" dashtype 2 pointtype 2 title "P3, Bekker and Wong", \
     $a using 1:2:3 with yerrorbars linecolor rgb "#0072b2" pointtype 6 pointsize 2 title "grains, bed A (± in time)", \
     $b using 1:2:3 with yerrorbars linecolor rgb "#0072b2" pointtype 7 pointsize 2 title "grains, bed B"
