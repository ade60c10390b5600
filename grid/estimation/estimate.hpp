// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The joint estimate: the machine's settings, each sheet's placement, both chains' scales and the
/// residual surface from any mix of observations of one machine.
///
/// Each stated setting enters as a datum with its stated sigma; the chains' scales and the
/// surfaces' polynomials have their own weak priors, so that settings explain what they can.
/// Nuisances that belong to the noise (a hole's own error) are as large with the readings' noise as
/// was stated, whatever the noise turns out to be; the others (a tape's zero, a sheet's size) are
/// data of known sigma, and so are readings that cannot be outliers.
///
///   y = f(theta, s) + B b + W^-1 e,   e ~ N(0, s^2 I),   b_noise ~ N(0, s^2 sigma_b^2)        (1)
///
/// s, one noise factor over what was stated, and the surfaces' smoothness are chosen by restricted
/// maximum likelihood (interp/reml.hpp); for different stated degrees of freedom the fewest are
/// used. The model is linearised again until it converges.
///
/// A sheet that no reading refers to is free: in each direction in which an observation does not
/// depend on its sheet's placement, the sheet is placed so that its places, as a whole, are where
/// they were commanded. These directions are eliminated, exactly.
///
/// Readings that do not fit the rest are first weighted down, then rejected, unit by unit: by the
/// distance of a unit's residual, against a fit without it, in sigmas. A unit of one row beyond
/// kBadDistanceSigmas of what the others make of it, with the noise that they alone show, is set
/// aside, the worst first: among few single numbers a bad one raises the noise found and hides
/// itself. A unit of two rows is rejected beyond kBadPointDistance.
///
/// Sources: S. Wood, Generalized Additive Models (2017), sections 4.2 and 6.2, for the mixed model;
/// P. Huber and E. Ronchetti, Robust Statistics (2009), section 7.7, for the weights; C. Rasmussen
/// and C. Williams, Gaussian Processes for Machine Learning (2006), equations 5.8 and 5.12, for
/// evidence and left-out predictions.
///
/// \code
///   EstimationInput input{machine, {points, holes}};
///   input.domain = bed;
///   const auto estimate = estimation::estimate(input);
///   if (estimate) use(estimate->machine, estimate->surface);
/// \endcode
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/residual_surface.hpp"
#include "grid/observation/observation.hpp"
#include "grid/progress.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"
#include "interp/reml.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid::estimation {

/// Prior sigma of a chain's length scale: twice a new chain's usual error, 0.0005 to 0.0015.
inline constexpr double kScaleSigma = 0.002;
/// Prior sigmas of the unpenalised part of the residual surfaces: their height at the bed's centre,
/// the rise from there to its edge and, for order 3, the bow.
inline constexpr double kFreePartSigmaMm = 1.0;
/// Chance 4e-5 for a good point: 1 in 900 grids of 28 good points loses one.
inline constexpr double kBadPointDistance = 4.5;
/// Chance 1.5e-3 for a good reading (Student's t, some 30 degrees of freedom): one set of twenty
/// readings in thirty-five loses one.
inline constexpr double kBadDistanceSigmas = 3.5;
/// Log evidence of a surface over none that the readings must give: twenty to one.
inline constexpr double kSurfaceEvidence = 3.0;
/// With fewer units of one row than this, none is rejected.
inline constexpr std::size_t kFewestSingleRows = 5;

/// The order of the machine's own unknowns: model::kMachineSettings, the left scale, the right one.
inline constexpr Index kMachineUnknowns = kMachineSettings.size() + 2;

/// Prior of a mechanism's parameters, as deviations from the stated values; for two chains also of
/// both scales, which come last.
struct ParameterKnowledge {
  VectorXd mean;
  MatrixXd covariance;
};
/// The machine's stated uncertainty, and kScaleSigma of each scale.
ParameterKnowledge stated_knowledge(const Machine& machine);

enum class SurfaceUse {
  none,
  smoothed,     ///< always, with the smoothness preferred by the readings
  on_evidence,  ///< if the readings support it (kSurfaceEvidence)
};

/// Units that are left out together.
using UnitGroup = Indices;

/// Limits for rejecting single readings of units whose readings may be outliers one by one
/// (reading_shifts.hpp). The worst is rejected first; those that fit once a worse one is gone count
/// again.
struct ReadingLimits {
  double rejected_beyond = 4.5;  ///< normal deviate
  double most_share = 0.12;      ///< share of all readings, beyond which the rest is not reliable
  /// If the noise found is larger, none is rejected, because the fit is not sound.
  double most_noise = kInfinity;
};

