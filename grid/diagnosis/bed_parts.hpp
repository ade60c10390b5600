// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Probabilities averaged over parts of the bed, for a smooth pattern that no cause explains.
///
/// The kernels of the discrepancy describe such a pattern only approximately, and a slightly wrong
/// likelihood gives odds of a thousand that other marks on the same machine would not repeat. The
/// average over parts keeps what each part would repeat:
///
///   p(model | pattern) = sum_k p_k(model and pattern) / sum_k p_k(pattern)
///   p_k                  given all readings but those of part k, the evidence of each model counted as of
///                        as many readings as there are in all
///
/// A part is the quarter of the readings on one side of a line, since what a model misses is correlated over
/// the bed: single readings drawn at random would all repeat it. The probability of a pattern and
/// of every model without one stay as with all readings.
///
/// Each part's probabilities cover the models of the whole comparison (downdating.hpp): averaged over the
/// parts within 0.03 of comparisons made anew in 41 of 50 sets, the worst 0.18 off (tests/diagnosis/bed_parts_test.cpp).
///
/// Sources: J. Huggins and J. Miller, Bayesian Analysis 18 (2023), 79; on blocks P. Hall, J. Horowitz and
/// B. Jing, Biometrika 82 (1995), 561.
///
/// \code
///   const std::vector<PartPosterior> parts = average_over_parts(system, fewest, comparison);
/// \endcode
#pragma once

#include <utility>
#include <vector>

#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

/// Units left out together, positions in the system.
struct BedPart {
  double towards_rad = 0.0;  ///< where they lie, from the middle of all; from x towards y
  Indices units;
};

/// The quarters on one side of each of sixteen lines; only those that leave at least `fewest` units, not
/// on one line. A distance counts at its midpoint. Empty where fewer than half of the sixteen can
/// be formed: the least number of readings in which one direction does not outweigh the others.
std::vector<BedPart> bed_parts(const RegressorSystem& system, std::size_t fewest);

/// The result from some of the readings alone.
struct PartPosterior {
  BedPart left_out;         ///< of a session: all others
  std::size_t session = 0;  ///< into the observations
  /// Probability of each cause in any model.
  std::vector<std::pair<CauseId, double>> causes{};
  double caused = 0.0;  ///< that any acts
};

/// Replaces the weights by averaged probabilities and returns the results of the parts. The
/// comparison is unchanged if no parts can be formed or a pattern is not more likely than not.
std::vector<PartPosterior> average_over_parts(const RegressorSystem& system, std::size_t fewest,
                                              ModelComparison& comparison);

/// Results of each session alone; sessions of fewer than `fewest` units are left out, and the
/// result is empty if fewer than two remain. \pre The comparison's weights are those of all
/// readings, not averaged.
std::vector<PartPosterior> session_posteriors(const RegressorSystem& system, std::size_t fewest,
                                              const ModelComparison& comparison);

}  // namespace chaintrue::grid::diagnosis
