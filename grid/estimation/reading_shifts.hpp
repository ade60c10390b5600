// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Single readings of units as mean shifts: the deviation of a reading from the prediction by all
/// others, and its significance. Private to grid/estimation.
///
/// Notation, of a unit with whitened rows X and residuals r in a fit with covariance C, noise s^2 and
/// n degrees of freedom
///   d   effect of a millimetre of the reading on the rows
///   N     orthonormal complement of the effects of the unit's other rejected readings
///   d~ = N' d,   r~ = N' r,   S = N' X C X' N,   M = I - S / s^2
///
/// For a reading that counts
///
///   off = d~' r~ / (d~' M d~)                                                               (1)
///   t   = d~' r~ / (s_out sqrt(d~' M d~)),   s_out^2 = (s^2 n - off d~' r~) / (n - 1)          (2)
///
/// and, for a rejected reading, off = d~' r~ / d~' d~ with variance s^2 / d~' d~ + d~' S d~ / (d~' d~)^2.
/// What counts is the normal deviate of the same chance as t.
///
/// Sources: R. Cook and S. Weisberg, Residuals and Influence in Regression (1982), sections 2.2 and
/// 2.3, for readings left out; D. Wallace, Ann. Math. Statist. 30 (1959) 1121, for the deviate of t,
/// within 0.02 of it from 4 degrees of freedom on.
#pragma once

#include <vector>

#include "grid/estimation/linearised_system.hpp"
#include "interp/eigen.hpp"
#include "interp/reml.hpp"

namespace chaintrue::grid::estimation {

/// For each unit, the readings that are rejected.
using RejectedReadings = std::vector<Rows>;

/// N of these readings of a unit: rows x what they leave.
[[nodiscard]] MatrixXd without_readings(const SystemUnit& unit, const Rows& rejected);

/// If less than this share of its weight remains, no other reading determines it.
inline constexpr double kOwnWord = 1e-6;

/// The normal deviate of the same chance as Student's t.
double normal_deviate(double t, double dof);
/// (2), for a residual r with the share `kept` of its weight after leaving it out.
double deleted_deviate(double r, double kept, double s2, double dof);

struct ReadingShift {
  double residual_mm = 0.0;  ///< reading minus the prediction by all others
  double sigmas = 0.0;       ///< 0 if no other reading determines it
};

/// A fit to the rows of a linearised system.
struct FittedRows {
  const MatrixXd& design;
  const VectorXd& residual;
  const interp::PenalisedFit& fit;
  double dof = 0.0;  ///< n
};

ReadingShift shift_of(const FittedRows& rows, const SystemUnit& unit, const Rows& rejected,
                      Index reading);

}  // namespace chaintrue::grid::estimation
