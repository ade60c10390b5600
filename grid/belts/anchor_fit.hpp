// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit's anchors and places, and the order of a machine's anchors in a vector. Private to
/// grid/belts and what reads its fits.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/containers.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::belts {

/// For each point and belt, whether its reading counts.
using Counting = std::vector<PerBelt<bool>>;

/// All four belts.
inline constexpr PerBelt<bool> kAllBelts{true, true, true, true};
/// tl x, tl y, tr x, tr y, br x.
inline constexpr Index kAnchorUnknowns = 5;
using AnchorVector = Eigen::Matrix<double, kAnchorUnknowns, 1>;

/// Their names in files.
inline constexpr std::array<std::string_view, 5> kCoordinateNames = {
    "tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"};
/// A frame that meets its readings exactly has not shown that they are.
inline constexpr double kLeastSpreadMm = 1e-3;

/// Values of the unknowns.
struct FrameState {
  AnchorVector anchors = AnchorVector::Zero();
  double log_scale = 0.0;
  std::vector<FramePoint> places;
};

struct AnchorFit {
  FrameState state;
  Counting counting;
  double residual_sigma_mm = 0.0;
  Index checks = 0;
  /// Converged, with right anchors right of the left ones and upper above lower ones.
  bool is_sound = false;
};

AnchorVector anchors_of(const BeltMachine& machine);
[[nodiscard]] BeltMachine with_anchors(BeltMachine machine, const AnchorVector& a);

/// The row of a point's belt among all.
inline Index row_of(std::size_t point, Belt belt) { return 4 * as_index(point) + as_index(belt); }
inline int readings_counting(const PerBelt<bool>& counting) {
  return counting.tl + counting.tr + counting.bl + counting.br;
}
/// In a strip no wider than 50 mm: the anchors could lie on either side of it. \pre one place.
bool are_on_a_line(const std::vector<FramePoint>& places);
/// Counted readings minus two per place minus five.
Index checks_of(const Counting& counting);

}  // namespace chaintrue::grid::belts

namespace chaintrue::grid {
using belts::AnchorFit;
using belts::anchors_of;
using belts::AnchorVector;
using belts::Counting;
using belts::FrameState;
using belts::kAllBelts;
using belts::kAnchorUnknowns;
using belts::with_anchors;
}  // namespace chaintrue::grid