struct EstimationInput {
  Machine machine;  ///< as stated
  /// Replaces the two chains of `machine`: its values are the starting point. A mechanism of other
  /// than two lengths has no scales and no surface.
  std::shared_ptr<const Mechanism> mechanism = nullptr;
  /// The marks' frame of the first is that of the surface and of the map.
  observation::Observations observations;
  interp::NoiseScale noise;
  /// Prior of smoothing and noise (interp/reml.hpp).
  interp::SmoothingPrior noise_prior = interp::SmoothingPrior::avoids_boundary;
  SurfaceUse surface = SurfaceUse::smoothed;
  /// Order of the derivatives that the surfaces' penalty squares: 2, a thin plate, or 3, smoother
  /// still.
  int bending_order = 2;
  interp::Rectangle domain;  ///< of the surface, all places within
  /// The splines' intervals; 0: from the places' own spacing.
  int intervals_x = 0;
  int intervals_y = 0;
  /// For each unit, 0: rejected; no reweighting then, and settings converge to 1e-6 sigmas.
  std::optional<VectorXd> fixed_weights;
  /// Single readings are searched for outliers; with fixed_weights alone.
  std::optional<ReadingLimits> reading_limits;
  std::vector<UnitGroup> held_out_together;
  int most_passes = 0;  ///< 0: as many as these readings need
  /// Receives `step` at each iteration.
  Progress progress{};
  WorkStep step{"settings and correction"};
};

/// A unit after the estimate. Residuals are measured less predicted, in the readings' own unit.
struct UnitEstimate {
  std::size_t observation = 0;
  std::size_t unit = 0;   ///< into the observation's
  double weight = 1.0;    ///< in the final fit; 0: rejected
  double distance = 0.0;  ///< of the left-out residual, in sigmas
  VectorXd residual;
  VectorXd left_out;             ///< against a fit without the unit
  MatrixXd left_out_covariance;  ///< of that, including the unit's own noise
  VectorXd left_out_with_group;  ///< empty if no group has the unit
  bool is_rejected() const { return weight == 0.0; }
};

/// A reading that was rejected alone; the rest of its unit counts.
struct ReadingEstimate {
  std::size_t observation = 0;
  observation::UnitReading reading;  ///< its unit into the observation's
  double residual_mm = 0.0;          ///< read minus the prediction by all others
  double sigmas = 0.0;
};

struct PlaceEstimate {
  /// Position by the stated machine, with a free sheet placed as defined above.
  MarkPoint as_stated;
  MarkPoint mark;
  Matrix2d by_mark;      ///< d(L, R)/d(mark), corrected
  ChainLengths lengths;  ///< of the machine alone
};

struct SessionZero {
  double mm = 0.0;
  double sigma_mm = 0.0;
};

/// "left chain 5.0 +- 0.1 mm more", both if both exceed the noise; empty if neither does.
std::string words_of(const std::array<SessionZero, 2>& zeros);

/// Results of one observation.
struct ObservationEstimate {
  SheetPlacement sheet;
  VectorXd predicted;  ///< in the order of the observation's rows
  std::vector<PlaceEstimate> places;
  VectorXd nuisance;
  VectorXd nuisance_sigma;
  /// Zero of either chain in this session minus the machine's, mm, with one sigma; empty if the
  /// machine's zeros are those of this session.
  std::optional<std::array<SessionZero, 2>> zeros{};
};

struct Estimate {
  Machine machine;                ///< calibrated
  std::vector<Setting> settings;  ///< of the machine, and of the first sheet
  /// Deviations of the settings from what was stated, then the scales.
  VectorXd map_unknowns;
  FitColumns columns;
  ResidualSurface surface;  ///< without one: scales only
  bool has_surface = false;
  double surface_log_evidence = 0.0;  ///< of the surface over none, if requested
  MatrixXd covariance;                ///< of all unknowns of a map, columns.total() squared
  ParameterKnowledge knowledge;       ///< of the parameters, afterwards
  double noise_factor = 1.0;          ///< the noise found, as a multiple of the one that went in
  double effective_parameters = 0.0;
  std::vector<UnitEstimate> units;  ///< of readings that may be outliers
  std::vector<ObservationEstimate> observations;
  std::vector<ReadingEstimate> rejected_readings;
  /// False if settings or weights still changed in the last pass.
  bool converged = true;
  /// With the fitted values; for two chains that of `machine`. Its parameters are the first of
  /// map_unknowns and of covariance.
  std::shared_ptr<const Mechanism> mechanism = nullptr;
};

enum class EstimationReason { place_unreachable, rank_deficient, not_converged };
using EstimationFailure = Failure<EstimationReason>;

/// Deterministic: same input, same bytes. \throws std::invalid_argument without an observation.
[[nodiscard]] tl::expected<Estimate, EstimationFailure> estimate(const EstimationInput& input);

}  // namespace chaintrue::grid::estimation
