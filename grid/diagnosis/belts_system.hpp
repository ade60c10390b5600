// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of four belts adds to their linearised system: single readings as outlier groups, what is
/// known beforehand, and a regressor for each cause at every place where it may set in. Private to
/// grid/diagnosis.
///
/// A place leaves two checks of its four readings, a unit of two rows (observation/belt_lengths.hpp). A
/// single reading spoils one direction of them, an outlier group each; two readings of a place take both. The
/// five anchor coordinates are the settings, of which nothing is stated.
#pragma once

#include <string_view>
#include <vector>

#include "grid/diagnosis/belts_given_causes.hpp"
#include "grid/diagnosis/regressors.hpp"

namespace chaintrue::grid::diagnosis {

/// About which everything is linear: the anchors and places with some causes at work, and these.
struct BeltsState {
  belts::AnchorFit frame;
  std::vector<BeltCause> causes;  ///< secants of these are taken at their values
};

/// What gives with the pull is expected, its parts by these shares that sum to 1; 0 of every other
/// effect. Of four published frames three tell the belts' stretch from anchors that give, by factors of
/// 1000 and more; the fourth does not tell.
[[nodiscard]] double share_of_expected(std::string_view effect);

/// What would show the causes that these data cannot.
[[nodiscard]] Candidates candidates(const MeasuredBelts& belts);

/// With a regressor for each of `causes` at every place where it may set in.
[[nodiscard]] RegressorSystem system_of(const MeasuredBelts& belts,
                                        const BeltsState& state,
                                        const std::vector<CauseId>& causes,
                                        double sigma_mm);

/// What causes add to the checks of a system of these belts about this state, whitened.
[[nodiscard]] Eigen::VectorXd column_of(const MeasuredBelts& belts,
                                        const BeltsState& state,
                                        const RegressorSystem& system,
                                        const BeltCause& cause);

/// Of each reading, whether these flags of the system's outlier groups leave it.
[[nodiscard]] belts::Counting counting_of(const RegressorSystem& system,
                                          const std::vector<bool>& rejected);

}  // namespace chaintrue::grid::diagnosis
