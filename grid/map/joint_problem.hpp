// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points, readings of the machine and what is known beforehand as one penalised problem at one
/// linearisation, and the way back from its unknowns to settings and splines. Private to grid/map.
///
/// Notation: theta, deviations of the settings from what was stated.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/map/fit_unknowns.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/observed_subspace.hpp"

namespace chaintrue::grid {

/// One point, linearised and whitened: rows of the design and the response, and the way back to
/// millimetres.
struct WhitePoint {
  Eigen::MatrixXd design;                                   // 2 x ObservedColumns::total()
  Eigen::Vector2d response;                                 // whitened, for all unknowns
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  // W with W C W' = I
};

/// A reading of the machine itself, whitened.
struct WhiteReading {
  Eigen::RowVectorXd row;  // by the settings
  double response = 0.0;
};

/// The unknowns while fitting, in this order: settings, both chains' scales, polynomials, and bends
/// as the points observe them (observed_subspace.hpp).
struct ObservedColumns {
  Eigen::Index settings = 0;
  Eigen::Index polynomials = 0;  ///< of one surface
  Eigen::Index bends = 0;        ///< of one surface
  [[nodiscard]] Eigen::Index scale(model::Side side) const { return settings + second(side); }
  [[nodiscard]] Eigen::Index polynomial(model::Side side) const {
    return settings + 2 + second(side) * polynomials;
  }
  [[nodiscard]] Eigen::Index bend(model::Side side) const {
    return settings + 2 + 2 * polynomials + second(side) * bends;
  }
  [[nodiscard]] Eigen::Index total() const { return settings + 2 + 2 * (polynomials + bends); }

 private:
  static Eigen::Index second(model::Side side) { return side == model::Side::left ? 0 : 1; }
};

[[nodiscard]] JointFitFailure unreachable(const LengthPoint& point, model::PoseFailure failure);

class JointProblem {
 public:
  /// `input` outlives the problem.
  explicit JointProblem(const JointFitInput& input);

  /// About these settings. Fails where the machine has no pose at a point.
  tl::expected<void, JointFitFailure> linearise(const Eigen::VectorXd& theta);
  /// With a weight for each point; 0 sets it aside.
  [[nodiscard]] interp::PenalisedProblem weighted(const Eigen::VectorXd& weights) const;

  [[nodiscard]] const FitUnknowns& unknowns() const { return unknowns_; }
  [[nodiscard]] const interp::BsplineBasis& basis() const { return basis_; }
  [[nodiscard]] const ObservedColumns& columns() const { return columns_; }
  /// In the order of the points.
  [[nodiscard]] const std::vector<WhitePoint>& white() const { return white_; }
  /// Of the splines themselves, as a fit of the problem has them.
  [[nodiscard]] Eigen::VectorXd spline_coefficients(const interp::PenalisedFit& fit,
                                                    model::Side side) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const interp::PenalisedFit& fit,
                                           const FitColumns& columns) const;

 private:
  [[nodiscard]] Eigen::MatrixXd design_of(Eigen::Index point,
                                          model::ChainLengths lengths,
                                          const Eigen::MatrixXd& settings_jacobian) const;
  void add_points(interp::PenalisedProblem& problem, const Eigen::VectorXd& weights) const;
  void add_settings_prior(interp::PenalisedProblem& problem) const;
  void add_surface_prior(interp::PenalisedProblem& problem, const Eigen::VectorXd& weights) const;

  const JointFitInput& input_;
  FitUnknowns unknowns_;
  interp::BsplineBasis basis_;
  ObservedSubspace observed_;
  ObservedColumns columns_;
  std::vector<WhitePoint> white_;
  std::vector<WhiteReading> extra_;
};

}  // namespace chaintrue::grid
