// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/outlier_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct Found {
  std::vector<bool> outliers;
  double log_weight = 0.0;
};

/// Units that may yet be set aside: the position of their first row among those kept, and their
/// number.
using FreeUnits = std::vector<std::pair<Eigen::Index, std::size_t>>;

/// The data seen from one hypothesis: precision P of the rows, and P times the residual.
///
/// P is that of no hypothesis less T T', a column of T for each regressor that is left free and each
/// row set aside. Of P only the units' own blocks are kept, and a unit's columns are made when it is
/// set aside: with hundreds of points nothing of rows x rows is ever made.
class Seen {
  [[nodiscard]] auto taken() const { return taken_.leftCols(count_); }

 public:
  Seen(const MarginalisedSystem& marginalised, const RegressorSystem& system)
      : root_(&marginalised.root),
        e_(marginalised.e),
        u_(root_->solve(e_)),
        quadratic_(e_.squaredNorm()),
        log_det_(marginalised.log_det),
        own_(Eigen::MatrixXd::Zero(2, e_.size())),
        taken_(e_.size(), 0) {
    for (const auto& [at, number] : units_in(system, marginalised.kept)) {
      const Eigen::Index rows = system.units[number].rows;
      own_.block(0, at, rows, rows) = root_->precision_block(at, rows, at, rows);
      units_.emplace_back(at, rows);
    }
  }

  /// One regressor whose size is known. Before any other.
  void subtract(const Eigen::VectorXd& g) {
    e_ -= g;
    u_ = root_->solve(e_);
    quadratic_ = e_.squaredNorm();
  }

  /// One regressor whose size is free, with the precision that its coefficient has beforehand.
  void free(const Eigen::VectorXd& reduced_column, double prior) {
    const Eigen::VectorXd g = root_->times(reduced_column);
    Eigen::VectorXd pg = root_->solve(reduced_column);
    pg -= taken() * (taken().transpose() * g);
    const double denominator = prior + g.dot(pg);
    const double ug = u_.dot(g);
    quadratic_ -= ug * ug / denominator;
    u_ -= pg * (ug / denominator);
    log_det_ += std::log(denominator / prior);
    take(pg / std::sqrt(denominator));
  }

  /// What the quadratic form loses with the unit whose rows begin at `at`.
  template <int kRows>
  [[nodiscard]] double drop_without(Eigen::Index at) const {
    const Eigen::Matrix<double, kRows, kRows> block = own_.template block<kRows, kRows>(0, at);
    const Eigen::Matrix<double, kRows, 1> u = u_.template segment<kRows>(at);
    return u.dot(block.inverse() * u);
  }

  void set_aside(Eigen::Index at, Eigen::Index rows, double drop) {
    const Eigen::LLT<Eigen::MatrixXd> block(own_.block(0, at, rows, rows));
    Eigen::MatrixXd columns = root_->precision_block(0, u_.size(), at, rows);
    columns.noalias() -= taken() * taken().middleRows(at, rows).transpose();
    quadratic_ -= drop;
    u_ -= columns * block.solve(u_.segment(at, rows).eval());
    block.matrixU().solveInPlace<Eigen::OnTheRight>(columns);
    log_det_ += 2.0 * Eigen::MatrixXd(block.matrixL()).diagonal().array().log().sum();
    for (Eigen::Index k = 0; k < rows; ++k) take(columns.col(k));
  }

  [[nodiscard]] double quadratic() const { return std::max(quadratic_, 0.0); }
  [[nodiscard]] double log_det() const { return log_det_; }

 private:
  void take(const Eigen::VectorXd& column) {
    if (count_ == taken_.cols()) {
      taken_.conservativeResize(u_.size(), std::max<Eigen::Index>(16, 2 * count_));
    }
    taken_.col(count_++) = column;
    for (const auto& [at, rows] : units_) {
      const auto part = column.segment(at, rows);
      own_.block(0, at, rows, rows).noalias() -= part * part.transpose();
    }
  }

