// SPDX-License-Identifier: GPL-3.0-or-later
// The search for outliers, which updates one decomposition step by step, compared with a search
// that forms the whole covariance and leaves the rows out of it.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/diagnosis/model_comparison.hpp"
#include "grid/random.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kUnits = 24;

/// Outlier groups of one row and of two in turn, three settings, one cause, some groups far off.
RegressorSystem random_system(Random& random) {
  RegressorSystem system;
  Eigen::Index row = 0;
  for (std::size_t u = 0; u < kUnits; ++u) {
    const Eigen::Index rows = u % 3 == 0 ? 1 : 2;
    system.units.push_back({.first_row = row, .rows = rows});
    system.groups.push_back({row, rows});
    system.unit_of_row.insert(system.unit_of_row.end(), static_cast<std::size_t>(rows),
                              static_cast<int>(u));
    row += rows;
  }
  system.e.resize(row);
  system.by_setting.resize(row, 3);
  Eigen::VectorXd g(row);
  for (Eigen::Index i = 0; i < row; ++i) {
    system.e(i) = random.normal();
    g(i) = random.normal();
    for (Eigen::Index k = 0; k < 3; ++k) system.by_setting(i, k) = random.normal();
  }
  for (const std::size_t bad : {4U, 9U, 15U}) {
    system.e(system.units[bad].first_row) += 25.0 * random.normal();
  }
  system.g = RegressorColumns(row);
  system.g.add(g);
  system.setting = Eigen::VectorXd::Zero(3);
  system.expected_change = Eigen::VectorXd::Constant(3, 0.2);
  system.sigma = Eigen::VectorXd::Constant(3, 1.5);
  system.limits.fewest_groups = 8;
  Regressor regressor;
  regressor.cause = {model::effects::find_effect("chain_stretch"),
                     model::effects::EffectSide::none};
  regressor.values = {1.0};
  regressor.lowest = -100.0;
  regressor.highest = 100.0;
  system.regressors = {regressor};
  return system;
}

/// Pairs of rows with four directions each, like four belts at a position.
RegressorSystem random_places(Random& random) {
  constexpr std::size_t kPlaces = 12;
  RegressorSystem system = random_system(random);
  const Eigen::Index rows = 2 * kPlaces;
  system.units.clear();
  system.groups.clear();
  system.unit_of_row.clear();
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const auto first = static_cast<Eigen::Index>(2 * k);
    system.units.push_back({.first_row = first, .rows = 2});
    system.unit_of_row.insert(system.unit_of_row.end(), 2, static_cast<int>(k));
    for (int d = 0; d < 4; ++d)
      system.groups.push_back({first, 2, Eigen::Vector2d(random.normal(), random.normal())});
  }
  const Eigen::VectorXd g = system.g.col(0).head(rows);
  system.g = RegressorColumns(rows);
  system.g.add(g);
  system.e.conservativeResize(rows);
  system.by_setting.conservativeResize(rows, Eigen::NoChange);
  system.limits = {};
  return system;
}

struct Weighed {
  double quadratic = 0.0;
  double log_det = 0.0;
  Eigen::Index rows = 0;
};

/// One group after the other, each time the one whose removal improves the fit most.
class FullSearch {
 public:
  FullSearch(const RegressorSystem& system, const std::vector<int>& set)
      : system_(system), groups_(system.groups) {
    const Eigen::MatrixXd scaled = system.by_setting * system.sigma.asDiagonal();
    covariance_ = scaled * scaled.transpose();
    covariance_.diagonal().array() += 1.0;
    const MarginalisedSystem whole = marginalise(system, none());
    for (const int k : set) {
      const Eigen::VectorXd g = system.g.col(k);
      covariance_ += g * g.transpose() * std::pow(kWideSignalToNoise / reduced(whole, g).norm(), 2);
    }
    residual_ = system.e - system.by_setting * system.expected_change;
  }

