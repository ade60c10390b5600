// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Downdated evidence: the models of a comparison without some of the points, at a fraction
/// of the cost of a new comparison.
///
/// A marginalised system with one discrepancy or none is factorised once, and its inner products without the
/// points follow from that (covariance_root.hpp).
///
/// Exact for each followed model; models that the comparison dropped, sets of outliers that it
/// never tried, and discrepancies below a least probability are ignored.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "grid/diagnosis/covariance_root.hpp"
#include "grid/diagnosis/model_comparison.hpp"
#include "grid/diagnosis/null_distribution.hpp"

namespace chaintrue::grid::diagnosis {

/// Limits on the models that are followed.
struct FollowedModels {
  double within = 14.0;                ///< logarithm of the weight below the best
  std::size_t most = 160;              ///< in all
  double discrepancy_share = 0.01;     ///< of the probability, from which a discrepancy is followed
  std::size_t most_discrepancies = 4;  ///< the likeliest
};

/// The number of readings that the remaining ones represent.
enum class CountAs {
  themselves,
  /// Each evidence raised to the power of all rows over the remaining ones, as if the sample were
  /// as large as the whole.
  all,
};

class Downdating {
 public:
  /// System and comparison are kept by reference.
  Downdating(const RegressorSystem& system, const ModelComparison& comparison,
             const FollowedModels& followed = {});

  struct Without {
    /// Best first; its marginalised systems contain the rejected points, including those left out,
    /// and no rows.
    ModelComparison comparison;
    /// Score of the strongest effect (null_distribution.hpp) without the readings that the best
    /// model rejects.
    double score = 0.0;
  };
  /// Units are positions in the session.
  [[nodiscard]] Without without(const Indices& units) const;

  /// For each model of the comparison, given that a followed one holds; 0 for the others. Models that
  /// differ only in which of the left-out points they reject divide their probability by their weights
  /// with all points.
  VectorXd probabilities_without(const Indices& units, CountAs count_as) const;

 private:
  /// A marginalised system, and a discrepancy or -1.
  using Key = std::pair<std::size_t, int>;
  struct Factorisation {
    Key key;
    LeaveOut rows;                  ///< residual and columns of the models
    NormalEquations equations;      ///< with all points
    Indices models;                 ///< of the comparison
    std::vector<ColumnSet> sets{};  ///< of each: its columns in the equations
    std::vector<double> prior{};    ///< of each: weight less evidence
  };
  /// A followed model without some units.
  struct ModelWithout {
    std::size_t number = 0;  ///< in the comparison
    /// The first that is the same: models may differ only in which of these units they reject.
    std::size_t same = 0;
    CandidateModel model;  ///< where it is the first, with its weight without them
  };
  struct AllWithout {
    std::vector<MarginalisedSystem> systems;  ///< as Without's
    std::vector<ModelWithout> models;
    std::vector<std::pair<double, std::size_t>> strongest;  ///< score, by system
  };
  AllWithout all_without(const Indices& units, CountAs count_as) const;
  /// The models that may lead without some points: the best ones and, in each of their marginalised
  /// systems, no cause and every cause alone at its best place.
  std::map<Key, Indices> models_to_follow(const FollowedModels& limits) const;
  Factorisation factorisation_of(const Key& key, const Indices& models) const;
  /// Inner products with these rows of the marginalised system gone.
  NormalEquations downdated_equations(const Factorisation& factorised, const Rows& out) const;

  const RegressorSystem& system_;
  const ModelComparison& comparison_;
  SingleScore score_;
  std::vector<Factorisation> factorisations_;
};

}  // namespace chaintrue::grid::diagnosis
