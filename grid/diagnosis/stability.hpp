// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Does the name hang on a few of the points? The comparison decided again without each point, and
/// without each column and row of marks.
///
/// A column is a run of marks whose x differ by less than kLineGap_mm from one to the next; there
/// are columns where at least three such runs hold three points each on average. Rows the same in
/// y. A name stands where it is still given: alone, among several causes, or first in a set; a set
/// stands where its first cause is still in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Marks of one line lie no further apart across it; marks this near to each other are one mark.
inline constexpr double kLineGap_mm = 25.0;

/// Points left out together (positions in the session), with what they are.
struct LeftOut {
  Removal::What what = Removal::What::point;
  double at_mm = 0.0;
  std::vector<std::size_t> points;
};
/// Every point, then the columns from the left, then the rows from below; those that would leave
/// too few points are missing.
[[nodiscard]] std::vector<LeftOut> groups_to_leave_out(const Session& session);

/// Whether what is named of all points is named in `without` too.
[[nodiscard]] bool still_named(const Decision& all, const Decision& without);

/// Empty where the analysis names nothing.
[[nodiscard]] std::optional<Stability> examine_stability(const Session& session,
                                                         const Analysis& analysis,
                                                         const DiagnosisOptions& options);

/// What was left out and what became of the name, in a sentence or two. Precondition: the diagnosis
/// has a stability.
[[nodiscard]] std::string stability_in_words(const Diagnosis& diagnosis);
/// Points without each of which the verdict would not name the same (indices into the grid's).
[[nodiscard]] std::vector<std::size_t> points_it_rests_on(const Diagnosis& diagnosis);
/// What the name rests on: " The name rests on point 17: without it ...", or nothing where it
/// stands.
[[nodiscard]] std::string rests_on(const Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
