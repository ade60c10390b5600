// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The unknowns of a joint estimate, in this order:
///
///   set           columns of the observation set, as deviations from what was stated
///   scales        of either chain; none for a mechanism of more lengths
///   polynomials   of either chain's surface, as the places observe it (observed_subspace.hpp)
///   penalised     the same
///
/// Private to grid/estimation.
#pragma once

#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::estimation {

struct Unknowns {
  Index of_set = 0;
  Index scales = 0;       ///< two, or none: a surface corrects the lengths of two chains
  Index polynomials = 0;  ///< of each chain's surface
  Index penalised = 0;    ///< of each chain's surface

  Index scale(Side side) const { return of_set + row_of(side); }
  Index polynomial(Side side) const { return of_set + scales + row_of(side) * polynomials; }
  Index first_penalised_of(Side side) const {
    return of_set + scales + 2 * polynomials + row_of(side) * penalised;
  }
  Index total() const { return of_set + scales + 2 * (polynomials + penalised); }
};

}  // namespace chaintrue::grid::estimation
