// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How many random sets a statistic takes, and what sums over them may be.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "sealed/judge/binomial.hpp"

namespace chaintrue::coverage {

/// The seeds of a statistic's sets: as many as CHAINTRUE_SETS in the environment says, else `usual`.
inline std::vector<std::uint64_t> seeds(std::uint64_t usual) {
  const char* const sets = std::getenv("CHAINTRUE_SETS");
  std::vector<std::uint64_t> result(sets != nullptr ? std::strtoull(sets, nullptr, 10) : usual);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = i + 1;
  return result;
}

/// Squares of errors in units of what is stated of them. Each set adds one sum of `freedom` squares
/// that are independent, or worth so many.
class Squares {
 public:
  explicit Squares(double freedom) : freedom_(freedom) {}
  void add(double sum) {
    sum_ += sum;
    ++sets_;
  }
  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
    add(error.dot(covariance.ldlt().solve(error)));
  }
  double mean() const { return sum_ / (freedom_ * sets_); }
  /// Four standard errors of a chi-square: fails by chance once in 16 000. It fails in 98 of 100 runs
  /// where sigmas are wrong by six standard errors; `estimated` allows for sigmas that are estimated
  /// from few readings themselves.
  void expect_unit(double estimated = 0.0) const {
    EXPECT_NEAR(mean(), 1.0, 4.0 * std::sqrt(2.0 / (freedom_ * sets_)) + estimated)
        << sets_ << " sets";
  }

 private:
  double freedom_;
  double sum_ = 0.0;
  int sets_ = 0;
};

/// Counts of an event with a stated rate. Both expectations fail by chance once in a thousand.
struct Rate {
  int found = 0;
  int sets = 0;
  void add(bool is_found) {
    found += is_found ? 1 : 0;
    ++sets;
  }
  void expect_at_least(double p) const {
    EXPECT_GE(1.0 - sealed::probability_of_at_least(found + 1, sets, p), 1e-3)
        << found << " of " << sets;
  }
  void expect_at_most(double p) const {
    EXPECT_GE(sealed::probability_of_at_least(found, sets, p), 1e-3) << found << " of " << sets;
  }
};

/// p-values are uniform: Kolmogorov's distance is beyond 1.95 / sqrt(n) once in a thousand (N. Smirnov,
/// Ann. Math. Stat. 19 (1948), 279).
inline void expect_uniform(std::vector<double> p) {
  std::ranges::sort(p);
  const auto n = static_cast<double>(p.size());
  double most = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto k = static_cast<double>(i);
    most = std::max({most, p[i] - k / n, (k + 1.0) / n - p[i]});
  }
  EXPECT_LT(most * std::sqrt(n), 1.95) << p.size() << " sets";
}

}  // namespace chaintrue::coverage
