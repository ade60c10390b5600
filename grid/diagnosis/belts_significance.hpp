// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How often noise alone lets some cause of four belts look as strong as the strongest does. Private
/// to grid/diagnosis.
///
/// Of belts neither the noise nor the anchors are stated: both are found from the readings themselves.
/// What is then left of normal noise lies in every direction alike, however large it is, so that the
/// strongest score has one distribution for all residuals of one length:
///
///   e  <-  |e| z / |z|,   z = P (standard normal),   P without what the anchors take       (1)
///
/// with causes tried at the same sizes and places whatever the readings show: about anchors alone.
/// About a state that was found, their sizes would follow the noise and the draws would not.
///
/// Source: E. Lehmann and J. Romano, Testing Statistical Hypotheses (2005), section 5.2, for tests
/// whose unknown scale is conditioned out.
#pragma once

#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Sets null distribution, score and chance, with the readings of the best model set aside, and the
/// score of each cause.
void test_significance_of_belts(BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
