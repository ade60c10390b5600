// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Detects two frames in one list of places: the first points belong to one, the rest to another.
///
/// \code
///   if (const auto first = second_frame_begins(belts)) say("from point", *first + 1);
/// \endcode
#pragma once

#include <cstddef>
#include <optional>

#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

/// The first point of the second frame, if all points together fit no frame and each part fits one.
/// Both parts have kFewestBeltPoints or more.
std::optional<std::size_t> second_frame_begins(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
