// SPDX-License-Identifier: GPL-3.0-or-later

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/model_comparison.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

// Finds sets of readings that some hypothesis would reject, by mean shifts: each group of rows'
// directions that one slip spoils has its own shift, the groups are added one after the
// other, and the nested set with the best evidence is used.
//
// Notation, in addition to evidence.hpp
//   P    precision of the kept rows, sizes of regressors and shifts so far unknown
//   u    P times the residual
//   D    directions of a group among its rows, orthonormal
//
//   drop = u' D (D' P D)^-1 D' u,   log |V| grows by log |D' P D|                             (1)
//
// Source: R. Cook and S. Weisberg, Residuals and Influence in Regression (1982), section 2.2.2,
// for the mean-shift model.

namespace chaintrue::grid::diagnosis {
namespace {

/// A shorter direction has been used already, and one of less precision is fitted completely: no
/// shift can show there.
constexpr double kNoDirection = 1e-9;

/// Of a group's rows or directions, which are two at most.
using Few = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 2, 2>;

struct FoundSet {
  Flags outliers;
  double log_weight = 0.0;
};

/// A group that may yet be rejected.
struct FreeGroup {
  std::size_t group = 0;
  Index at = 0;  ///< position of its first row among those kept
  Index rows = 1;
  /// A unit vector, orthogonal to the directions that other groups of the same rows have taken;
  /// absent: all rows.
  std::optional<Vector2d> direction;

  Index directions() const { return direction ? 1 : rows; }
  /// The directions D, rows x directions.
  Few basis() const { return direction ? Few(*direction) : Few(Few::Identity(rows, rows)); }
};

/// The data under one hypothesis: precision P of the rows, and P times the residual.
///
/// P is 1 - T T', with columns of T for the settings, for each free regressor and for each shift: with
/// hundreds of points nothing of rows x rows is ever made.
class MeanShifts {
 public:
  explicit MeanShifts(const MarginalisedSystem& marginalised)
      : root_(&marginalised.root),
        e_(marginalised.e),
        u_(root_->solve(e_)),
        quadratic_(e_.squaredNorm()),
        log_det_(marginalised.log_det),
        taken_(root_->explained().transpose()) {}

  /// Removes one regressor of known size. Call before any other.
  void subtract(const VectorXd& reduced_column) {
    e_ -= reduced_column;
    u_ = root_->solve(e_);
    quadratic_ = e_.squaredNorm();
  }

  /// Removes one regressor of free size, with the prior precision of its coefficient; 0: none.
  void free(const VectorXd& g, double prior) {
    VectorXd pg = g;
    linear::add_product(pg, -1.0, linear::transposed(taken_), linear::product(taken_, g));
    const double denominator = prior + g.dot(pg);
    const double ug = u_.dot(g);
    quadratic_ -= ug * ug / denominator;
    u_ -= pg * (ug / denominator);
    log_det_ += std::log(prior > 0.0 ? denominator / prior : denominator);
    taken_.conservativeResize(taken_.rows() + 1, Eigen::NoChange);
    taken_.bottomRows<1>() = pg.transpose() / std::sqrt(denominator);
  }

  /// (1): the drop of the quadratic form without the group; empty where nothing else determines its
  /// readings.
  std::optional<double> drop_without(const FreeGroup& group) const {
    const Few d = group.basis();
    const auto own = taken_.middleCols(group.at, group.rows);
    const Few rows = Few::Identity(group.rows, group.rows) - own.transpose().lazyProduct(own);
    const Few precision = d.transpose() * rows * d;
    const Few u = d.transpose() * u_.segment(group.at, group.rows);
    if (group.directions() == 2) return (u.transpose() * Matrix2d(precision).inverse() * u)(0, 0);
    if (group.direction && !(precision(0, 0) > kNoDirection)) return std::nullopt;
    return u(0, 0) * u(0, 0) / precision(0, 0);
  }

  /// A shift along each of its directions.
  void reject(const FreeGroup& group) {
    const Few directions = group.basis();
    for (const auto& direction : directions.colwise()) {
      VectorXd g = VectorXd::Zero(u_.size());
      g.segment(group.at, group.rows) = direction;
      free(g, 0.0);
    }
  }

  double quadratic() const { return std::max(quadratic_, 0.0); }
  double log_det() const { return log_det_; }

