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

/// The data seen from one hypothesis: precision of the rows, and the precision times the residual.
struct Seen {
  Eigen::MatrixXd precision;
  Eigen::VectorXd u;
  double quadratic = 0.0;
  double log_det = 0.0;
};

struct Found {
  std::vector<bool> outliers;
  double log_weight = 0.0;
};

Seen seen_by(const Seen& nothing,
             const MarginalisedSystem& marginalised,
             const LinearisedSystem& system,
             const std::vector<int>& set) {
  Seen seen = nothing;
  Eigen::VectorXd e = marginalised.e;
  for (const int k : set) {
    if (system.regressors[static_cast<std::size_t>(k)].fixed) e -= marginalised.g.col(k);
  }
  const CovarianceRoot& root = marginalised.root;
  seen.u = root.solve(e);
  seen.quadratic = e.squaredNorm();
  std::vector<Eigen::VectorXd> taken;
  for (const int k : set) {
    if (system.regressors[static_cast<std::size_t>(k)].fixed) continue;
    const double prior =
        marginalised.g.col(k).squaredNorm() / (kWideSignalToNoise * kWideSignalToNoise);
    // P g for the precision so far
    Eigen::VectorXd pg = root.solve(marginalised.g.col(k));
    const Eigen::VectorXd g = root.times(marginalised.g.col(k));
    for (const Eigen::VectorXd& t : taken) pg -= t * t.dot(g);
    const double denominator = prior + g.dot(pg);
    const double ug = seen.u.dot(g);
    seen.quadratic -= ug * ug / denominator;
    seen.u -= pg * (ug / denominator);
    seen.log_det += std::log(denominator / prior);
    seen.precision.noalias() -= pg * (pg.transpose() / denominator);
    taken.push_back(pg / std::sqrt(denominator));
  }
  return seen;
}

/// What a hypothesis weighs beforehand.
struct Search {
  double log_prior = 0.0;
  double noise_dof = 0.0;
};

/// What the quadratic form loses with the unit whose rows begin at `at`.
template <int kRows>
double drop_without(const Seen& seen, Eigen::Index at) {
  using Shift = Eigen::Matrix<double, kRows, 1>;
  using Block = Eigen::Matrix<double, kRows, kRows>;
  const Shift u = seen.u.template segment<kRows>(at);
  const Block block = seen.precision.template block<kRows, kRows>(at, at);
  return u.dot(block.inverse() * u);
}

template <int kRows>
void set_aside(Seen& seen, Eigen::Index at, double drop) {
  using Shift = Eigen::Matrix<double, kRows, 1>;
  using Block = Eigen::Matrix<double, kRows, kRows>;
  const Block block = seen.precision.template block<kRows, kRows>(at, at);
  const Eigen::MatrixXd columns = seen.precision.template middleCols<kRows>(at) * block.inverse();
  const Shift u = seen.u.template segment<kRows>(at);
  seen.quadratic -= drop;
  seen.log_det += std::log(block.determinant());
  seen.u -= columns * u;
  seen.precision.noalias() -= columns * seen.precision.template middleRows<kRows>(at).eval();
}

/// The unit that the data would rather do without than any other: what it takes from the quadratic
/// form, against what setting a unit of so many rows aside costs.
struct Worst {
  std::size_t position = 0;
  double drop = -1.0;
};

Worst worst_of(const Seen& seen,
               const LinearisedSystem& system,
               const std::vector<std::pair<Eigen::Index, std::size_t>>& free) {
  Worst worst;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Index rows = system.units[free[k].second].rows;
    const double drop = rows == 2 ? drop_without<2>(seen, free[k].first)
                                  : drop_without<1>(seen, free[k].first);
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
             const LinearisedSystem& system,
             const MarginalisedSystem& marginalised,
             const Search& by) {
  auto free = units_in(system, marginalised.kept);
  const auto count = static_cast<double>(free.size());
  const auto most = static_cast<std::size_t>(std::max(3.0, std::ceil(kMostOutlierShare * count)));
  auto n = static_cast<Eigen::Index>(marginalised.kept.size());
  Found best{marginalised.outliers,
             NoiseDensity(by.noise_dof, n).log_density(seen.quadratic) - 0.5 * seen.log_det +
                 by.log_prior};
  std::vector<bool> outliers = marginalised.outliers;
  std::vector<bool> added(outliers.size(), false);
  for (std::size_t step = 1; step <= most && free.size() > system.fewest_units; ++step) {
    const Worst worst = worst_of(seen, system, free);
    const auto [at, unit] = free[worst.position];
    const Eigen::Index rows = system.units[unit].rows;
    rows == 2 ? set_aside<2>(seen, at, worst.drop) : set_aside<1>(seen, at, worst.drop);
    outliers[unit] = added[unit] = true;
    free.erase(free.begin() + static_cast<std::ptrdiff_t>(worst.position));
    n -= rows;
    const double weight = NoiseDensity(by.noise_dof, n).log_density(std::max(seen.quadratic, 0.0)) -
                          0.5 * seen.log_det + by.log_prior + log_price_of_outliers(system, added);
    if (weight > best.log_weight) best = {outliers, weight};
  }
  return best;
}

}  // namespace

std::vector<std::vector<bool>> outlier_sets(const LinearisedSystem& system,
                                            const std::vector<bool>& excluded,
                                            const std::vector<std::vector<int>>& hypotheses,
                                            const Steps& steps) {
  if (!steps.robust) return {excluded};
  const MarginalisedSystem marginalised = marginalise(system, excluded, steps);
  Seen nothing;
  nothing.precision = marginalised.root.precision();
  nothing.log_det = marginalised.log_det;
  std::vector<Found> found;
  for (const auto& set : hypotheses) {
    const Search by{log_prior(system.regressors, set, false), system.noise_dof};
    Found one = search(seen_by(nothing, marginalised, system, set), system, marginalised, by);
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
    if (sets.size() == kMostFoundSets || one.log_weight < found.front().log_weight - kNegligibleOutliers) break;
    sets.push_back(one.outliers);
  }
  return sets;
}

}  // namespace chaintrue::grid::diagnosis
