// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The anchors of a four-belt router from its own measurements, with sigmas for readings that err
/// only at random.
///
/// 4 N readings of N places leave 2 N - 5 checks once places and anchors have taken their share:
///
///   spread^2 = sum r^2 / (readings - 2 places - 5)                                          (1)
///
/// estimates the error of one belt's reading; the machine's message ("Find Anchors fit: rms")
/// divides by the readings instead. Sigmas are (1) of fit_diagnostics.hpp with this spread.
///
/// A reading that does not fit the others is rejected, the worst first: the distance of its residual,
/// against a fit without it, in units of the spread without it. That is Student's t; what counts is
/// the normal deviate of the same chance.
///
/// Lengths of belts do not determine the scale: readings that are all 1.005 times as long give a
/// frame 1.005 times as large. Taped distances determine it.
///
/// Sources: R. Cook and S. Weisberg, Residuals and Influence in Regression (1982), sections 2.2 and
/// 2.3, for readings left out; D. Wallace, Ann. Math. Statist. 30 (1959) 1121, for the deviate of t,
/// within 0.02 of it from 4 degrees of freedom on.
///
/// \code
///   const auto fit = fit_belts(belts);
///   if (!fit) say(fit.error().sentence());
///   else use(fit->machine, fit->coordinates[0].sigma_mm, fit->residual_sigma_mm);
/// \endcode
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/containers.hpp"
#include "interp/eigen.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// Normal deviate beyond which a reading is rejected: probability 7e-6 for a good one, so one set
/// of 100 places in 370 loses one.
inline constexpr double kBadReadingSigmas = 4.5;
/// Largest share that is rejected; beyond it the remaining readings do not determine their own noise.
inline constexpr double kMostBadReadings = 0.12;

/// One of tl_x_mm, tl_y_mm, tr_x_mm, tr_y_mm, br_x_mm.
struct AnchorCoordinate {
  std::string name;
  std::optional<double> stated_mm;
  double fitted_mm = 0.0;
  double sigma_mm = 0.0;
  /// Share of its variance from each belt's readings; the sum is 1.
  PerBelt<double> variance_share;
};

/// A reading of one belt.
struct BeltResidual {
  double residual_mm = 0.0;  ///< read less fitted
  bool counts = true;        ///< false: rejected
  double sigmas = 0.0;       ///< relative to a fit without it; 0 if no other reading determines it
  double deleted_residual_mm = 0.0;  ///< minus the prediction from all others
};

struct FittedPlace {
  FramePoint at;
  Matrix2d covariance_mm2 = Matrix2d::Zero();
  PerBelt<BeltResidual> belts;
};

struct BadBeltReading {
  std::size_t point = 0;
  Belt belt = Belt::tl;
  double residual_mm = 0.0;  ///< minus the prediction from all others
};

/// Lower belts as predicted from the upper two, at places that were not fitted; the machine's own
/// tension check uses the same.
struct BeltPrediction {
  std::size_t readings = 0;
  double rms_mm = 0.0;
  double largest_mm = 0.0;
};

/// True scale over the belts' scale, from taped distances.
struct BeltScale {
  double factor = 1.0;
  double sigma = 0.0;
  std::vector<double> residuals_mm;  ///< taped less fitted, of each distance
};

/// A cause besides the anchors, which is removed from the readings of a fit.
struct CauseInAnchorFit {
  std::string effect;  ///< of the belts' table
  std::string side;    ///< a belt, "all", or empty
  std::map<std::string, double> parameters;
  double sigma = 0.0;        ///< of its first parameter, in that parameter's unit
  double probability = 0.0;  ///< that it acts
};

struct BeltsFit {
  BeltMachine machine;  ///< with the anchors fitted, in the belts' own millimetres
  std::array<AnchorCoordinate, 5> coordinates;
  Eigen::Matrix<double, 5, 5> covariance_mm2 = Eigen::Matrix<double, 5, 5>::Zero();
  double residual_sigma_mm = 0.0;   ///< (1)
  int checks = 0;                   ///< the denominator of (1)
  double rms_mm = 0.0;              ///< of all readings, as in the machine's message
  PerBelt<double> rms_of_mm;        ///< of those that count
  std::vector<FittedPlace> places;  ///< of each point
  std::vector<BadBeltReading> bad;  ///< rejected, the worst first
  Indices bad_points;               ///< where fewer than three readings agree
  std::optional<BeltScale> scale;   ///< empty: not known
  BeltPrediction one_left_out;
  std::optional<BeltPrediction>
      half_left_out;  ///< either half by the other; with ten places and more
  /// Residuals, places and predictions belong to readings corrected for these; rms_mm is of the
  /// readings as read.
  std::vector<CauseInAnchorFit> causes;
};

enum class BeltsFitReason {
  too_few_points,
  not_determined,  ///< on a line, or in one spot
  no_frame,        ///< no anchors fit the lengths
  hole_without_anchors,
  too_many_distances,
  tape_contradicts,  ///< the belts, or itself
};
using BeltsFitFailure = Failure<BeltsFitReason>;

/// Anchors alone, as the machine fits them: sigmas assume random errors only.
/// grid/diagnosis/anchors_with_causes.hpp allows for other causes.
[[nodiscard]] tl::expected<BeltsFit, BeltsFitFailure> fit_belts(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
