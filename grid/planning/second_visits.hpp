// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Marks that are visited twice, so that changes during the session show: a zero that moved, drift,
/// friction.
///
/// The first mark comes again at the very end, so that whatever moved lies between its two visits.
/// The others are repeated after equal shares of the session, each a mark of the share before, so
/// that their spans divide the session and show when it moved.
///
/// \code
///   for (const std::size_t mark : with_second_visits(plan.marks.size(), 4)) drive_to(plan.marks[mark]);
/// \endcode
#pragma once

#include <cstddef>
#include <vector>

namespace chaintrue::grid {

/// Number of second visits in an owner's list.
inline constexpr std::size_t kUsualSecondVisits = 4;

/// Numbers of the marks in the order of the visits: each of `marks` once, in order, and `second` of
/// them again. The two visits of a mark are never consecutive.
/// \throws std::invalid_argument for fewer than three marks a second visit.
[[nodiscard]] std::vector<std::size_t> with_second_visits(std::size_t marks, std::size_t second);

}  // namespace chaintrue::grid
