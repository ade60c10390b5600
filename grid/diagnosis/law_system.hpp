// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws as columns of a marginalised system, next to those of causes.
///
///   LawSystem system(analysis, number, sets);
///   const std::vector<ColumnSet> of_point = system.take({{&curve, 3.0}, {&curve, 4.0}});
///   const MatrixXd log_weights = system.log_weights(contexts, of_point);   // contexts x points
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "grid/diagnosis/discrepancy_basis.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// A discrepancy or none, and causes that act, by their number among the sets.
struct LawContext {
  int discrepancy = -1;
  std::size_t set = 0;
  friend auto operator<=>(const LawContext&, const LawContext&) = default;
};

class LawSystem {
 public:
  /// `number` of one of the comparison's marginalised systems; `sets` of the system's regressors.
  LawSystem(const Analysis& a, std::size_t number, const std::vector<RegressorSet>& sets)
      : own_{a.system, {}, {}},
        marginalised_(marginalise(a.system, a.comparison.marginalised_systems[number].outliers)),
        noise_(a.system.noise_dof, marginalised_.kept.size()),
        basis_(own_, marginalised_, numbers_below(family().kernels.size())) {
    RegressorSet all;
    for (const RegressorSet& set : sets) {
      RegressorSet& own = sets_.emplace_back();
      for (const int k : set) {
        own.push_back(as_int(all.size()));
        all.push_back(k);
        own_.regressors.push_back(a.system.regressor(k));
      }
    }
    causes_ = reduced(marginalised_, a.system.g.dense(all));
    take_columns(MatrixXd(causes_.rows(), 0));
  }

  LawSystem(const LawSystem&) = delete;
  LawSystem& operator=(const LawSystem&) = delete;

  /// Replaces the columns of laws by those of these points; returns which are each one's.
  std::vector<ColumnSet> take(const std::vector<LawPoint>& points) {
    std::vector<ColumnSet> of_point;
    MatrixXd laws(own_.e.size(), 0);
    for (auto point = points.begin(); point != points.end();) {
      const auto& curve = point->curve;
      Index count = laws.cols();
      std::vector<double> at;
      for (; point != points.end() && point->curve == curve; ++point) {
        at.push_back(point->at);
        ColumnSet& own = of_point.emplace_back();
        for (Index k = columns_of(curve->shape); k > 0; --k) own.push_back(count++);
      }
      laws.conservativeResize(Eigen::NoChange, count);
      const MatrixXd own = law_columns(own_, *curve, at);
      laws.rightCols(own.cols()) = own;
    }
    take_columns(reduced(marginalised_, laws));
    return of_point;
  }

  /// Prepares the equations of this discrepancy for many sets of laws.
  void prepare(int discrepancy) { basis_.prepare(family().kernel_of(discrepancy)); }

  /// Each set without a discrepancy, then with each of them.
  std::vector<LawContext> contexts() const {
    std::vector<LawContext> all;
    for (int discrepancy = -1; discrepancy < family().count(); ++discrepancy) {
      for (const auto set : each_index(sets_)) all.push_back({discrepancy, set});
    }
    return all;
  }

  /// Log prior and evidence of each context with each of these laws, contexts x laws; without the laws'
  /// priors, minus infinity for a law that the readings cannot show. Fastest in the order of contexts().
  MatrixXd log_weights(const std::vector<LawContext>& contexts,
                       const std::vector<ColumnSet>& laws) {
    MatrixXd result = MatrixXd::Constant(std::ssize(contexts), std::ssize(laws), kMinusInfinity);
    for (const Index row : each_below(result.rows())) {
      const LawContext& context = contexts[as_size(row)];
      const NormalEquations& equations = equations_of(context.discrepancy);
      const bool given = context.discrepancy >= 0;
      const double prior = log_prior(own_, sets_[context.set], given) +
                           (given ? family().log_share_of(context.discrepancy) : 0.0) +
                           marginalised_.log_outliers;
      for (const Index k : each_below(result.cols())) {
        const ColumnSet& law = laws[as_size(k)];
        if (!shows(law)) continue;
        result(row, k) =
            prior + set_evidence(equations, own_.regressors, all_columns(context, law), noise_)
                        .log_evidence;
      }
    }
    return result;
  }

  /// Sets the amplitudes of a law with these columns.
  void fit(const LawContext& context, const ColumnSet& columns, WeighedLaw& law) {
    const NormalEquations& equations = equations_of(context.discrepancy);
    const ColumnSet all = all_columns(context, columns);
    MatrixXd a = equations.gg(all, all);
    const VectorXd prior = equations.prior_square(all);
    a.diagonal() += prior / (kWideSignalToNoise * kWideSignalToNoise);
    const linear::Cholesky factor(std::move(a));
    const VectorXd c = equations.ge(all);
    const VectorXd b = factor.solve(c);
    const double square = noise_.noise_square(std::max(equations.ee - c.dot(b), 0.0));
    const auto m = std::ssize(columns);
    law.amplitude = b.tail(m);
    law.covariance = square * factor.inverse().bottomRightCorner(m, m);
  }

  const DiscrepancyFamily& family() const { return *own_.discrepancies; }

 private:
  /// A larger law at its usual strength would be visible without a measurement: the settings absorb
  /// nearly all of it.
  bool shows(const ColumnSet& law) const {
    constexpr double kLargestMm = 6.0;
    return all_of(law, [&](Index k) {
      const Index at = causes_.cols() + k;
      return std::sqrt(plain_.gg(at, at)) * kLargestMm >= kUsualSignalToNoise;
    });
  }

  /// For the causes and the laws taken last.
  const NormalEquations& equations_of(int discrepancy) {
    if (discrepancy < 0) return plain_;
    if (discrepancy != discrepancy_) {
      const std::size_t kernel = family().kernel_of(discrepancy);
      auto found = given_.find(kernel);
      if (found == given_.end()) found = given_.emplace(kernel, basis_.given(kernel, plain_)).first;
      with_discrepancy_ =
          found->second.equations(family().strength_of(discrepancy), plain_.columns);
      discrepancy_ = discrepancy;
    }
    return with_discrepancy_;
  }

  /// Replaces the columns of laws.
  void take_columns(const MatrixXd& laws) {
    MatrixXd g(laws.rows(), causes_.cols() + laws.cols());
    g << causes_, laws;
    Regressor law;
    law.lowest = kMinusInfinity;
    law.highest = kInfinity;
    own_.regressors.resize(as_size(g.cols()), law);
    given_.clear();
    discrepancy_ = -1;
    basis_.forget();
    plain_ = normal_equations(own_.regressors, marginalised_,
                              numbers_below<int>(own_.regressors.size()), g);
  }

  /// Columns in a context: of its causes and of some laws.
  ColumnSet all_columns(const LawContext& context, const ColumnSet& law) const {
    ColumnSet all(sets_[context.set].begin(), sets_[context.set].end());
    for (const Index k : law) all.push_back(causes_.cols() + k);
    return all;
  }

  RegressorSystem own_;  ///< with the regressors of the sets, one after the other, then the laws
  MarginalisedSystem marginalised_;
  NoiseDensity noise_;
  MatrixXd causes_;
  std::vector<RegressorSet> sets_;  ///< numbers in own_
  DiscrepancyBasis basis_;
  NormalEquations plain_;  ///< the basis refers to them
  std::map<std::size_t, DiscrepancyBasis::GivenKernel> given_;
  int discrepancy_ = -1;  ///< whose equations are kept
  NormalEquations with_discrepancy_;
};

}  // namespace chaintrue::grid::diagnosis
