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

/// Unread chains at these places, in their order and without an order of visits, in the frame and with the noise
/// of a part that reads chains.
FollowUp readings_at(const ObservationSet& session, std::size_t part,
                     std::vector<observation::Place> places);

/// A session with a point at each reachable mark, without an order of visits. Precondition: as
/// above.
ObservationSet session_at(const Analysis& analysis, const std::vector<MarkPoint>& marks);

/// What a model expects of rows: their mean, and how they depend on its settings and free sizes, whose
/// covariance is Estimate::covariance.
struct ExpectedRows {
  VectorXd mean;
  MatrixXd by_unknown;
};
/// Predicts other rows with the same settings; `column` gives a regressor's column there, or none.
ExpectedRows expected_rows(const Analysis& analysis, const Estimate& fitted,
                           const RegressorSystem& there,
                           const std::function<std::optional<VectorXd>(const Regressor&)>& column);

/// The estimate's discrepancy in all rows of other places.
VectorXd pattern_at(const Analysis& analysis, const Estimate& fitted, const RegressorSystem& there);

}  // namespace chaintrue::grid::diagnosis
