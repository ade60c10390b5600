// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Places of a run of a Maslow 4's log; damaged ones are left out and reported with their lines.
/// Private to grid/files.
#pragma once

#include <cstddef>
#include <vector>

#include "grid/files/maslow4_log.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

/// Adds places that no list has: the median of a belt's single readings, if these agree to a
/// centimetre. Each is reported.
void rebuild_from_singles(ScannedRun& run, Problems& problems);

struct PlacesOfLog {
  std::vector<BeltPoint> points;
  std::vector<std::size_t> lines;  ///< of each point
};
/// Appends the readable places of a run, within the range of its points.
void take_places(const ScannedRun& run,
                 PointRange within,
                 model::Orientation orientation,
                 PlacesOfLog& places);

/// Reports unreadable readings, as problems if fewer than kFewestBeltPoints are readable.
void report_unreadable(const ScannedRun& run,
                       PointRange within,
                       std::size_t readable,
                       Problems& problems);

/// Leaves out and reports exact copies of other places, unless the log reads places twice on
/// purpose.
void leave_out_copies(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems);
/// Leaves out and reports a few places whose lengths do not meet.
void leave_out_nowhere(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems);

/// Runs with places in two frames are split.
void part_frames(const model::BeltMachine& machine,
                 std::vector<ScannedRun>& runs,
                 Problems& problems);

}  // namespace chaintrue::grid::files
