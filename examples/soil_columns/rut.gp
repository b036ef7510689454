# Draws the rut that soil_columns wrote: gnuplot -e "folder = 'out/soil_columns'" examples/soil_columns/rut.gp
if (!exists("folder")) folder = "soil_columns_output"
set terminal pngcairo size 1100,520 font ",12"
set output folder."/rut.png"
set datafile separator ","
set size ratio -1
set palette defined (0 "#3b2a1a", 0.4 "#a5895a", 0.5 "#c2a26b", 1 "#fff6d8")
set title "Rut on soil columns: the wheel rolled from x = 0 to the right"
set xlabel "x [mm]"
set ylabel "y [mm]"
set cblabel "height [mm]"
set autoscale xfix
set autoscale yfix
plot folder."/rut.csv" every ::1 using ($1*1e3):($2*1e3):($3*1e3) with image notitle
