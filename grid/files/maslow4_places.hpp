// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the runs of a Maslow 4's log to its places: damaged ones are left out and reported with their
/// lines. Private to grid/files.
#pragma once

#include <cstddef>
#include <vector>

#include "grid/files/maslow4_log.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct PlacesOfLog {
  std::vector<BeltPoint> points;
  std::vector<std::size_t> lines;  ///< of each point
};

/// The runs with places, each of one frame.
std::vector<ScannedRun> runs_of(ScannedLog& log, const BeltMachine& machine, Problems& problems);
/// Appends the readable places of a run, within the range of its points.
void take_places(const ScannedRun& run, PointRange within, Orientation orientation,
                 PlacesOfLog& places);
/// Reports unreadable readings, as problems if fewer than kFewestBeltPoints are readable.
void report_unreadable(const ScannedRun& run, PointRange within, std::size_t readable,
                       Problems& problems);
/// Leaves out and reports exact copies of other places, unless the log reads places twice on purpose.
void leave_out_copies(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems);
/// Leaves out and reports a few places whose lengths do not meet.
void leave_out_nowhere(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems);

/// The machine and its pull, from the settings and the options; maslow4_machine.cpp.
void take_machine(const Maslow4Options& options, Maslow4Import& result, Problems& problems);

}  // namespace chaintrue::grid::files
