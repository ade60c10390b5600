// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The causes that lead a model comparison, refitted without linearisation: sizes, places and
/// settings moved until the secants taken at them fit as they are.
///
/// A secant is exact at its own size alone. Half a chain's weight gone, a pull of several newtons
/// or the phase of a wave along a chain whose zero moves by a millimetre need several rounds; about
/// where they end the models are compared again.
#pragma once

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

struct Relinearised {
  State state;
  std::vector<SizedCause> known;  ///< the causes whose size is no whole number
};

/// The causes of the analysis' decision, from its state, with the units set aside that the decision
/// leaves out.
[[nodiscard]] Relinearised relinearise(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
