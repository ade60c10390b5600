// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Positions of the tool by the readings and the stated machine, and how well marks agree with
/// them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "grid/input_checks/robust_trend.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "model/controllers/payout.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::input_checks {

using Place = std::optional<BedPoint>;

/// A point with the place where the stated machine puts its reading.
struct PlacedPoint : MeasuredPoint {
  Place place;
};
using PlacedPoints = std::vector<PlacedPoint>;

/// \pre the grid has a possible machine.
class PointAccounts {
 public:
  explicit PointAccounts(const MeasuredGrid& grid)
      : zero_(grid.machine->chain_zero),
        half_width_mm_(0.5 * grid.machine->bed.width_mm),
        half_height_mm_(0.5 * grid.machine->bed.height_mm),
        prior_sigma_mm_(point_sigmas(grid)),
        kinematics_(make_kinematics(equilibrium_parameters(*grid.machine))),
        controller_(make_controller_kinematics(*grid.machine)) {}

  /// The tool's position by its lengths or its command; empty if no pose has them.
  Place place_of(const MeasuredPoint& point) const {
    ChainLengths lengths;
    if (point.lengths) {
      lengths = *point.lengths;
    } else {
      if (!point.commanded) return std::nullopt;
      const auto paid_out = controller_->lengths(*point.commanded);
      if (!paid_out) return std::nullopt;
      lengths = *paid_out;
    }
    lengths.left_mm -= zero_.left_mm;
    lengths.right_mm -= zero_.right_mm;
    const auto pose = kinematics_->forward(lengths);
    if (!pose) return std::nullopt;
    return pose->position;
  }

  /// True if the stated machine can hold the sled there.
  bool can_hold(MarkPoint mark) const {
    return kinematics_->inverse(identity_placement(mark)).has_value();
  }

  PlacedPoints placed(const std::vector<MeasuredPoint>& points) const {
    return mapped(points, [this](const MeasuredPoint& point) {
      return PlacedPoint{point, place_of(point)};
    });
  }

  /// Marks relative to places, for a second-degree trend. A missing place is a missing row.
  TrendRows rows(const PlacedPoints& placed) const {
    const auto n = std::ssize(placed);
    TrendRows rows{MatrixXd::Zero(n, kPointBasis),
                   MatrixXd::Constant(n, 2, std::numeric_limits<double>::quiet_NaN())};
    for (const Index i : each_below(n)) {
      const PlacedPoint& own = placed[as_size(i)];
      if (!own.place) continue;
      rows.basis.row(i) = basis_at(*own.place);
      rows.off_mm.row(i) = difference(own.mark, *own.place);
    }
    return rows;
  }

  const VectorXd& prior_sigma_mm() const { return prior_sigma_mm_; }
  /// d(trend)/d(place) in the bed's middle.
  Matrix2d slope(const RobustTrend& trend) const {
    const Vector2d half_mm(half_width_mm_, half_height_mm_);
    return trend.coefficients.middleRows<2>(1).transpose() * half_mm.cwiseInverse().asDiagonal();
  }

  /// Residual of a mark at a place from a trend.
  Vector2d off(const RobustTrend& trend, MarkPoint mark, BedPoint place) const {
    return difference(mark, place) - (basis_at(place) * trend.coefficients).transpose();
  }

 private:
  static constexpr Index kPointBasis = 6;

  static VectorXd point_sigmas(const MeasuredGrid& grid) {
    // Uncalibrated machines as stated have errors of 3 to 13 mm rms over the bed (scans of a real
    // machine), in constant, slope and bend equally.
    constexpr double kErrorMm = 10.0;
    VectorXd sigma = VectorXd::Constant(kPointBasis, kErrorMm);
    if (!grid.sheet) return sigma;
    const double half_mm = 0.5 * grid.machine->bed.width_mm;
    sigma[0] = std::hypot(kErrorMm, grid.sheet->shift_mm);
    sigma[1] = sigma[2] = std::hypot(kErrorMm, 1e-3 * grid.sheet->rotation_mrad * half_mm);
    return sigma;
  }

  RowVectorXd basis_at(BedPoint place) const {
    // Wrong lengths may end anywhere: the second-degree trend is kept constant beyond the bed.
    const double u = std::clamp(place.x_mm / half_width_mm_, -1.5, 1.5);
    const double v = std::clamp(place.y_mm / half_height_mm_, -1.5, 1.5);
    RowVectorXd basis(kPointBasis);
    basis << 1.0, u, v, u * u, u * v, v * v;
    return basis;
  }

  ChainLengths zero_;
  double half_width_mm_;
  double half_height_mm_;
  VectorXd prior_sigma_mm_;
  std::unique_ptr<const model::Kinematics> kinematics_;
  std::unique_ptr<const model::ControllerKinematics> controller_;
};

}  // namespace chaintrue::grid::input_checks
