// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine's settings and the residual surface, fitted together to what was measured.
///
/// Each stated setting enters as a datum with its stated sigma; the chains' scales and the
/// surfaces' polynomials have weak priors of their own, so that what a setting can explain is
/// explained by the setting; the surfaces' smoothness and, where nobody stated it, the size of the
/// noise are chosen by restricted maximum likelihood (interp/reml.hpp). The model is linearised
/// anew until it settles. Points that do not fit the rest are first weighted down, then set aside:
/// a point is an outlier where its residual, seen from a fit without it, is beyond kOutlierDistance
/// sigmas of the plane (two chains).
///
/// Sources: S. Wood, Generalized Additive Models (2017), sections 4.2 and 6.2, for the mixed model;
/// P. Huber and E. Ronchetti, Robust Statistics (2009), section 7.7, for the weights.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/residual_surface.hpp"
#include "grid/measured_grid.hpp"
#include "interp/reml.hpp"

namespace chaintrue::grid {

/// A point with its lengths, however they were given.
struct LengthPoint {
  std::size_t index = 0;  ///< into the grid's points
  model::BedPoint mark;
  model::ChainLengths lengths;
};

/// One sigma of a chain's length scale beforehand: twice a new chain's usual error, 0.0005 to
/// 0.0015.
inline constexpr double kScaleSigma = 0.002;
/// One sigma beforehand of what the penalty leaves free in the residual surfaces: their height at
/// the bed's centre, the rise from there to its edge and, for order 3, the bow.
inline constexpr double kFreePartSigmaMm = 1.0;
/// Chance 4e-5 for a good point: 1 in 900 grids of 28 good points loses one.
inline constexpr double kOutlierDistance = 4.5;

struct JointFitInput {
  model::Machine machine;  ///< as stated
  std::vector<LengthPoint> points;
  model::PointNoise noise;
  interp::NoiseScale noise_scale;
  std::optional<SheetUncertainty> sheet;
  std::vector<std::shared_ptr<const model::Observation>> extra;
  interp::Rectangle domain;
  /// Order of the derivatives that the surfaces' penalty squares: 2, a thin plate, or 3, smoother
  /// still.
  int bending_order = 2;
};

/// One point after the fit.
struct FittedPoint {
  LengthPoint point;
  bool bad = false;
  double distance = 0.0;  ///< of the left-out residual, in sigmas
  /// Measured minus predicted, in the chains.
  Eigen::Vector2d residual_mm;           ///< of the finished map
  Eigen::Vector2d left_out_residual_mm;  ///< of a map made without this point
  Eigen::Matrix2d mark_jacobian;         ///< d(lengths)/d(mark)
};

struct JointFit {
  model::Machine machine;  ///< calibrated
  model::SheetPlacement sheet;
  std::vector<model::Setting> settings;
  FitColumns columns;
  ResidualSurface surface;
  Eigen::MatrixXd covariance;  ///< of all unknowns, columns.total() squared
  double noise_factor = 1.0;   ///< the noise found, as a multiple of the one that went in
  double effective_parameters = 0.0;
  std::vector<FittedPoint> points;
  /// Held-out residuals with whole blocks of the bed left out, chain lengths, in the order of
  /// `points`.
  std::vector<Eigen::Vector2d> blocked_residual_mm;
  /// False where settings or weights still moved after the last pass.
  bool settled = true;
};

struct JointFitFailure {
  enum class Reason { point_unreachable, rank_deficient, not_converged } reason;
  std::string sentence;
};

[[nodiscard]] tl::expected<JointFit, JointFitFailure> fit_jointly(const JointFitInput& input);

}  // namespace chaintrue::grid
