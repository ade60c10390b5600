// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure next so that the leading hypotheses part.
///
/// Notation
///   pi_k  probability of hypothesis k, a set of causes
///   m_k   mean of the new readings as k predicts them
///   S_k   their covariance, settings and sizes uncertain
///   D_kl  (m_k - m_l)' ((S_k + S_l) / 2)^-1 (m_k - m_l) over all new readings chosen so far
///
/// Chosen one after the other to make the sum over pairs of sqrt(pi_k pi_l) exp(-D_kl / 8)
/// smallest, the Bhattacharyya bound on taking one for the other. The log Bayes factor of k against
/// l is then about N(D / 2, D), which gives the probability that the right one is named alone.
///
/// Sources: T. Kailath, IEEE Trans. Commun. Technol. 15 (1967) 52, for the bound; G. Box and W.
/// Hill, Technometrics 9 (1967) 57, for choosing experiments that tell models apart.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kMostNextMeasurements = 8;

/// Empty where fewer than two hypotheses are left to tell apart.
[[nodiscard]] std::vector<NextMeasurement> next_measurements(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
