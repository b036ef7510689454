#pragma once
// Files: tables in CSV, frames for ParaView. POSIX. Nothing here knows about a World: <dem/io/vtk_machine.hpp> does
// (frames of grains, surfaces, machines and contacts), and <dem/io/grains_csv.hpp>. Progress, plots and reports are
// <dem/report/report.hpp>.

#include <dem/io/csv.hpp>
#include <dem/io/vtk.hpp>
