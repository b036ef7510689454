#pragma once
// What a run shows: progress and Ctrl-C, tables on the terminal, plots, HTML reports. POSIX. The replay of a report,
// which knows about a World, is in <dem/report/replay.hpp>.

#include <dem/report/ascii_table.hpp>
#include <dem/report/columns.hpp>
#include <dem/report/html_report.hpp>
#include <dem/report/interrupt.hpp>
#include <dem/report/plot.hpp>
#include <dem/report/progress.hpp>
