// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sets of causes that matter given a model discrepancy, in one marginalised system.
///
/// Every kernel and strength is looked at with nothing, with each cause alone and with the best
/// sets that were found without a discrepancy; those that hold a share of the weight are then
/// searched on their own, since given a discrepancy other causes may lead than without one.
#pragma once

#include <vector>

#include "grid/diagnosis/model_collector.hpp"

namespace chaintrue::grid::diagnosis {

/// `plain`: normal equations of all regressors worth their place, without a discrepancy; `leading`:
/// the best sets of two and more of these, best first; `kernels`: those to try. Models go to the
/// collector. Notes the traces in the marginalised system. Returns of each of `kernels` the largest
/// weight that it was found to have.
std::vector<double> search_given_discrepancies(const RegressorSystem& system,
                                                MarginalisedSystem& marginalised,
                                                const ComparisonOptions& options,
                                                const NormalEquations& plain,
                                                const std::vector<std::vector<int>>& best_models,
                                                const std::vector<std::size_t>& kernels,
                                                ModelCollector& collector);

}  // namespace chaintrue::grid::diagnosis
