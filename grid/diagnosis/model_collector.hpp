// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The weights of sets of causes in one marginalised system, and the search for the relevant ones.
#pragma once

#include <set>
#include <vector>

#include "grid/diagnosis/model_comparison.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

struct WeighedSet {
  double weight = 0.0;
  ColumnSet set;
};
/// Whether two regressors may act together: a cause acts at one place, an effect on both chains
/// excludes the same on one of them, and one effect may set in at one visit of one chain.
bool compatible(const Regressor& a, const Regressor& b, const SearchLimits& limits);
/// The reduction of e'e by one column, given its square and its inner product with e.
double score_alone(const Regressor& regressor, double c, double square);
class ModelCollector {
 public:
  /// Searches the last marginalised system of `comparison` and appends the models to it. The references must
  /// outlive this.
  ModelCollector(const RegressorSystem& system, ModelComparison& comparison,
                 const SearchLimits& limits);

  const RegressorSystem& system() const { return system_; }
  MarginalisedSystem& marginalised() const { return comparison_.marginalised_systems[number_]; }
  const SearchLimits& limits() const { return limits_; }

  /// Returns a set's weight and keeps the set if relevant; minus infinity if it is impossible.
  double consider(const ColumnSet& set, int discrepancy, const NormalEquations& equations);
  /// Whether a set of so many causes with this weight is relevant.
  bool keeps(std::size_t size, int discrepancy, double weight) const;
  /// Log prior of a set with a discrepancy or none, including the discrepancy's share and the rejected points.
  double log_prior_of(const RegressorSet& regressors, int discrepancy) const;

  double best() const { return best_; }
  const NoiseDensity& noise() const { return noise_; }

 private:
  const RegressorSystem& system_;
  ModelComparison& comparison_;
  std::size_t number_;
  const SearchLimits& limits_;
  NoiseDensity noise_;
  double best_;
};

/// How the best sets of a size are extended.
struct GrowthLimits {
  std::size_t parents = 0;  ///< of each size
  bool impossible = false;  ///< whether sets without weight are among them
};

/// Sets of causes weighed given one discrepancy or none, each once, and grown from the best of each size.
class GrowingSets {
 public:
  /// All references must outlive this; all sets go to the collector.
  GrowingSets(const NormalEquations& equations, int discrepancy, ModelCollector& collector)
      : equations_(equations), discrepancy_(discrepancy), collector_(collector) {}

  void weigh(const ColumnSet& set);
  const std::vector<WeighedSet>& of_size(std::size_t size) const { return weighed_[size]; }
  const Regressor& regressor(Index column) const {
    return collector_.system().regressor(equations_.columns[as_size(column)]);
  }
  /// Whether the columns may act together.
  bool fits(const ColumnSet& set, Index column) const;
  /// Weighs the best sets of `size` and more columns with one more, as `extensions` has for each.
  void grow(std::size_t size, const GrowthLimits& limits,
            const std::function<ColumnSet(const ColumnSet&)>& extensions);

 private:
  const NormalEquations& equations_;
  int discrepancy_;
  ModelCollector& collector_;
  std::set<ColumnSet> known_;
  std::array<std::vector<WeighedSet>, kMostCauses + 1> weighed_;
};

/// Sets of up to kMostCauses columns grown from nothing by a beam search, given one discrepancy or
/// none; all go to the collector.
void search_by_beam(const NormalEquations& equations, int discrepancy, ModelCollector& collector);

/// The sets of causes that matter given a model discrepancy, in one marginalised system. Every kernel and
/// strength is looked at with nothing, with each cause alone and with the best sets that were found without a
/// discrepancy; those that hold a share of the weight are then searched on their own, since given a discrepancy
/// other causes may lead than without one.
///
/// `plain`: normal equations of all regressors worth their place, without a discrepancy; `leading`:
/// the best sets of two and more of these, best first; `kernels`: those to try. Models go to the
/// collector. Notes the traces in the marginalised system. Returns of each of `kernels` the largest
/// weight that it was found to have.
std::vector<double> search_given_discrepancies(const NormalEquations& plain,
                                               const std::vector<RegressorSet>& best_models,
                                               const Indices& kernels, ModelCollector& collector);

/// Searches the relevant sets of causes in one marginalised system: all sets of one and two
/// causes, sets of three and four grown from the best, and the leading ones again given a model
/// discrepancy.
class SetSearch {
 public:
  /// The references must outlive this.
  SetSearch(const RegressorSystem& system, ModelComparison& comparison, const SearchLimits& limits)
      : collector_(system, comparison, limits), sets_(equations_, -1, collector_) {}

  SetSearch(const SetSearch&) = delete;

  void run();
  /// Call after run(). Returns the largest weight that each of these kernels was found to have.
  std::vector<double> run_given_discrepancies(const Indices& kernels);
  /// Largest weight so far.
  double best() const { return collector_.best(); }
  const Flags& outliers() const { return collector_.marginalised().outliers; }

 private:
  /// Regressors to keep: all without whole numbers, except that effects at a visit keep their best
  /// visits; of the others the best, alone or after projection on a leading regressor.
  RegressorSet columns() const;
  /// Upper bound of a pair's weight, ignoring bounds and larger noise.
  double quick_weight(Index i, Index j) const;
  void pairs();
  /// The columns that explain most of what a set leaves.
  ColumnSet extensions(const ColumnSet& parent) const;

  ModelCollector collector_;
  NormalEquations equations_;
  GrowingSets sets_;
};

}  // namespace chaintrue::grid::diagnosis
