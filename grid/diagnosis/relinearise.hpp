// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The causes that lead a model comparison, refitted without linearisation: sizes, places and
/// settings moved until the secants taken at them fit as they are.
///
/// A secant is exact at its own size alone. Half a chain's weight gone, a pull of several newtons
/// or the phase of a wave along a chain whose zero moves by a millimetre need several rounds; about
/// where they end the models are compared again.
#pragma once

#include "grid/diagnosis/decision.hpp"
#include "grid/diagnosis/estimate.hpp"

namespace chaintrue::grid::diagnosis {

struct Relinearised {
  State state;
  std::vector<Refinement> refinements;  ///< of the causes whose size is no whole number
};

/// What leads: regressors of the system, beside a model discrepancy or none (-1).
struct Leaders {
  std::vector<int> regressors;
  int discrepancy = -1;
};

/// From the state of the system, with the points set aside that `marginalised` leaves out.
[[nodiscard]] Relinearised relinearise(const Session& session,
                                       const State& state,
                                       const LinearisedSystem& system,
                                       const MarginalisedSystem& marginalised,
                                       const Leaders& leaders,
                                       const Steps& steps);

}  // namespace chaintrue::grid::diagnosis
