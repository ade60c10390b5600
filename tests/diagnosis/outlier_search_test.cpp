// SPDX-License-Identifier: GPL-3.0-or-later
// The search for outliers, which updates one decomposition step by step, compared with a search
// that forms the whole covariance and leaves the rows out of it.
#include "grid/diagnosis/outlier_search.hpp"

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
    system.unit_of_row.insert(
        system.unit_of_row.end(), static_cast<std::size_t>(rows), static_cast<int>(u));
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
  system.g = RegressorColumns(g);
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

struct Weighed {
  double quadratic = 0.0;
  double log_det = 0.0;
  Eigen::Index rows = 0;
};

Weighed weighed(const RegressorSystem& system,
                const Eigen::MatrixXd& covariance,
                const Eigen::VectorXd& residual,
                const std::vector<bool>& outliers) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (!outliers[static_cast<std::size_t>(system.unit_of_row[static_cast<std::size_t>(i)])])
      kept.push_back(i);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance(kept, kept));
  const Eigen::VectorXd white = llt.matrixL().solve(residual(kept));
  return {white.squaredNorm(),
          2.0 * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum(),
          static_cast<Eigen::Index>(kept.size())};
}

/// One group after the other, each time the one whose removal improves the fit most; the best of
/// the nested sets.
std::vector<bool> one_by_one(const RegressorSystem& system, const std::vector<int>& set) {
  const std::vector<bool> none(kUnits, false);
  const MarginalisedSystem whole = marginalise(system, none);
  const Eigen::MatrixXd scaled = system.by_setting * system.sigma.asDiagonal();
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(system.e.size(), system.e.size()) + scaled * scaled.transpose();
  for (const int k : set) {
    const Eigen::VectorXd g = system.g.col(k);
    const double length = whole.g.col(k).norm();
    covariance += g * g.transpose() * std::pow(kWideSignalToNoise / length, 2);
  }
  const Eigen::VectorXd residual = system.e - system.by_setting * system.expected_change;
  std::vector<bool> outliers = none;
  std::vector<bool> best = none;
  const auto weight = [&](const std::vector<bool>& out) {
    const Weighed w = weighed(system, covariance, residual, out);
    return NoiseDensity(system.noise_dof, w.rows).log_density(w.quadratic) - 0.5 * w.log_det +
           log_price_of_outliers(system, out);
  };
  double most = weight(none);
  const auto steps =
      static_cast<std::size_t>(std::max(3.0, std::ceil(kMostOutlierShare * double{kUnits})));
  for (std::size_t step = 0; step < steps; ++step) {
    const double before = weighed(system, covariance, residual, outliers).quadratic;
    std::size_t worst = 0;
    double gain = -std::numeric_limits<double>::infinity();
    for (std::size_t u = 0; u < kUnits; ++u) {
      if (outliers[u]) continue;
      std::vector<bool> without = outliers;
      without[u] = true;
      const double own = before - weighed(system, covariance, residual, without).quadratic +
                         2.0 * log_price_of_outlier(system.units[u].rows);
      if (own > gain) {
        gain = own;
        worst = u;
      }
    }
    outliers[worst] = true;
    if (const double own = weight(outliers); own > most) {
      most = own;
      best = outliers;
    }
  }
  return best;
}

TEST(OutlierSearch, EqualsThatOfTheFullCovariance) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const RegressorSystem system = random_system(random);
    const std::vector<bool> none(kUnits, false);
    for (const std::vector<int>& set : {std::vector<int>{}, std::vector<int>{0}}) {
      const auto found = outlier_sets(system, none, {set});
      EXPECT_EQ(found.front(), one_by_one(system, set)) << set.size() << " regressors";
    }
  }
}

/// Pairs of rows with four directions each, like four belts at a position.
struct Places {
  RegressorSystem system;
  std::vector<OutlierGroup> groups;
};
constexpr std::size_t kPlaces = 12;
constexpr std::size_t kDirections = 4;

Places random_places(Random& random) {
  Places places;
  places.system = random_system(random);
  const Eigen::Index rows = 2 * kPlaces;
  RegressorSystem& system = places.system;
  system.units.clear();
  system.unit_of_row.clear();
  for (std::size_t k = 0; k < kPlaces; ++k) {
    system.units.push_back({.first_row = static_cast<Eigen::Index>(2 * k), .rows = 2});
    system.unit_of_row.insert(system.unit_of_row.end(), 2, static_cast<int>(k));
  }
  const Eigen::VectorXd g = system.g.col(0).head(rows);
  system.g = RegressorColumns(g);
  system.e.conservativeResize(rows);
  system.by_setting.conservativeResize(rows, Eigen::NoChange);
  for (std::size_t k = 0; k < kPlaces; ++k) {
    for (std::size_t d = 0; d < kDirections; ++d) {
      places.groups.push_back({static_cast<Eigen::Index>(2 * k),
                               2,
                               Eigen::Vector2d(random.normal(), random.normal())});
    }
  }
  system.groups = places.groups;
  system.limits = {};
  return places;
}

