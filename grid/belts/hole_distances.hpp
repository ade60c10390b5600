// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Distances between holes that four belts cut, as an observation for the estimator. Private to
/// grid/belts.
///
///   r   distances of all sets minus their prediction (belt_holes.hpp)
///   C   their covariance, given
///
///   y - f = L^-1 r,   L L' = C                                                              (1)
///
/// so that rows are independent although distances that end at one hole are not.
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/belt_holes.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/observation/observation.hpp"

namespace chaintrue::grid::belts {

/// The distances of all sets, concatenated.
struct TapedRows {
  Eigen::VectorXd residual_mm;
  Eigen::MatrixXd by_frame;             ///< n x 6
  Eigen::MatrixXd by_mark;              ///< n x 2 N
  Eigen::MatrixXd by_size;              ///< n x 2, of each set's own sheet
  Eigen::MatrixXd by_sheet;             ///< n x 3, the same
  std::vector<model::MarkPoint> marks;  ///< of all holes, from where the first set's commands count
};
/// Empty where the machine cannot hold the tool at a hole.
[[nodiscard]] std::optional<TapedRows> taped_rows(const std::vector<BeltHoles>& sets,
                                                  const AnchorVector& anchors,
                                                  double log_scale);

class HoleDistances final : public observation::Observation {
 public:
  /// `sets` must outlive this. For four belts with a scale.
  HoleDistances(const std::vector<BeltHoles>& sets, const Eigen::MatrixXd& covariance);

  [[nodiscard]] const observation::Kind& kind() const override {
    return observation::tape_distances;
  }
  [[nodiscard]] tl::expected<Eigen::VectorXd, observation::Unreachable> predicted(
      const observation::View& view) const override;
  [[nodiscard]] tl::expected<observation::Linearisation, observation::Unreachable> linearise(
      const observation::View& view, const observation::Columns& columns) const override;
  [[nodiscard]] std::string untestable(const model::effects::Effect& effect,
                                       model::effects::EffectSide side) const override;
  [[nodiscard]] std::string name_of(std::size_t unit) const override;

 private:
  const std::vector<BeltHoles>* sets_;
  linear::Cholesky covariance_;
};

}  // namespace chaintrue::grid::belts
