// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Weighs sets of causes in one marginalised system and keeps those that matter.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

/// Positions in the normal equations.
using ColumnSet = std::vector<Eigen::Index>;
struct WeighedSet {
  double weight = 0.0;
  ColumnSet set;
};
/// The heaviest sets, those that tie with the last of `most` among them; none where no set of them is within
/// reach of the best.
void narrow(std::vector<WeighedSet>& parents, double best, std::size_t most);

/// May two regressors act together: one cause acts at one place, an effect that acts on both chains
/// equally not also on one of them, and of what sets in at one visit of one chain there is one.
[[nodiscard]] bool compatible(const Regressor& a, const Regressor& b, const SearchLimits& limits);
/// The set with a column more; nothing where that may not act together with it.
[[nodiscard]] std::optional<ColumnSet> with_column(const RegressorSystem& system,
                                                   const NormalEquations& equations,
                                                   const SearchLimits& limits,
                                                   ColumnSet set,
                                                   Eigen::Index column);

class ModelCollector {
 public:
  /// `number` is the marginalised system's in its comparison; the references must outlive this.
  ModelCollector(const RegressorSystem& system,
                 const MarginalisedSystem& marginalised,
                 std::size_t number,
                 const ComparisonOptions& options);

  /// Weighs a set and keeps it where it matters; minus infinity where it cannot be.
  double consider(const ColumnSet& set, int discrepancy, const NormalEquations& equations);
  /// Logarithm of the prior of a set with a discrepancy or none, the discrepancy's share in it.
  [[nodiscard]] double log_prior_of(const std::vector<int>& regressors, int discrepancy) const;

  [[nodiscard]] double best() const { return best_; }
  [[nodiscard]] const NoiseDensity& noise() const { return noise_; }
  /// All kept so far; none are left.
  [[nodiscard]] std::vector<CandidateModel> take();

 private:
  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  std::size_t number_;
  const ComparisonOptions& options_;
  NoiseDensity noise_;
  std::vector<CandidateModel> models_;
  double best_;
};

/// Sets of up to kMostCauses columns grown from nothing by a beam, each weighed given one discrepancy
/// or none; what was weighed goes to the collector.
void search_by_beam(const RegressorSystem& system,
                    const NormalEquations& equations,
                    int discrepancy,
                    const SearchLimits& limits,
                    ModelCollector& collector);

/// The sets of causes that matter given a model discrepancy, in one marginalised system. Every kernel and
/// strength is looked at with nothing, with each cause alone and with the best sets that were found without a
/// discrepancy; those that hold a share of the weight are then searched on their own, since given a discrepancy
/// other causes may lead than without one.
///
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
