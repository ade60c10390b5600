// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chooses the distances to measure between given holes, and to the sheet's edges. Private to
/// grid/planning.
///
/// Notation
///   x   the unknowns of a plan: the machine's eight, then the sheet's placement
///   S   their covariance
///   A   the distances' derivative by x
///   V   the readings' covariance, (2) of tape_distances.hpp
///   C   the criterion, L' L
///
/// Measuring distance k alone lowers trace(C S) by
///
///   |b_k|^2 / K_kk,  b = L S A',  K = A S A' + V                                            (1)
///
/// and changes b and K of the others to b - b_k K_k' / K_kk and K - K_k K_k' / K_kk, less the
/// tape's part.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/planning/holes_plan.hpp"

namespace chaintrue::grid {

/// The machine's, then the sheet's shift in x, in y and its rotation.
inline constexpr Eigen::Index kPlanUnknowns = estimation::kMachineUnknowns + 3;

/// A candidate position of a hole, and the derivative of the hole's position on the sheet by the
/// unknowns.
struct PlannedPlace {
  model::MarkPoint place;
  Eigen::Matrix<double, 2, kPlanUnknowns> by_unknown;
};

/// Immutable, thread safe.
class DistanceChooser {
 public:
  /// `prior` is S before any measurement; `root` is L.
  DistanceChooser(const model::Machine& machine,
                  const HolesPlanRequest& request,
                  Eigen::MatrixXd prior,
                  Eigen::MatrixXd root);

  struct Choice {
    std::vector<HoleDistance> distances;
    double variance_mm2 = 0.0;  ///< trace(C S)
  };
  /// Adds distances one by one, each time the one that lowers the variance most.
  [[nodiscard]] Choice greedy(const std::vector<const PlannedPlace*>& holes) const;
  /// Exchanges single distances as long as an exchange is an improvement.
  [[nodiscard]] Choice exchange(const std::vector<const PlannedPlace*>& holes, Choice choice) const;
  /// S after these measurements.
  [[nodiscard]] Eigen::MatrixXd covariance(const std::vector<const PlannedPlace*>& holes,
                                           const std::vector<HoleDistance>& distances) const;

 private:
  /// All distances that a tape can measure, before any measurement.
  struct Measurable {
    std::vector<HoleDistance> distances;
    Eigen::MatrixXd by_unknown;  ///< A
    Eigen::MatrixXd known;       ///< K without the tape's part
    Eigen::MatrixXd pull;        ///< b
  };
  [[nodiscard]] Measurable measurable(const std::vector<const PlannedPlace*>& holes,
                                      std::vector<HoleDistance> distances) const;
  [[nodiscard]] std::vector<HoleDistance> in_reach(
      const std::vector<const PlannedPlace*>& holes) const;
  /// trace(C S) after measuring those with these numbers.
  [[nodiscard]] double variance_mm2(const Measurable& all,
                                    const std::vector<std::size_t>& chosen) const;

  HolesPlanRequest request_;
  MeasuredHoles frame_;  ///< the machine, the sheet and the sigmas, without holes
  Eigen::MatrixXd prior_;
  Eigen::MatrixXd root_;
};

}  // namespace chaintrue::grid
