# Draws the pull over the way of the runs in two folders of rigid_wheel, as of one bed at two speeds:
#   gnuplot -e "slow = 'out/slow'; fast = 'out/fast'" examples/rigid_wheel/speeds.gp
# Writes speeds.png into the first. Means over 1 mm.
set terminal pngcairo size 1000,620 font ",13"
set output slow."/speeds.png"
set title "Drawbar pull over the way: two speeds in one bed"
set xlabel "way of the wheel [mm]"
set ylabel "drawbar pull [N]"
set key outside bottom center horizontal
set grid
set linetype 1 lc "#0072b2"; set linetype 2 lc "#009e73"; set linetype 3 lc "#d55e00"
set linetype 4 lc "#cc79a7"; set linetype 5 lc "#56b4e9"; set linetype 6 lc "#e69f00"
means(file) = "<awk -F, 'NR > 1 { k = int(1e3 * $3); if (k != last && n) { print last + 0.5, sum / n; sum = n = 0 } ".\
              "last = k; sum += $4; ++n } END { if (n) print last + 0.5, sum / n }' '".file."'"
name(file) = system("basename ".file." .csv | sed -e 's/slip_m/s = -/' -e 's/slip_/s = /' -e 's/$/ %/'")
slows = system("ls -v ".slow."/slip_*.csv")
fasts = system("ls -v ".fast."/slip_*.csv")
plot for [i = 1:words(slows)] means(word(slows, i)) using 1:2 with lines lw 2 lc i title name(word(slows, i)), \
     for [i = 1:words(fasts)] for [k = 1:words(slows)] \
       (system("basename ".word(slows, k)) eq system("basename ".word(fasts, i)) ? means(word(fasts, i)) : "/dev/null") \
       using 1:2 with lines lw 1.5 dt 2 lc k notitle, \
     NaN with lines lw 1.5 dt 2 lc "black" title "faster"
