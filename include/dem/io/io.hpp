#pragma once
// The whole io layer: progress and Ctrl-C, tables on the terminal and in CSV files, ParaView files, plots, reports.
// POSIX; nothing here knows about a World: <dem/io/vtk_grains.hpp> and <dem/io/vtk_machine.hpp> do.

#include <dem/io/ascii_table.hpp>
#include <dem/io/columns.hpp>
#include <dem/io/csv.hpp>
#include <dem/io/html_report.hpp>
#include <dem/io/interrupt.hpp>
#include <dem/io/plot.hpp>
#include <dem/io/progress.hpp>
#include <dem/io/vtk.hpp>