 private:
  const CovarianceRoot* root_;
  VectorXd e_;
  VectorXd u_;
  double quadratic_;
  double log_det_;
  MatrixXd taken_;  ///< T'
};

MeanShifts under(MeanShifts shifts, const MarginalisedSystem& marginalised,
                 const RegressorSystem& system, const RegressorSet& set) {
  for (const int k : set) {
    if (system.regressor(k).fixed) shifts.subtract(reduced(marginalised, system.g.col(k)));
  }
  for (const int k : set) {
    if (system.regressor(k).fixed) continue;
    const VectorXd g = marginalised.kept(system.g.col(k));
    const double square = marginalised.root.solve(g).squaredNorm();
    shifts.free(g, square / (kWideSignalToNoise * kWideSignalToNoise));
  }
  return shifts;
}

std::vector<FreeGroup> free_groups(const MarginalisedSystem& marginalised,
                                   const std::vector<OutlierGroup>& groups) {
  std::vector<FreeGroup> free;
  for (const auto k : each_index(groups)) {
    const OutlierGroup& group = groups[k];
    const Rows& kept = marginalised.kept.rows();
    const auto at = std::lower_bound(kept.begin(), kept.end(), group.first_row);
    // With one direction of a unit gone, only the other is left to test.
    const auto last = at + (group.rows - 1);
    if (kept.end() - at < group.rows || *at != group.first_row ||
        *last != group.first_row + group.rows - 1) {
      continue;
    }
    FreeGroup own{k, as_index(at - kept.begin()), group.rows, group.direction};
    if (own.direction) own.direction->normalize();
    free.push_back(std::move(own));
  }
  return free;
}

/// The position of the best group to reject: its reduction of the quadratic form against the cost of
/// rejecting its directions. Empty if nothing can be rejected.
std::optional<std::size_t> worst_of(const MeanShifts& shifts, const std::vector<FreeGroup>& free) {
  std::optional<std::size_t> worst;
  double most = kMinusInfinity;
  for (const auto k : each_index(free)) {
    const auto drop = shifts.drop_without(free[k]);
    if (!drop) continue;
    const double gain = *drop + 2.0 * log_price_of_outlier(free[k].directions());
    if (gain > most) {
      most = gain;
      worst = k;
    }
  }
  return worst;
}

/// Removes a rejected group, and its overlap with others' directions, from the free ones.
void take_out(const FreeGroup& rejected, std::vector<FreeGroup>& free, Flags& outliers) {
  std::vector<FreeGroup> left;
  for (FreeGroup& other : free) {
    if (other.at != rejected.at) {
      left.push_back(std::move(other));
      continue;
    }
    if (other.group != rejected.group && rejected.direction && other.direction) {
      Vector2d& d = *other.direction;
      d -= *rejected.direction * rejected.direction->dot(d);
      if (d.norm() > kNoDirection) {
        d.normalize();
        left.push_back(std::move(other));
        continue;
      }
    }
    outliers[other.group] = true;
  }
  free = std::move(left);
}

FoundSet search(MeanShifts shifts, const RegressorSystem& system,
                const MarginalisedSystem& marginalised, std::vector<FreeGroup> free, Flags outliers,
                double log_prior) {
  const auto count = as_double(free.size());
  const auto most = static_cast<std::size_t>(std::max(3.0, std::ceil(kMostOutlierShare * count)));
  Index n = marginalised.kept.size();
  const OutlierLimits& limits = system.limits;
  double price = 0.0;  // prior and density of what was rejected
  const auto weight = [&] {
    return NoiseDensity(system.noise_dof, n).log_density(shifts.quadratic()) -
           0.5 * shifts.log_det() + log_prior + price;
  };
  FoundSet best{outliers, weight()};
  std::size_t at_best = 0;
  for (std::size_t step = 1; step <= most && free.size() > limits.fewest_groups &&
                             n > limits.fewest_rows && step - at_best <= limits.beyond_the_best;
       ++step) {
    const auto worst = worst_of(shifts, free);
    if (!worst) break;
    const FreeGroup group = free[*worst];
    shifts.reject(group);
    take_out(group, free, outliers);
    price += log_price_of_outlier(group.directions());
    n -= group.directions();
    const double own = weight();
    if (own > best.log_weight) {
      best = {outliers, own};
      at_best = step;
    }
  }
  return best;
}

}  // namespace

std::vector<Flags> outlier_sets(const RegressorSystem& system, const Flags& excluded,
                                const std::vector<RegressorSet>& hypotheses) {
  const MarginalisedSystem marginalised = marginalise(system, excluded);
  const std::vector<FreeGroup> free = free_groups(marginalised, system.groups);
  Flags beforehand(system.groups.size(), true);
  for (const FreeGroup& group : free) beforehand[group.group] = false;
  const MeanShifts nothing(marginalised);
  std::vector<FoundSet> found;
  for (const auto& set : hypotheses) {
    FoundSet one = search(under(nothing, marginalised, system, set), system, marginalised, free,
                          beforehand, log_prior(system, set, false));
    auto* same = find_where(found, having(&FoundSet::outliers, one.outliers));
    if (same == nullptr) {
      found.push_back(std::move(one));
    } else {
      same->log_weight = std::max(same->log_weight, one.log_weight);
    }
  }
  stable_sort(found, descending(&FoundSet::log_weight));
  std::vector<Flags> sets;
  for (const FoundSet& one : found) {
    if (sets.size() == kMostFoundSets ||
        one.log_weight < found.front().log_weight - kNegligibleOutliers)
      break;
    sets.push_back(one.outliers);
  }
  return sets;
}

}  // namespace chaintrue::grid::diagnosis
