// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws as columns of a marginalised system, next to those of causes.
///
///   LawSystem system(analysis, number, sets);
///   const std::vector<ColumnSet> of_point = system.take({{&curve, 3.0}, {&curve, 4.0}});
///   const NormalEquations equations = system.equations(discrepancy);
///   const double w = system.log_weight(equations, {set, discrepancy}, of_point[0]);
#pragma once

#include <algorithm>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/discrepancy_basis.hpp"
#include "grid/diagnosis/law_curves.hpp"
#include "grid/eigen.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {

/// Causes that act, by their number among the sets, and a discrepancy or none.
struct LawContext {
  std::size_t set = 0;
  int discrepancy = -1;
  friend bool operator==(const LawContext&, const LawContext&) = default;
  friend auto operator<=>(const LawContext&, const LawContext&) = default;
};

/// A curve at one place, period or scale.
struct LawPoint {
  const LawCurve* curve = nullptr;
  double at = 0.0;
};

/// Amplitudes of a law in a context.
struct LawAmplitudes {
  VectorXd value;
  MatrixXd covariance;
};

class LawSystem {
 public:
  /// `number` of one of the comparison's marginalised systems; `sets` of the system's regressors. The
  /// analysis must outlive this.
  LawSystem(const Analysis& a, std::size_t number, const std::vector<RegressorSet>& sets)
      : from_(a.system),
        marginalised_(marginalise(a.system, a.comparison.marginalised_systems[number].outliers)),
        noise_(a.system.noise_dof, marginalised_.kept.size()) {
    std::set<int> used;
    for (const auto& set : sets) used.insert(set.begin(), set.end());
    const RegressorSet all(used.begin(), used.end());
    causes_ = reduced(marginalised_, a.system.g.dense(all));
    for (const auto& set : sets) {
      ColumnSet at;
      for (const int k : set)
        at.push_back(std::lower_bound(all.begin(), all.end(), k) - all.begin());
      sets_.push_back(std::move(at));
      log_prior_.push_back({log_prior(a.system, set, false), log_prior(a.system, set, true)});
    }
    for (const int k : all) cause_regressors_.push_back(from_.regressors[as_size(k)]);
    own_.units = from_.units;
    own_.places = from_.places;
    own_.discrepancies = from_.discrepancies;
    own_.unit_of_row = from_.unit_of_row;
    own_.e = from_.e;
    auto kernels = numbers_below(own_.discrepancies->kernels.size());
    basis_.emplace(own_, marginalised_, kernels);
    take_columns(MatrixXd(marginalised_.kept.size(), 0));
  }

  LawSystem(const LawSystem&) = delete;
  LawSystem& operator=(const LawSystem&) = delete;

  /// Replaces the columns of laws by those of these points; returns which are each one's.
  std::vector<ColumnSet> take(const std::vector<LawPoint>& points) {
    std::vector<ColumnSet> of_point;
    Index count = 0;
    for (const LawPoint& point : points) {
      ColumnSet& own = of_point.emplace_back();
      for (Index k = columns_of(point.curve->shape); k > 0; --k) own.push_back(count++);
    }
    MatrixXd laws(from_.e.size(), count);
    count = 0;
    for (std::size_t k = 0; k < points.size();) {
      const LawCurve& curve = *points[k].curve;
      std::vector<double> at;
      for (; k < points.size() && points[k].curve == &curve; ++k) at.push_back(points[k].at);
      const MatrixXd own = law_columns(from_, curve, at);
      laws.middleCols(count, own.cols()) = own;
      count += own.cols();
    }
    take_columns(reduced(marginalised_, laws));
    return of_point;
  }

  /// A larger law at its usual strength would be visible without a measurement: the settings absorb
  /// nearly all of it. By the columns taken last.
  bool shows(const ColumnSet& laws) const {
    constexpr double kLargestMm = 6.0;
    return all_of(laws, [&](Index k) {
      const Index at = causes_.cols() + k;
      return std::sqrt(plain_.gg(at, at)) * kLargestMm >= kUsualSignalToNoise;
    });
  }

  /// Prepares `equations` of this discrepancy for many sets of laws.
  void prepare(int discrepancy) { basis_->prepare(family().kernel_of(discrepancy)); }

  /// For the causes and the laws taken last.
  NormalEquations equations(int discrepancy) {
    if (discrepancy < 0) return plain_;
    const std::size_t kernel = family().kernel_of(discrepancy);
    auto found = given_.find(kernel);
    if (found == given_.end()) found = given_.emplace(kernel, basis_->given(kernel, plain_)).first;
    return found->second.equations(family().strength_of(discrepancy), plain_.columns);
  }

  /// Log prior and evidence of a context with some of the laws' columns; without the laws' prior.
  double log_weight(const NormalEquations& equations, const LawContext& context,
                    const ColumnSet& laws) const {
    const Priors& priors = log_prior_[context.set];
    const bool given = context.discrepancy >= 0;
    const double prior =
        given ? priors.given + family().log_share_of(context.discrepancy) : priors.alone;
    return prior + marginalised_.log_outliers +
           set_evidence(equations, own_.regressors, all_columns(context, laws), noise_)
               .log_evidence;
  }

  LawAmplitudes amplitudes(const NormalEquations& equations, const LawContext& context,
                           const ColumnSet& laws) const {
    const ColumnSet all = all_columns(context, laws);
    MatrixXd a = equations.gg(all, all);
    const VectorXd prior = equations.prior_square(all);
    a.diagonal() += prior / (kWideSignalToNoise * kWideSignalToNoise);
    const linear::Cholesky factor(std::move(a));
    const VectorXd c = equations.ge(all);
    const VectorXd b = factor.solve(c);
    const double square = noise_.noise_square(std::max(equations.ee - c.dot(b), 0.0));
    const auto m = std::ssize(laws);
    return {b.tail(m), square * factor.inverse().bottomRightCorner(m, m)};
  }

  const DiscrepancyFamily& family() const { return *own_.discrepancies; }
  std::size_t sets() const { return sets_.size(); }

 private:
  /// Replaces the columns of laws.
  void take_columns(const MatrixXd& laws) {
    MatrixXd g(laws.rows(), causes_.cols() + laws.cols());
    g << causes_, laws;
    Regressor law;
    law.lowest = kMinusInfinity;
    law.highest = kInfinity;
    own_.regressors = cause_regressors_;
    own_.regressors.resize(cause_regressors_.size() + as_size(laws.cols()), law);
    auto all = numbers_below<int>(own_.regressors.size());
    given_.clear();
    basis_->forget();
    plain_ = normal_equations(own_.regressors, marginalised_, std::move(all), g);
  }

  /// Columns in a context: of its causes and of some laws.
  ColumnSet all_columns(const LawContext& context, const ColumnSet& laws) const {
    ColumnSet all = sets_[context.set];
    for (const Index k : laws) all.push_back(causes_.cols() + k);
    return all;
  }

  struct Priors {
    double alone = 0.0;
    double given = 0.0;  ///< with a discrepancy
  };
  const RegressorSystem& from_;
  MarginalisedSystem marginalised_;
  NoiseDensity noise_;
  RegressorSystem own_;
  MatrixXd causes_;
  std::vector<Regressor> cause_regressors_;
  std::vector<ColumnSet> sets_;
  std::vector<Priors> log_prior_;
  std::optional<DiscrepancyBasis> basis_;
  NormalEquations plain_;  ///< the basis refers to them
  std::map<std::size_t, DiscrepancyBasis::GivenKernel> given_;
};

}  // namespace chaintrue::grid::diagnosis
