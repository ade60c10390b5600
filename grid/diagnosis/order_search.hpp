// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Estimates the order in which unnumbered marks were visited. Friction and drift depend on the
/// order of the visits, so their size under an order is evidence for it. The prior for marks in
/// lines is one half for the sixteen line-by-line orders (visiting_order.hpp), which are equally
/// likely:
///
///   p(o) = sum_M w_M (1 / 2K) sum_c odds_M B(c | M, o) / (sum_M w_M (1 + (1 / 2K) sum_o,c odds_M B(c | M, o)))
///
///   M  the leading models of the comparison without an order, w_M their weights
///   c  causes that depend on the order by a size alone (friction, drift), B their evidence given M
///   K  orders that the marks have; odds_M of one cause more
///
/// p(o) is the probability that it was this order and that the readings depend on it: if nothing
/// depends on it, no order is found.
///
/// \code
///   const auto analysis = analyse(session, options);
///   if (const auto found = find_visiting_order(measured, *analysis)) ...  // analyse again, in this order
/// \endcode
#pragma once

#include <optional>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// The order of a grid without visit numbers, if its probability is at least kOrderFound; with its
/// corner only if no mark was repeated, since a repeat may come between any two visits. Empty if
/// the grid has an order or its marks are not in lines. \pre `analysis` covers this file only.
std::optional<VisitingOrderFound> find_visiting_order(const Measured& measured,
                                                      const Analysis& analysis);

/// As above for the first of several files, analysed alone: only its order matters to their
/// diagnosis. Empty if it is not a grid, or another grid has an order.
std::optional<VisitingOrderFound> find_order_of_first(const Measured& measured,
                                                      const DiagnosisOptions& options);

/// The measurements with the first grid's visits numbered in this order, if no grid has one; empty
/// if the marks do not have it. Repeated marks come last, by place.
std::optional<Measured> visited_in(const Measured& measured, const VisitingOrder& order);

}  // namespace chaintrue::grid::diagnosis
