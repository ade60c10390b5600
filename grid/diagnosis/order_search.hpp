// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// In which order marks were visited that bear no numbers, as far as the readings say.
///
/// Friction and drift depend on the order of the visits, so that their size under one order is evidence for
/// it. Beforehand marks that stand in lines were visited in one of the sixteen orders line by line
/// (visiting_order.hpp) as likely as not, each of these as likely as the others:
///
///   p(o) = sum_M w_M (1 / 2K) sum_c odds_M B(c | M, o) / (sum_M w_M (1 + (1 / 2K) sum_o,c odds_M B(c | M, o)))
///
///   M  the leading models of the comparison without an order, w_M their weights
///   c  causes that depend on the order by a size alone (friction, drift), B their evidence given M
///   K  orders that the marks have; odds_M of one cause more
///
/// p(o) is the probability that it was this order and that the readings depend on it: where nothing does,
/// no order is found.
///
/// \code
///   const auto analysis = analyse(session, options);
///   if (const auto found = find_visiting_order(measured, *analysis)) ...  // analyse again, in this order
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/visiting_order_found.hpp"

namespace chaintrue::grid::diagnosis {

/// An order that the readings of a grid without numbers of visits say at least kOrderFound; its corner only
/// where no mark was measured again, which somebody may have done between any two others. Nothing where
/// the grid has an order, or its marks stand in no lines. \pre `analysis` is of this one file.
[[nodiscard]] std::optional<VisitingOrderFound> find_visiting_order(const Measured& measured,
                                                                    const Analysis& analysis);

/// The same of the first of several files, analysed by itself: its order alone has a part in their diagnosis. Nothing
/// where it is no grid, or another grid has an order.
[[nodiscard]] std::optional<VisitingOrderFound> find_order_of_first(const Measured& measured,
                                                                    const DiagnosisOptions& options);

/// p(o) of each of line_by_line_orders(); 0 for those that the marks do not have. \pre one file.
[[nodiscard]] std::vector<double> order_probabilities(const Measured& measured, const Analysis& analysis);

/// With the visits of the first grid numbered in this order, where no grid has one; nothing where the marks do not have it.
/// Marks measured again come last, by place.
[[nodiscard]] std::optional<Measured> visited_in(const Measured& measured, const VisitingOrder& order);

}  // namespace chaintrue::grid::diagnosis
