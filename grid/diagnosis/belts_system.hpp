// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Four belts as a linearised system: from here on there are rows and units, and no word of belts.
/// Private to grid/diagnosis.
///
/// Each place whose coordinates nobody knows leaves two checks of its four readings (belts_beside.hpp),
/// and each check is a unit. A single reading e_b of belt b spoils the direction Q' e_b of its place's
/// two: where one is under suspicion the first check is turned into that direction, so that the reading
/// is set aside with the first unit of its place, and the whole place with both.
///
///   row 2 k      u' Q_k' (...),   u = Q_k' e_b / |Q_k' e_b|
///   row 2 k + 1  across it
///
/// The five anchor coordinates are the settings, of which nothing is stated. Noise is sigma for each
/// reading of each belt.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/belts_beside.hpp"
#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

/// Of each place the belt whose reading may be set aside alone.
using Suspects = std::vector<std::optional<model::Belt>>;

/// About which everything is linear: the anchors and places with some causes at work, and these.
struct BeltsState {
  belts::AnchorFit frame;
  std::vector<BeltCause> causes;  ///< secants of these are taken at their values
};

/// Causes that these data can show, and the others with what would show them.
struct BeltsCandidates {
  std::vector<CauseId> testable;
  std::vector<std::pair<CauseId, std::string>> not_testable;
};
[[nodiscard]] BeltsCandidates candidates(const MeasuredBelts& belts);

/// What the readings of each place are as four lengths of a system: its two checks, rows 2 k and
/// 2 k + 1, of columns of 4 N rows.
[[nodiscard]] Eigen::MatrixXd checked(const std::vector<Eigen::Matrix<double, 4, 2>>& checks,
                                      const Eigen::MatrixXd& readings);

struct BeltsSystem {
  RegressorSystem system;
  std::vector<Eigen::Matrix<double, 4, 2>> checks;  ///< Q_k, the first column u as above
  Eigen::VectorXd residual_mm;                      ///< 4 N, read less what the state makes of it
  Eigen::MatrixXd by_anchor;                        ///< 4 N x 5
  Eigen::MatrixXd by_cause_mm;                      ///< 4 N x a column a regressor
};
/// With a regressor for each of `causes` at every place where it may set in.
[[nodiscard]] BeltsSystem system_of(const MeasuredBelts& belts,
                                    const BeltsState& state,
                                    const std::vector<CauseId>& causes,
                                    double sigma_mm);
/// Turns the checks to where each place's suspect is, the regressors with them.
void turn_to(const Suspects& suspects, double sigma_mm, BeltsSystem& system);

}  // namespace chaintrue::grid::diagnosis
