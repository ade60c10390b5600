// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The remainder of a change of four belts' readings after projection on the five anchor
/// coordinates and the position of each point.
#pragma once

#include <array>
#include <vector>

#include "generator/hidden/belts.hpp"
#include "generator/hidden/strength.hpp"

namespace chaintrue::generator {

/// From an anchor to a position, level, mm.
double level_span(const std::array<double, 3>& anchor, double x, double y);

class AnchorProjection {
 public:
  AnchorProjection(const BeltFrame& frame, const std::vector<std::array<double, 2>>& places);
  /// Four rows a point (tl, tr, bl, br), mm.
  Eigen::VectorXd left_of(const std::vector<FourLengths>& change) const;

 private:
  Projection taken_;
};

}  // namespace chaintrue::generator