/// A basis of the rows without the directions of the flagged groups.
Eigen::MatrixXd basis_without(const Places& places, const std::vector<bool>& outliers) {
  const Eigen::Index rows = places.system.e.size();
  Eigen::MatrixXd basis(rows, 0);
  for (std::size_t k = 0; k < kPlaces; ++k) {
    Eigen::MatrixXd gone = Eigen::MatrixXd::Zero(2, 2);
    for (std::size_t d = 0; d < kDirections; ++d) {
      const std::size_t group = kDirections * k + d;
      if (!outliers[group]) continue;
      const Eigen::Vector2d v = places.groups[group].direction->normalized();
      gone += v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gone);
    for (Eigen::Index i = 0; i < 2; ++i) {
      // Zero to rounding in the remaining directions.
      if (eigen.eigenvalues()(i) > 1e-9) continue;
      basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
      basis.rightCols<1>().setZero();
      basis.rightCols<1>().segment<2>(static_cast<Eigen::Index>(2 * k)) = eigen.eigenvectors().col(i);
    }
  }
  return basis;
}

// A set's weight, and a check by the whole covariance that no other reading is worse.
TEST(OutlierSearch, DirectionsEqualThoseOfTheFullCovariance) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Places places = random_places(random);
    const RegressorSystem& system = places.system;
    const Eigen::MatrixXd scaled = system.by_setting * system.sigma.asDiagonal();
    const Eigen::MatrixXd covariance =
        Eigen::MatrixXd::Identity(system.e.size(), system.e.size()) + scaled * scaled.transpose();
    const Eigen::VectorXd residual = system.e - system.by_setting * system.expected_change;
    const auto weighed_without = [&](const std::vector<bool>& outliers) {
      const Eigen::MatrixXd basis = basis_without(places, outliers);
      const Eigen::LLT<Eigen::MatrixXd> llt(basis.transpose() * covariance * basis);
      const Eigen::VectorXd white = llt.matrixL().solve(basis.transpose() * residual);
      return Weighed{white.squaredNorm(),
                     2.0 * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum(),
                     basis.cols()};
    };
    const auto weight = [&](const std::vector<bool>& outliers) {
      const Weighed w = weighed_without(outliers);
      return NoiseDensity(system.noise_dof, w.rows).log_density(w.quadratic) - 0.5 * w.log_det +
             static_cast<double>(system.e.size() - w.rows) * log_price_of_outlier(1);
    };
    const auto complete = [](std::vector<bool> outliers) {
      for (std::size_t k = 0; k < kPlaces; ++k) {
        const auto first = outliers.begin() + static_cast<std::ptrdiff_t>(kDirections * k);
        if (std::count(first, first + kDirections, true) > 1)
          std::fill(first, first + kDirections, true);
      }
      return outliers;
    };
    std::vector<bool> outliers(places.groups.size(), false);
    std::vector<bool> best = outliers;
    double most = weight(outliers);
    // kMostOutlierShare of 48 groups.
    for (int step = 0; step < 6; ++step) {
      std::size_t worst = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t group = 0; group < outliers.size(); ++group) {
        if (outliers[group]) continue;
        std::vector<bool> without = outliers;
        without[group] = true;
        const double left = weighed_without(without).quadratic;
        // Several readings of a position with one outlier are the same direction, to rounding.
        if (left < least - 1e-9 * (1.0 + left)) {
          least = left;
          worst = group;
        }
      }
      outliers[worst] = true;
      outliers = complete(std::move(outliers));
      if (const double own = weight(outliers); own > most) {
        most = own;
        best = outliers;
      }
    }
    EXPECT_EQ(outlier_sets(system, nothing_rejected(system), {{}}).front(), best);
    // The remaining rows are those of the comparison, to rounding.
    const Weighed w = weighed_without(best);
    const MarginalisedSystem left = marginalise(system, best);
    EXPECT_EQ(left.kept.size(), w.rows);
    EXPECT_NEAR(left.e.squaredNorm(), w.quadratic, 1e-9 * (1.0 + w.quadratic));
    EXPECT_NEAR(left.log_det, w.log_det, 1e-9 * (1.0 + std::abs(w.log_det)));
    EXPECT_NEAR(left.log_outliers,
                static_cast<double>(system.e.size() - w.rows) * log_price_of_outlier(1),
                1e-9);
  }
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis
