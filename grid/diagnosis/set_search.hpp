// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Searches the relevant sets of causes in one marginalised system: all sets of one and two
/// causes, sets of three and four grown from the best, and the leading ones again given a model
/// discrepancy.
#pragma once

#include <vector>

#include "grid/diagnosis/model_collector.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

class SetSearch {
 public:
  /// `number` is the marginalised system's in its comparison; all references must outlive the
  /// search.
  SetSearch(const RegressorSystem& system, MarginalisedSystem& marginalised, std::size_t number,
            const ComparisonOptions& options);

  SetSearch(const SetSearch&) = delete;

  std::vector<CandidateModel> run();
  /// Call after run(). For these kernels; sets their weights.
  std::vector<CandidateModel> run_given_discrepancies(const Indices& kernels,
                                                      std::vector<double>& kernel_weight);
  /// Largest weight so far.
  double best() const { return collector_.best(); }
  const Flags& outliers() const { return marginalised_.outliers; }

 private:
  /// Regressors to keep: all without whole numbers, except that effects at a visit keep their best
  /// visits; of the others the best, alone or after projection on a leading regressor.
  RegressorSet columns() const;
  /// Upper bound of a pair's weight, ignoring bounds and larger noise.
  double quick_weight(Index i, Index j) const;
  void pairs();
  /// The columns that explain most of what a set leaves.
  ColumnSet extensions(const ColumnSet& parent) const;

  const RegressorSystem& system_;
  MarginalisedSystem& marginalised_;
  const ComparisonOptions& options_;
  ModelCollector collector_;
  NormalEquations equations_;
  GrowingSets sets_;
};

}  // namespace chaintrue::grid::diagnosis
