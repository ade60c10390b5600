// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine fitted to distances between holes. Unknown are the settings (each stated one is a
/// datum with its sigma), a length scale of either chain, the sheet's placement where its edges
/// were measured and, where the distances ask for it, a smooth correction of the chain lengths.
/// Where the holes are follows from these (tape_distances.hpp).
///
/// The frame of the sheet is free in each direction that no edge was measured for: there it is laid
/// so that the holes lie, as a whole, where they were commanded. That defines the frame and tells
/// nothing of the machine.
///
/// Notation: y, readings less what the settings before the fit predict; A, their derivative by the
/// unknowns; P, the unknowns' covariance beforehand; V, the readings' (tape_distances.hpp (2)):
///
///   K = A P A' + s^2 V,  b = P A' K^-1 y,  cov b = P - P A' K^-1 A P                        (1)
///   left out:  y_k - E y_k = (K^-1 y)_k / (K^-1)_kk,  variance 1 / (K^-1)_kk                (2)
///
/// s, the noise found as a multiple of what was stated, has the greatest posterior with its stated
/// degrees of freedom. A reading beyond kOutlierSigmas of what the others alone make of it,
/// with the noise that they alone show, is set aside, the worst first. Sources: C. Rasmussen and C.
/// Williams, Gaussian Processes for Machine Learning (2006), equations 2.25, 2.26, 5.8 and 5.12; P.
/// Huber and E. Ronchetti, Robust Statistics (2009), section 7.7, for the weights of the first
/// passes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/tape_distances.hpp"
#include "grid/map/fit.hpp"

namespace chaintrue::grid {

/// Chance 1.5e-3 for a good reading (Student's t, some 30 degrees of freedom): one set of twenty
/// readings in thirty-five loses one.
inline constexpr double kOutlierSigmas = 3.5;

/// The order of the machine's own unknowns: model::kMachineSettings, the left scale, the right one.
inline constexpr Eigen::Index kHolesUnknowns = 8;

/// What is known of the machine beforehand, where it is more than its file states: deviations from
/// the stated settings and scales of nothing.
struct HolesPrior {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(kHolesUnknowns);
  Eigen::MatrixXd covariance;  ///< kHolesUnknowns squared
};
/// The machine's stated uncertainty, and kScaleSigma (grid/map/joint_fit.hpp) of each scale.
[[nodiscard]] HolesPrior stated_prior(const model::Machine& machine);

struct FittedDistance {
  double measured_mm = 0.0;  ///< without the hook
  double commanded_mm = 0.0;
  double predicted_mm = 0.0;  ///< by the fitted machine
  /// Measured less predicted by a fit without this reading, and one sigma of that.
  double left_out_mm = 0.0;
  double left_out_sigma_mm = 0.0;
  bool set_aside = false;
  [[nodiscard]] double sigmas() const { return left_out_mm / left_out_sigma_mm; }
};

/// By how much the readings of a session are all too long, where the hook's offset was not known
/// exactly.
struct FoundHook {
  double mm = 0.0;
  double sigma_mm = 0.0;
};

struct FittedHole {
  model::ChainLengths lengths;  ///< paid out
  model::BedPoint as_stated;    ///< where the machine as stated puts it, in the sheet's frame
  model::BedPoint predicted;    ///< where the fitted machine puts it
  model::BedPoint place;        ///< where the distances say it is
};

struct HolesFit {
  model::Machine machine;  ///< calibrated
  model::SheetPlacement sheet;
  observation::SheetPrior sheet_measured;
  ModelSurface surface;
  HolesPrior posterior;  ///< of the machine's own unknowns
  double noise_factor = 1.0;
  /// Of the residual surface over none, in natural units; the surface is used from kSurfaceEvidence
  /// on.
  double surface_log_evidence = 0.0;
  bool has_surface = false;
  std::vector<FittedDistance> distances;
  std::vector<FittedHole> holes;
  std::vector<FoundHook> hooks;  ///< by session; none where it was known
  ErrorSummary left_out_all;     ///< every reading
  ErrorSummary left_out_good;    ///< those that fit
  std::vector<std::string> notes;
};

/// Twenty to one.
inline constexpr double kSurfaceEvidence = 3.0;

/// `prior` replaces what the machine states. \throws std::invalid_argument for a set without a
/// machine or without distances.
[[nodiscard]] tl::expected<HolesFit, FitFailure> fit_holes(
    const MeasuredHoles& set, const std::optional<HolesPrior>& prior = std::nullopt);

/// The fit as a map, for query, gcode, report and check.
[[nodiscard]] CompensationMap map_of(const MeasuredHoles& set, const HolesFit& fit);

}  // namespace chaintrue::grid
