// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Searches the relevant sets of causes in one marginalised system: all sets of one and two
/// causes, sets of three and four grown from the best, and the leading ones again given a model
/// discrepancy.
#pragma once

#include <set>
#include <vector>

#include "grid/diagnosis/model_collector.hpp"

namespace chaintrue::grid::diagnosis {

class SetSearch {
 public:
  /// `number` is the marginalised system's in its comparison; all references must outlive the
  /// search.
  SetSearch(const RegressorSystem& system,
            MarginalisedSystem& marginalised,
            std::size_t number,
            const ComparisonOptions& options);

  [[nodiscard]] std::vector<CandidateModel> run();
  /// Call after run(). For these kernels; sets their weights.
  [[nodiscard]] std::vector<CandidateModel> run_given_discrepancies(
      const Indices& kernels, std::vector<double>& kernel_weight);
  /// Largest weight so far.
  [[nodiscard]] double best() const { return collector_.best(); }
  [[nodiscard]] const Flags& outliers() const { return marginalised_.outliers; }

 private:
  /// Regressors to keep: all without whole numbers, except that effects at a visit keep their best
  /// visits; of the others the best, alone or after projection on a leading regressor.
  [[nodiscard]] RegressorSet columns() const;
  void singles();
  /// Upper bound of a pair's weight, ignoring bounds and larger noise.
  [[nodiscard]] double quick_weight(Eigen::Index i, Eigen::Index j) const;
  void pairs();
  void grow();
  void extend(const ColumnSet& parent, std::set<ColumnSet>& found);
  double consider(const ColumnSet& set) { return collector_.consider(set, -1, equations_); }
  [[nodiscard]] const Regressor& regressor(Eigen::Index i) const {
    return system_.regressor(equations_.columns[as_size(i)]);
  }

  const RegressorSystem& system_;
  MarginalisedSystem& marginalised_;
  const ComparisonOptions& options_;
  ModelCollector collector_;
  NormalEquations equations_;
  std::vector<WeighedSet> scored_;
};

}  // namespace chaintrue::grid::diagnosis
