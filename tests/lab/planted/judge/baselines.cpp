// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/baselines.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace chaintrue::planted {
namespace {

using Eigen::Index;
using Set = std::vector<Index>;

/// What least squares on some columns leaves of y'y.
double left_by(const Regression& data, const Set& set) {
  if (set.empty()) return data.y.squaredNorm();
  const Eigen::MatrixXd x = data.columns(Eigen::all, set);
  return (data.y - x * x.colPivHouseholderQr().solve(data.y)).squaredNorm();
}

/// F of a column among `columns`; `left` and `left_without` are the squares with and without it.
double f_of(const Regression& data, double left_without, double left, std::size_t columns) {
  const double dof = static_cast<double>(data.y.size()) - data.taken - static_cast<double>(columns);
  return left > 0.0 ? (left_without - left) / (left / dof)
                    : std::numeric_limits<double>::infinity();
}

/// The column that lowers the rest most, given the set; all columns at once by their parts orthogonal to it.
std::optional<Index> best_entry(const Regression& data, const Set& set) {
  Eigen::VectorXd rest = data.y;
  Eigen::MatrixXd others = data.columns;
  if (!set.empty()) {
    const Eigen::MatrixXd x = data.columns(Eigen::all, set);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
    const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(x.rows(), x.cols());
    rest -= q * (q.transpose() * rest);
    others -= q * (q.transpose() * others);
  }
  std::optional<Index> best;
  double most = 0.0;
  for (Index k = 0; k < others.cols(); ++k) {
    // A column in the span of the set is left with rounding.
    constexpr double kInSpan = 1e-6;
    if (others.col(k).norm() < kInSpan * data.columns.col(k).norm()) continue;
    const double improvement = std::pow(others.col(k).dot(rest), 2) / others.col(k).squaredNorm();
    if (improvement <= most) continue;
    most = improvement;
    best = k;
  }
  return best;
}

/// Takes out the column with the least F if that is below the threshold.
bool step_back(const Regression& data, double threshold, Set& set) {
  const double left = left_by(data, set);
  std::size_t weakest = set.size();
  double least = threshold;
  for (std::size_t k = 0; k < set.size(); ++k) {
    Set without = set;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
    const double f = f_of(data, left_by(data, without), left, set.size());
    if (f >= least) continue;
    least = f;
    weakest = k;
  }
  if (weakest == set.size()) return false;
  set.erase(set.begin() + static_cast<std::ptrdiff_t>(weakest));
  return true;
}

Set stepwise(const Regression& data, double threshold) {
  // A column that came in and went again would come again.
  constexpr std::size_t kMost = 8;
  constexpr int kSteps = 20;
  Set set;
  for (int step = 0; step < kSteps && set.size() < kMost; ++step) {
    const auto entry = best_entry(data, set);
    if (!entry) break;
    Set with = set;
    with.push_back(*entry);
    if (f_of(data, left_by(data, set), left_by(data, with), with.size()) < threshold) break;
    set = std::move(with);
    while (step_back(data, threshold, set)) {
    }
  }
  return set;
}

/// The columns of each cause that explain most by themselves.
Set best_places(const Regression& data, std::size_t places) {
  std::map<std::string, std::vector<std::pair<double, Index>>> of;
  for (Index k = 0; k < data.columns.cols(); ++k) {
    const double improvement =
        std::pow(data.columns.col(k).dot(data.y), 2) / data.columns.col(k).squaredNorm();
    of[data.causes[static_cast<std::size_t>(k)]].emplace_back(-improvement, k);
  }
  Set best;
  for (auto& [cause, ranked] : of) {
    std::sort(ranked.begin(), ranked.end());
    for (std::size_t k = 0; k < std::min(places, ranked.size()); ++k)
      best.push_back(ranked[k].second);
  }
  return best;
}

/// Coordinate descent about columns of length one; `rows` of the data.
class Descent {
 public:
  Descent(Eigen::MatrixXd x, Eigen::VectorXd y)
      : x_(std::move(x)), rest_(std::move(y)), square_(x_.colwise().squaredNorm()) {
    coefficient_ = Eigen::VectorXd::Zero(x_.cols());
  }
  /// On from where the last penalty ended.
  const Eigen::VectorXd& at(double penalty) {
    // A thousandth of a sigma, of columns of length one.
    constexpr double kConverged = 1e-3;
    constexpr int kRounds = 500;
    for (int round = 0; round < kRounds; ++round) {
      double most = 0.0;
      for (Index k = 0; k < x_.cols(); ++k) {
        if (!(square_(k) > 0.0)) continue;
        const double before = coefficient_(k);
        const double pull = x_.col(k).dot(rest_) + square_(k) * before;
        const double after =
            std::copysign(std::max(std::abs(pull) - penalty, 0.0), pull) / square_(k);
        if (after == before) continue;
        rest_ -= (after - before) * x_.col(k);
        coefficient_(k) = after;
        most = std::max(most, std::abs(after - before));
      }
      if (most < kConverged) break;
    }
    return coefficient_;
  }

