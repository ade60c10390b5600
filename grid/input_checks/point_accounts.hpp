// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Positions of the tool by the readings and the stated machine, and how well marks agree with
/// them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "grid/input_checks/robust_trend.hpp"
#include "grid/observation/measured_grid.hpp"
#include "model/controllers/payout.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::input_checks {

using Place = std::optional<model::BedPoint>;

/// Points with the places where the stated machine puts their readings.
struct PlacedPoints {
  std::vector<MeasuredPoint> points;
  std::vector<Place> places;
};

/// \pre the grid has a possible machine.
class PointAccounts {
 public:
  explicit PointAccounts(const MeasuredGrid& grid);

  /// The tool's position by its lengths or its command; empty if no pose has them.
  [[nodiscard]] Place place_of(const MeasuredPoint& point) const;
  /// True if the stated machine can hold the sled there.
  [[nodiscard]] bool can_hold(model::MarkPoint mark) const;
  [[nodiscard]] PlacedPoints placed(const std::vector<MeasuredPoint>& points) const;

  /// Marks relative to places, for a second-degree trend. A missing place is a missing row.
  [[nodiscard]] TrendRows rows(const PlacedPoints& placed) const;
  [[nodiscard]] const Eigen::VectorXd& prior_sigma_mm() const { return prior_sigma_mm_; }
  /// The trend's rotation of the marks to the left about the bed's middle.
  [[nodiscard]] double turn_rad(const RobustTrend& trend) const;
  /// The largest of its relative stretches along x and y and its skew.
  [[nodiscard]] double strain(const RobustTrend& trend) const;
  /// Residual of a mark at a place from a trend.
  [[nodiscard]] Eigen::Vector2d off(const RobustTrend& trend,
                                    model::MarkPoint mark,
                                    model::BedPoint place) const;

 private:
  [[nodiscard]] Eigen::RowVectorXd basis_at(model::BedPoint place) const;

  model::ChainLengths zero_;
  double half_width_mm_;
  double half_height_mm_;
  Eigen::VectorXd prior_sigma_mm_;
  std::unique_ptr<const model::Kinematics> kinematics_;
  std::unique_ptr<const model::ControllerKinematics> controller_;
};

}  // namespace chaintrue::grid::input_checks
