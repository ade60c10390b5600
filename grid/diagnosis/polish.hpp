// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The causes that lead a contest, refitted without linearisation: sizes, places and settings moved
/// until the secants taken at them fit as they are.
///
/// A secant is exact at its own size alone. Half a chain's weight gone, a pull of several newtons or
/// the phase of a wave along a chain whose zero moves by a millimetre need several rounds; about
/// where they end the contest is held again.
#pragma once

#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/judgement.hpp"

namespace chaintrue::grid::diagnosis {

struct Polished {
  State state;
  std::vector<Refinement> refinements;  ///< of the causes whose size is no whole number
};

/// `directions` of `rows` and the points that `space` sets aside, from the state of the rows.
[[nodiscard]] Polished polish(const Session& session,
                              const State& state,
                              const Rows& rows,
                              const Space& space,
                              const std::vector<int>& directions,
                              const Steps& steps);

}  // namespace chaintrue::grid::diagnosis