  /// Without the rows or directions of the outliers.
  Weighed weighed(const std::vector<bool>& outliers) const {
    Eigen::MatrixXd gone = Eigen::MatrixXd::Zero(residual_.size(), residual_.size());
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      if (!outliers[k]) continue;
      const OutlierGroup& own = groups_[k];
      auto block = gone.block(own.first_row, own.first_row, own.rows, own.rows);
      if (own.direction)
        block += own.direction->normalized() * own.direction->normalized().transpose();
      else
        block.setIdentity();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gone);
    // Zero to rounding in the remaining directions, which come first.
    const Eigen::Index rows = (eigen.eigenvalues().array() < 1e-9).count();
    const Eigen::MatrixXd basis = eigen.eigenvectors().leftCols(rows);
    const Eigen::LLT<Eigen::MatrixXd> llt(basis.transpose() * covariance_ * basis);
    return {llt.matrixL().solve(basis.transpose() * residual_).squaredNorm(),
            2.0 * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum(), rows};
  }

  /// The best of the nested sets.
  std::vector<bool> best() const {
    std::vector<bool> outliers = none();
    std::vector<bool> best = outliers;
    double most = weight(outliers);
    const auto count = static_cast<double>(groups_.size());
    const int steps = static_cast<int>(std::max(3.0, std::ceil(kMostOutlierShare * count)));
    for (int step = 0; step < steps; ++step) {
      const Weighed before = weighed(outliers);
      std::size_t worst = 0;
      double gain = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < groups_.size(); ++k) {
        if (outliers[k]) continue;
        std::vector<bool> without = outliers;
        without[k] = true;
        const Weighed left = weighed(without);
        const double own =
            before.quadratic - left.quadratic + 2.0 * log_price_of_outlier(before.rows - left.rows);
        // Several readings of a position with one outlier are the same direction, to rounding.
        if (own > gain + 1e-9 * (1.0 + left.quadratic)) {
          gain = own;
          worst = k;
        }
      }
      reject(worst, outliers);
      if (const double own = weight(outliers); own > most) {
        most = own;
        best = outliers;
      }
    }
    return best;
  }

 private:
  std::vector<bool> none() const { return std::vector<bool>(groups_.size(), false); }

  /// Two directions of a position are all of it.
  void reject(std::size_t group, std::vector<bool>& outliers) const {
    const auto is_there = [&](std::size_t k) {
      return groups_[k].first_row == groups_[group].first_row;
    };
    bool is_second = false;
    for (std::size_t k = 0; k < groups_.size(); ++k)
      is_second = is_second || (outliers[k] && is_there(k));
    outliers[group] = true;
    for (std::size_t k = 0; k < groups_.size(); ++k)
      outliers[k] = outliers[k] || (is_second && is_there(k));
  }

  double weight(const std::vector<bool>& outliers) const {
    const Weighed w = weighed(outliers);
    return NoiseDensity(system_.noise_dof, w.rows).log_density(w.quadratic) - 0.5 * w.log_det +
           log_price_of_outliers(system_, outliers);
  }

  const RegressorSystem& system_;
  std::vector<OutlierGroup> groups_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd residual_;
};

// The set, and the rows that the comparison is left with.
void expect_full_search(const RegressorSystem& system, const std::vector<int>& set) {
  SCOPED_TRACE(testing::Message() << set.size() << " regressors");
  const FullSearch search(system, set);
  const std::vector<bool> best = search.best();
  EXPECT_EQ(outlier_sets(system, nothing_rejected(system), {set}).front(), best);
  if (!set.empty()) return;
  const Weighed w = search.weighed(best);
  const MarginalisedSystem left = marginalise(system, best);
  // To rounding.
  EXPECT_EQ(left.kept.size(), w.rows);
  EXPECT_NEAR(left.e.squaredNorm(), w.quadratic, 1e-9 * (1.0 + w.quadratic));
  EXPECT_NEAR(left.log_det, w.log_det, 1e-9 * (1.0 + std::abs(w.log_det)));
  if (system.groups.front().direction) {
    EXPECT_NEAR(left.log_outliers,
                static_cast<double>(system.e.size() - w.rows) * log_price_of_outlier(1), 1e-9);
  }
}

TEST(OutlierSearch, EqualsThatOfTheFullCovariance) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const RegressorSystem system = random_system(random);
    for (const std::vector<int>& set : {std::vector<int>{}, std::vector<int>{0}})
      expect_full_search(system, set);
  }
}

TEST(OutlierSearch, DirectionsEqualThoseOfTheFullCovariance) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    expect_full_search(random_places(random), {});
  }
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
