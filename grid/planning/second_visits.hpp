// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Marks that are visited twice in a session, so that what changes during the session shows: a zero
/// that moved, drift, friction.
///
/// The first mark comes again at the very end, so that whatever moved lies between its two visits. The
/// others come again after equal shares of the session, each a mark of the share before, so that
/// their spans part the session and say when it moved.
///
/// \code
///   for (const std::size_t mark : with_second_visits(plan.marks.size(), 4)) drive_to(plan.marks[mark]);
/// \endcode
#pragma once

#include <cstddef>
#include <vector>

namespace chaintrue::grid {

/// Of a list that its owner takes to the machine.
inline constexpr std::size_t kUsualSecondVisits = 4;

/// Numbers of the marks in the order of the visits: each of `marks` once, in order, and `second` of
/// them again. No visit follows the other of the same mark at once.
/// \throws std::invalid_argument for fewer than three marks a second visit.
[[nodiscard]] std::vector<std::size_t> with_second_visits(std::size_t marks, std::size_t second);

}  // namespace chaintrue::grid
