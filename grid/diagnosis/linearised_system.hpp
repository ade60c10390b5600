// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The session as linear equations about a state of the machine: whitened residuals, how the
/// settings move them, and a regressor for every effect of the catalogue at every place where it
/// may set in.
///
/// Of holes (observed/observed.hpp) the rows are distances, with W_i = 1 / tape's sigma, and A has
/// a column more for each nuisance.
///
/// Notation
///   r_i  readings of a point less what the state predicts [mm], two chains
///   C_i  J S_xy J' + diag(s_L^2), J = d(L, R)/d(mark): its covariance from position and length
///   noise W_i  whitening, W_i C_i W_i' = I                e    all W_i r_i, then the readings over
///   sigma A    d(prediction)/d(settings), whitened        g_k  prediction with the effect less
///   without it, whitened
///
/// A regressor is a secant: exact at the size at which it was taken, and proportional to
/// size^power. Coefficient b of a regressor is (size / that size)^power; a power of about one goes
/// on through zero as a straight line.
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/session.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::diagnosis {

/// An effect at one side, one place and one size.
struct Regressor {
  CauseId cause;
  std::vector<double> values;  ///< sizes and places, in the effect's order
  double power = 1.0;          ///< of a refined one: as it is about its size
  /// The size is a whole number: the coefficient is 1 and `values` hold it.
  bool fixed = false;
  /// It acts at one visit alone.
  bool slip = false;
  /// The secant was taken at a size that was found: its coefficient can be held against its bounds.
  bool refined = false;
  /// What the coefficient may be.
  double lowest = 0.0;
  double highest = 0.0;
  /// Of a cause with whole numbers: visits at which it may be.
  double visits = 0.0;
  /// Share of this side, place and whole number within the effect (whole numbers: link_priors.hpp).
  double log_prior = 0.0;
};

/// One point, or hole, as the state sees it.
struct PointState {
  model::PointReading reading;
  Eigen::Matrix2d by_mark;    ///< J
  Eigen::Matrix2d whitening;  ///< W, of a point
};

/// A unit's whitened rows by what is added to the left and the right chain at one place; a unit of
/// one row leaves the second line empty.
struct SeenPlace {
  std::size_t place = 0;
  Eigen::Matrix2d by_chain = Eigen::Matrix2d::Zero();
};
using Unit = std::vector<SeenPlace>;

struct LinearisedSystem {
  Eigen::VectorXd e;
  Eigen::MatrixXd by_setting;  ///< A
  Eigen::MatrixXd g;           ///< a column a regressor
  std::vector<Regressor> regressors;
  std::vector<PointState> points;
  std::vector<Unit> units;
  Eigen::Index unit_rows = 2;
  Eigen::VectorXd row_sigma_mm;     ///< of distances: of the tape
  Eigen::VectorXd setting;          ///< value in the state
  Eigen::VectorXd expected_change;  ///< stated less that
  Eigen::Index nuisances = 0;       ///< the last of these columns
  Eigen::VectorXd sigma;            ///< as stated
};

/// Effects that these data can never show, each with its reason.
struct Candidates {
  std::vector<CauseId> testable;
  std::vector<NotTestable> not_testable;
};
[[nodiscard]] Candidates candidates(const Session& session);

/// Sizes at which secants are taken where the usual one is not wanted, and extra places.
struct Refinement {
  CauseId cause;
  std::vector<double> values;
  double log_prior = 0.0;
};

/// The system without regressors. Fails where a point, or a hole, cannot be reached.
[[nodiscard]] tl::expected<LinearisedSystem, model::VisitFailure> linearise(const Session& session,
                                                                            const State& state,
                                                                            const Steps& steps);

/// Appends the regressors of all these causes.
void add_regressors(const Session& session,
                    const State& state,
                    const std::vector<CauseId>& causes,
                    const std::vector<Refinement>& refinements,
                    LinearisedSystem& system);

/// What stands in the nuisances' columns; nothing for points.
[[nodiscard]] inline auto nuisance_columns(const LinearisedSystem& system) {
  return system.by_setting.rightCols(system.nuisances);
}

/// Regressors anew about another state, at their values. False where such a machine cannot be.
[[nodiscard]] bool renew_regressors(const Session& session,
                                    const State& state,
                                    const std::vector<Regressor>& regressors,
                                    LinearisedSystem& system);

/// The whitened column of an effect of these values; empty where such a machine cannot be.
[[nodiscard]] std::optional<Eigen::VectorXd> signature(const Session& session,
                                                       const State& state,
                                                       const LinearisedSystem& system,
                                                       CauseId cause,
                                                       const std::vector<double>& values);

/// Size of a cause at a coefficient of its regressor.
[[nodiscard]] double size_at(const Regressor& regressor, double coefficient);
/// d(size)/d(coefficient) there.
[[nodiscard]] double size_slope(const Regressor& regressor, double coefficient);

}  // namespace chaintrue::grid::diagnosis