 private:
  Eigen::MatrixXd x_;
  Eigen::VectorXd rest_;
  Eigen::VectorXd square_;
  Eigen::VectorXd coefficient_;
};

/// From the least penalty at which nothing is in, downwards.
std::vector<double> penalties(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  constexpr int kPenalties = 40;
  constexpr double kRange = 100.0;
  std::vector<double> all;
  const double first = (x.transpose() * y).cwiseAbs().maxCoeff();
  for (int k = 0; k < kPenalties; ++k)
    all.push_back(first * std::pow(kRange, -k / (kPenalties - 1.0)));
  return all;
}

/// Of the least square error of what is left out.
double best_penalty(const Eigen::MatrixXd& x,
                    const Eigen::VectorXd& y,
                    const std::vector<double>& tried) {
  constexpr Index kFolds = 10;
  std::vector<double> errors(tried.size(), 0.0);
  for (Index fold = 0; fold < kFolds; ++fold) {
    std::vector<Index> in, out;
    for (Index row = 0; row < y.size(); ++row) {
      (row * kFolds / y.size() == fold ? out : in).push_back(row);
    }
    Descent descent(x(in, Eigen::all), y(in));
    for (std::size_t k = 0; k < tried.size(); ++k) {
      // The same penalty a row.
      const double penalty =
          tried[k] * static_cast<double>(in.size()) / static_cast<double>(y.size());
      errors[k] += (y(out) - x(out, Eigen::all) * descent.at(penalty)).squaredNorm();
    }
  }
  return tried[static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) -
                                        errors.begin())];
}

}  // namespace

Scores stepwise_scores(const Regression& data) {
  Scores scores;
  // Up to F of 4096, a strength of 64.
  for (double threshold = 2.0; threshold < 5000.0; threshold *= std::sqrt(2.0)) {
    const Set set = stepwise(data, threshold);
    if (set.empty()) break;
    for (const Index k : set) scores[data.causes[static_cast<std::size_t>(k)]] = threshold;
  }
  return scores;
}

Scores bic_scores(const Regression& data) {
  constexpr std::size_t kPlaces = 8;
  const Set columns = best_places(data, kPlaces);
  const auto m = static_cast<Index>(columns.size());
  const Eigen::MatrixXd x = data.columns(Eigen::all, columns);
  const Eigen::MatrixXd gram = x.transpose() * x;
  const Eigen::VectorXd product = x.transpose() * data.y;
  const auto cause = [&](Index k) -> const std::string& {
    return data.causes[static_cast<std::size_t>(columns[static_cast<std::size_t>(k)])];
  };
  const double rows = static_cast<double>(data.y.size()) - data.taken;
  const double all = data.y.squaredNorm();
  struct Weighed {
    double half_bic;
    std::array<Index, 3> set;
    int size;
  };
  std::vector<Weighed> sets;
  const auto weigh = [&](std::array<Index, 3> set, int size) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (int i = 0; i < size; ++i) {
      const auto row = set[static_cast<std::size_t>(i)];
      b(i) = product(row);
      for (int j = 0; j < size; ++j) g(i, j) = gram(row, set[static_cast<std::size_t>(j)]);
    }
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(g);
    // Columns that are multiples of one another say nothing together.
    constexpr double kMultiple = 1e-9;
    if (ldlt.vectorD().minCoeff() < kMultiple * ldlt.vectorD().maxCoeff()) return;
    const double left = std::max(all - b.dot(ldlt.solve(b)), 1e-12 * all);
    sets.push_back({0.5 * (rows * std::log(left / rows) + size * std::log(rows)), set, size});
  };
  weigh({}, 0);
  for (Index i = 0; i < m; ++i) {
    weigh({i, 0, 0}, 1);
    for (Index j = 0; j < i; ++j) {
      if (cause(i) == cause(j)) continue;
      weigh({i, j, 0}, 2);
      for (Index k = 0; k < j; ++k) {
        if (cause(k) != cause(i) && cause(k) != cause(j)) weigh({i, j, k}, 3);
      }
    }
  }
  const double least = std::min_element(sets.begin(), sets.end(), [](const auto& a, const auto& b) {
                         return a.half_bic < b.half_bic;
                       })->half_bic;
  double total = 0.0;
  Scores scores;
  for (const Weighed& one : sets) {
    const double weight = std::exp(least - one.half_bic);
    total += weight;
    for (int k = 0; k < one.size; ++k)
      scores[cause(one.set[static_cast<std::size_t>(k)])] += weight;
  }
  for (auto& [id, score] : scores) score /= total;
  return scores;
}

Scores lasso_scores(const Regression& data) {
  Eigen::MatrixXd x = data.columns;
  x.colwise().normalize();
  const std::vector<double> tried = penalties(x, data.y);
  const double chosen = best_penalty(x, data.y, tried);
  Descent descent(x, data.y);
  Eigen::VectorXd coefficient;
  for (const double penalty : tried) {
    coefficient = descent.at(penalty);
    if (penalty <= chosen) break;
  }
  const double rows = static_cast<double>(data.y.size()) - data.taken;
  const double sigma = std::sqrt((data.y - x * coefficient).squaredNorm() / rows);
  std::map<std::string, Eigen::VectorXd> added;
  for (Index k = 0; k < x.cols(); ++k) {
    if (coefficient(k) == 0.0) continue;
    auto& sum = added[data.causes[static_cast<std::size_t>(k)]];
    if (sum.size() == 0) sum = Eigen::VectorXd::Zero(x.rows());
    sum += coefficient(k) * x.col(k);
  }
  Scores scores;
  for (const auto& [id, sum] : added) scores[id] = sigma > 0.0 ? sum.norm() / sigma : sum.norm();
  return scores;
}

}  // namespace chaintrue::planted