  const CovarianceRoot* root_;
  Eigen::VectorXd e_;
  Eigen::VectorXd u_;
  double quadratic_;
  double log_det_;
  Eigen::MatrixXd own_;  ///< 2 x rows: P's block of each unit, in the columns of its rows
  std::vector<std::pair<Eigen::Index, Eigen::Index>> units_;  ///< first row and rows of each
  Eigen::MatrixXd taken_;                                     ///< T, with room for more
  Eigen::Index count_ = 0;
};

Seen seen_by(Seen seen,
             const MarginalisedSystem& marginalised,
             const RegressorSystem& system,
             const std::vector<int>& set) {
  for (const int k : set) {
    if (system.regressors[static_cast<std::size_t>(k)].fixed) seen.subtract(marginalised.g.col(k));
  }
  for (const int k : set) {
    if (system.regressors[static_cast<std::size_t>(k)].fixed) continue;
    const Eigen::VectorXd g = marginalised.g.col(k);
    seen.free(g, g.squaredNorm() / (kWideSignalToNoise * kWideSignalToNoise));
  }
  return seen;
}

/// The unit that the data would rather do without than any other: what it takes from the quadratic
/// form, against what setting a unit of so many rows aside costs.
struct Worst {
  std::size_t position = 0;
  double drop = -1.0;
};

Worst worst_of(const Seen& seen, const RegressorSystem& system, const FreeUnits& free) {
  Worst worst;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Index rows = system.units[free[k].second].rows;
    const double drop =
        rows == 2 ? seen.drop_without<2>(free[k].first) : seen.drop_without<1>(free[k].first);
    const double gain = drop + 2.0 * log_price_of_outlier(rows);
    if (gain > most) {
      most = gain;
      worst = {k, drop};
    }
  }
  return worst;
}

/// Mean shifts one after the other; the best of the nested sets.
Found search(Seen seen,
             const RegressorSystem& system,
             const MarginalisedSystem& marginalised,
             double log_prior) {
  FreeUnits free = units_in(system, marginalised.kept);
  const auto count = static_cast<double>(free.size());
  const auto most = static_cast<std::size_t>(std::max(3.0, std::ceil(kMostOutlierShare * count)));
  auto n = static_cast<Eigen::Index>(marginalised.kept.size());
  std::vector<bool> outliers = marginalised.outliers;
  std::vector<bool> added(outliers.size(), false);
  const auto weight = [&] {
    return NoiseDensity(system.noise_dof, n).log_density(seen.quadratic()) - 0.5 * seen.log_det() +
           log_prior + log_price_of_outliers(system, added);
  };
  Found best{outliers, weight()};
  for (std::size_t step = 1; step <= most && free.size() > system.fewest_units; ++step) {
    const Worst worst = worst_of(seen, system, free);
    const auto [at, unit] = free[worst.position];
    seen.set_aside(at, system.units[unit].rows, worst.drop);
    outliers[unit] = added[unit] = true;
    free.erase(free.begin() + static_cast<std::ptrdiff_t>(worst.position));
    n -= system.units[unit].rows;
    const double own = weight();
    if (own > best.log_weight) best = {outliers, own};
  }
  return best;
}

}  // namespace

std::vector<std::vector<bool>> outlier_sets(const RegressorSystem& system,
                                            const std::vector<bool>& excluded,
                                            const std::vector<std::vector<int>>& hypotheses,
                                            const Steps& steps) {
  if (!steps.robust) return {excluded};
  const MarginalisedSystem marginalised = marginalise(system, excluded, steps);
  const Seen nothing(marginalised, system);
  std::vector<Found> found;
  for (const auto& set : hypotheses) {
    Found one = search(seen_by(nothing, marginalised, system, set),
                       system,
                       marginalised,
                       log_prior(system.regressors, set, false));
    const auto same = std::find_if(
        found.begin(), found.end(), [&](const Found& f) { return f.outliers == one.outliers; });
    if (same == found.end()) {
      found.push_back(std::move(one));
    } else {
      same->log_weight = std::max(same->log_weight, one.log_weight);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.log_weight > b.log_weight;
  });
  std::vector<std::vector<bool>> sets;
  for (const Found& one : found) {
    if (sets.size() == kMostFoundSets ||
        one.log_weight < found.front().log_weight - kNegligibleOutliers)
      break;
    sets.push_back(one.outliers);
  }
  return sets;
}

}  // namespace chaintrue::grid::diagnosis
