// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine of an analysis at unmeasured places.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "interp/surface.hpp"

namespace chaintrue::grid::diagnosis {

/// The rectangle spanned by the marks at which chains were read. Precondition: the session reads
/// chains.
interp::Rectangle marked_area(const ObservationSet& session);

/// A session with a point at each reachable mark, without an order of visits. Precondition: as
/// above.
ObservationSet session_at(const Analysis& analysis, const std::vector<model::MarkPoint>& marks);

}  // namespace chaintrue::grid::diagnosis
