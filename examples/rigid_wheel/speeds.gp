# Draws the pull over the way of the runs in two folders of rigid_wheel, as of one bed at two speeds:
#   gnuplot -e "slow = 'out/slow'; fast = 'out/fast'" examples/rigid_wheel/speeds.gp
# Writes speeds.png into the first. Means over 1 mm.
set terminal pngcairo size 1000,620 font ",13"
set output slow."/speeds.png"
set title "Drawbar pull over the way, slip s = 1 - v/(ω r): two speeds in one bed"
set xlabel "way of the wheel [mm]"
set ylabel "drawbar pull [N]"
set key outside bottom center horizontal
set grid
set linetype 1 lc "#0072b2"; set linetype 2 lc "#009e73"; set linetype 3 lc "#d55e00"
set linetype 4 lc "#cc79a7"; set linetype 5 lc "#56b4e9"; set linetype 6 lc "#e69f00"
set linetype 7 lc "#7f7f7f"; set linetype 8 lc "#000000"; set linetype 9 lc "#8c564b"
means(file) = "<awk -F, 'NR > 1 { k = int(1e3 * $3); if (k != last && n) { print last + 0.5, sum / n; sum = n = 0 } ".\
              "last = k; sum += $4; ++n } END { if (n) print last + 0.5, sum / n }' '".file."'"
percent = "sed -e 's/.*slip_m/-/' -e 's/.*slip_//' -e 's/.csv//'"
name(file) = sprintf("s = %g", 0.01 * real(system("echo ".file." | ".percent)))
by_slip(folder) = system("for f in ".folder."/slip_*.csv; do echo \"$(echo \"$f\" | ".percent.") $f\"; done | sort -n | cut -d' ' -f2-")
slows = by_slip(slow)
fasts = by_slip(fast)
plot for [i = 1:words(slows)] means(word(slows, i)) using 1:2 with lines lw 2 lc i title name(word(slows, i)), \
     for [i = 1:words(fasts)] for [k = 1:words(slows)] \
       (system("basename ".word(slows, k)) eq system("basename ".word(fasts, i)) ? means(word(fasts, i)) : "/dev/null") \
       using 1:2 with lines lw 1.5 dt 2 lc k notitle, \
     NaN with lines lw 1.5 dt 2 lc "black" title "faster"
