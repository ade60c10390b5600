// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Exact binomial tests of counts: bounds of a rate, and a comparison of losses and gains of paired
/// outcomes.
///
/// Sources: Clopper and Pearson, Biometrika 26 (1934) 404-413; McNemar, Psychometrika 12 (1947)
/// 153-157, in its exact form, which is the sign test of the pairs that differ.
#pragma once

#include <vector>

namespace chaintrue::sealed {

/// P(X >= least) of X binomial with `of` trials of probability `p`; to 1e-12 up to 10,000 trials.
/// \throws std::invalid_argument unless 0 <= p <= 1 and of >= 0.
double probability_of_at_least(int least, int of, double p);

struct RateBounds {
  double lower = 0.0;
  double upper = 1.0;
};
/// Two-sided 95 % bounds of Clopper and Pearson: 2.5 % on each side, at most.
/// \throws std::invalid_argument unless 0 <= hits <= of.
RateBounds rate_bounds_95(int hits, int of);

struct Count {
  int hits = 0;
  int of = 0;
};

/// 95 % bounds of a rate over clusters of which each has its own: the wider of the binomial ones and those of
/// Student's t with a degree of freedom less than there are clusters (W. Cochran, Sampling Techniques (1977),
/// section 9A: the ratio estimate of a sample of clusters). 0 to 1 for a single cluster, which carries
/// no information about another.
RateBounds clustered_bounds(const std::vector<Count>& clusters);

/// One-sided exact sign test: the probability of at least that many losses among the sets that
/// differ, if losses and gains are equally likely. Twice this, at most one, is McNemar's exact
/// two-sided test where more were lost than gained. 1 if none differs.
double sign_test(int lost, int gained);

}  // namespace chaintrue::sealed
