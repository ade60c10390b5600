// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How well further measurements will distinguish the leading explanations.
///
/// Notation
///   p_k       probability of alternative k, a set of causes and whether a discrepancy acts with it
///   K, p_K    its group: alternatives that the verdict does not separate, and their sum; of causes
///             of one class there is one alternative for each, since a reading may touch one of them
///             and not the other (a link's pitch: the chain, and not the tape)
///   m_k, S_k  mean and covariance of the new readings as k predicts them, settings and sizes
///             uncertain
///   D_kl      (m_k - m_l)' ((S_k + S_l) / 2)^-1 (m_k - m_l) over the readings asked for
///
///   confusion    sum over pairs of groups of sqrt(p_K p_L) times the mean of exp(-D_kl / 8) over
///                their members: the Bhattacharyya bound where a group has one
///   named_alone  sum over k of p_k P(odds of all other groups together < those of being named | k):
///                summed over the log odds of the group that takes most, and of the others the one
///                that is the likeliest to take the rest; log odds of K against L about
///                N(D_kl / 2 + log(p_K' / p_L'), D_kl), l the member of L nearest to k, and p' what
///                a group weighs once its members are distinguished:
///                p_K' = sum over j in K of p_j exp(-(D_kj - D_kk) / 2), likewise about l for L
///
/// A reading for which all alternatives predict the same changes neither.
///
/// Sources: T. Kailath, IEEE Trans. Commun. Technol. 15 (1967) 52, for the bound; G. Box and W.
/// Hill, Technometrics 9 (1967) 57, for choosing experiments that tell models apart. Private to
/// grid/diagnosis.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

struct Alternative {
  std::size_t group = 0;
  RegressorSet regressors;
  int discrepancy = -1;      ///< with them, as in the most probable model of these causes
  double probability = 0.0;  ///< their sum over all alternatives is 1
  VectorXd mean;             ///< m_k, whitened, of every row of the session of candidates
  MatrixXd covariance;       ///< S_k without the noise
};

/// The remaining sets of causes, each at its best places, by group and the most probable first,
/// with their predictions for every row of `next`, which has the analysis' unknowns
/// (NextCandidates). If the verdict names causes these are the sets of that many; otherwise those
/// of none and of one, with and without a discrepancy. Empty if a place of `next` cannot be
/// reached.
std::optional<std::vector<Alternative>> alternatives_about(const Analysis& analysis,
                                                           const ObservationSet& next);

/// As above for the rows of a system; `column` gives a regressor's column there. Empty if such a
/// machine is invalid.
std::vector<Alternative> alternatives_about(const Analysis& analysis, const RegressorSystem& next,
                                            const ColumnOf& column);

/// As above without predictions: no means and covariances.
std::vector<Alternative> alternatives_of_best(const Analysis& analysis);

/// Divides their probabilities by their sum.
void normalise(std::vector<Alternative>& alternatives);

/// A covariance of whitened rows without what is below a hundredth of the noise.
[[nodiscard]] MatrixXd without_negligible(const MatrixXd& covariance);

struct ExpectedDiscrimination {
  double confusion = 0.0;
  double named_alone = 0.0;  ///< probability that the right group is named alone
};
/// With these rows measured.
ExpectedDiscrimination expected_discrimination(const std::vector<Alternative>& alternatives,
                                               const Rows& rows);

}  // namespace chaintrue::grid::diagnosis
