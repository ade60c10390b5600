// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether the name depends on a few readings: the decision is repeated without each point, each
/// column and row of marks, each distance, and each hole with its distances.
///
/// A column is a run of marks whose x differ by less than kLineGapMm from one to the next; there
/// are columns where at least three such runs hold three points each on average. Rows the same in
/// y. A name holds if it is still given: alone, among several causes, or first in a set; a set
/// holds if its first cause is still in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Marks of one line are within this distance across it; marks this close are one mark.
inline constexpr double kLineGapMm = 25.0;

/// A group of units that are left out together (positions in the session).
struct LeftOut : Removal {
  Indices units{};
};
/// Each hole with the distances that end there.
std::vector<LeftOut> holes_to_leave_out(const ObservationSet& session);
/// Every point, then the columns from the left, then the rows from below, then every distance and
/// every hole; those that would leave too few units are missing.
std::vector<LeftOut> groups_to_leave_out(const ObservationSet& session);

/// Whether the causes named from all points are named in `without` too.
bool still_named(const Decision& all, const Decision& without);

/// Empty if the analysis names nothing.
std::optional<Stability> examine_stability(const Analysis& analysis);

/// A sentence or two: what was left out, and the effect on the name. Precondition: the diagnosis
/// has a stability.
std::string stability_in_words(const Diagnosis& diagnosis);
/// Points without each of which the verdict would not name the same (indices into the grid's).
Indices influential_points(const Diagnosis& diagnosis);
/// " The name rests on point 17: without it ...", or nothing if it holds.
std::string influence_in_words(const Diagnosis& diagnosis);

/// A lasting cause acts on more than one reading, so a name that depends on a single reading is
/// refused. If nothing would be named without one reading, decides `analysis` again without it and
/// returns a sentence that says so. Nothing is done if the name holds, if a set remains, or if the
/// cause is a slip or a skip, which may show in a single reading.
std::optional<std::string> refuse_name_of_one_reading(const std::optional<Stability>& stability,
                                                      Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
