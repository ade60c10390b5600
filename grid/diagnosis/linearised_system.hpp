// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The session as linear equations about a state of the machine: whitened residuals, how settings
/// and nuisances move them, and a regressor for every effect of the catalogue at every place where
/// it may set in. Everything from here on knows units and places, and not how they were measured.
///
/// The rows are those of estimation/linearised_system.hpp, with the session's columns.
///
/// Notation (observation.hpp has the equation of an observation)
///   r    what was read less what the state predicts, in the readings' own units
///   W_u  whitening of unit u: W_u C_u W_u' = I
///   e    W r
///   A    W d(prediction)/d(settings, nuisances)
///   D_i  W d(prediction)/d(chains at place i)
///   g_k  W (prediction with the effect less without it)
///   n    rows: those of the units, then a reading of the machine itself each
///   q    settings (those of a sheet once for each sheet), then nuisances
///
/// Whitened rows have no unit (noise is one); chains and marks are in mm, settings and nuisances in
/// their own units. Source: G. Golub and C. Van Loan, Matrix Computations (2013), section 6.1, for
/// whitening.
///
/// A regressor is a secant: exact at the size at which it was taken, and proportional to
/// size^power. Coefficient b of a regressor is (size / that size)^power; a power of about one goes
/// on through zero as a straight line.
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/regressor_columns.hpp"
#include "grid/diagnosis/session.hpp"

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

/// A place as the state has it.
struct SystemPlace {
  model::PointReading reading;
  model::MarkPoint mark;    ///< as it was written, or commanded
  Eigen::Matrix2d by_mark;  ///< d(L, R)/d(mark)
  int order = 0;
  bool ordered = false;  ///< chains were read here, at this visit
  model::Bed bed;        ///< of the machine that stood here
};

/// What a unit sees of the chains at a place: D_i; a unit of one row leaves the second line empty.
struct SeenPlace {
  std::size_t place = 0;
  Eigen::Matrix2d by_chain = Eigen::Matrix2d::Zero();
};

/// Rows that are good or bad together; one or two.
struct SystemUnit {
  Eigen::Index first_row = 0;
  Eigen::Index rows = 1;
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  ///< of a unit of two rows
  double sigma = 1.0;                                       ///< of a unit of one
  bool reads_chains = false;  ///< the rows are the chains at its only place
  std::vector<SeenPlace> places{};

  /// From the readings' units to those of noise, and back: the rows of this unit.
  [[nodiscard]] Eigen::Vector2d whitened(const Eigen::VectorXd& all) const;
  [[nodiscard]] Eigen::Vector2d unwhitened(const Eigen::VectorXd& all) const;
  [[nodiscard]] auto segment(const Eigen::VectorXd& all) const {
    return all.segment(first_row, rows);
  }
};

struct LinearisedSystem {
  Eigen::VectorXd e;           ///< n
  Eigen::MatrixXd by_setting;  ///< A, n x q
  RegressorColumns g;          ///< n x a column a regressor
  std::vector<Regressor> regressors;
  std::vector<SystemPlace> places{};
  std::vector<SystemUnit> units;    ///< of consecutive rows, the first ones
  std::vector<int> unit_of_row;     ///< n; -1: a reading that never slips
  Eigen::VectorXd reading_sigma;    ///< of the rows after the units, in the readings' units
  Eigen::VectorXd setting;          ///< q, value in the state
  Eigen::VectorXd expected_change;  ///< q, stated less that
  Eigen::Index nuisances = 0;       ///< the last of these q columns
  Eigen::VectorXd sigma;            ///< q, one sigma as stated
  double noise_dof = 15.0;          ///< how well the noise is known, degrees of freedom
  std::size_t fewest_units = 0;     ///< with fewer left, none is set aside

  [[nodiscard]] Eigen::Index observed_rows() const { return e.size() - reading_sigma.size(); }
};

/// Without regressors. Fails with the first place that the machine cannot reach.
[[nodiscard]] tl::expected<LinearisedSystem, observation::Unreachable> linearise(
    const Session& session, const State& state, const Steps& steps);

/// All n rows in units of noise.
[[nodiscard]] Eigen::VectorXd whitened(const LinearisedSystem& system, Eigen::VectorXd all);

/// What stands in the nuisances' columns.
[[nodiscard]] inline auto nuisance_columns(const LinearisedSystem& system) {
  return system.by_setting.rightCols(system.nuisances);
}

/// Units with at least one of their rows among `kept`, which is ascending and holds units whole:
/// the position of their first row in it, and their number.
[[nodiscard]] std::vector<std::pair<Eigen::Index, std::size_t>> units_in(
    const LinearisedSystem& system, const std::vector<Eigen::Index>& kept);

}  // namespace chaintrue::grid::diagnosis
