// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The minimiser of V over theta, and the posterior averaged about it. Internal to interp; notation
/// as in reml.hpp and reml_likelihood.hpp.

#include <vector>

#include "interp/reml_likelihood.hpp"

namespace chaintrue::interp::reml {

/// The most steps of a search before it counts as not converged.
inline constexpr int kMostSteps = 100;

struct Limits {
  Theta low = Theta::Zero();
  Theta high = Theta::Zero();  ///< equal to `low` if there is nothing to search
};

struct SearchResult {
  Limits limits;
  State state;
  Derivatives derivatives;
};

/// A coarse scan, then Newton with a bounded step.
[[nodiscard]] tl::expected<SearchResult, FitReason> search(const Likelihood& likelihood);

/// Points of the posterior of theta with their weights, of sum 1: steps of one standard error
/// outward from the optimum while the density is above e^-4 of its peak, of lambda anew at each
/// sigma2.
std::vector<Likelihood::Node> posterior_nodes(const Likelihood& likelihood,
                                              const SearchResult& found);

}  // namespace chaintrue::interp::reml
