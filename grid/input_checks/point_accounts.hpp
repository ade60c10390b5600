// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where readings put the tool by the machine as stated, and how well marks agree with that.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "grid/input_checks/transformation_search.hpp"
#include "grid/observation/measured_grid.hpp"
#include "model/controllers/payout.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::input_checks {

using Place = std::optional<model::BedPoint>;

/// \pre the grid has a possible machine.
class PointAccounts {
 public:
  explicit PointAccounts(const MeasuredGrid& grid);

  /// Where the tool was by its lengths or its command; nothing where no pose has them.
  [[nodiscard]] Place place_of(const MeasuredPoint& point) const;
  /// True where the machine as stated can hold the sled.
  [[nodiscard]] bool can_hold(model::MarkPoint mark) const;
  [[nodiscard]] std::vector<Place> places_of(const std::vector<MeasuredPoint>& points) const;

  /// How marks lie about places, for a trend of the second degree. A place that is missing is a row that
  /// is missing. \pre as many places as points.
  [[nodiscard]] TrendRows rows(const std::vector<MeasuredPoint>& points,
                               const std::vector<Place>& places) const;
  [[nodiscard]] const Eigen::VectorXd& prior_sigma_mm() const { return prior_sigma_mm_; }
  [[nodiscard]] RobustTrend account(const std::vector<MeasuredPoint>& points,
                                    const std::vector<Place>& places) const;
  /// By how much the marks of a trend lie turned to the left about the bed's middle.
  [[nodiscard]] double turn_rad(const RobustTrend& trend) const;
  /// The largest of its stretches along x and y and its skew, of 1.
  [[nodiscard]] double strain(const RobustTrend& trend) const;
  /// What a trend leaves of a mark at a place.
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
