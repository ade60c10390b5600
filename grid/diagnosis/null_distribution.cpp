// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/null_distribution.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/parallel.hpp"
#include "grid/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kNoScore = -1e3;
/// Prior of a strength.
double precision() { return 1.0 / (kUsualSignalToNoise * kUsualSignalToNoise); }
constexpr int kBlock = 250;  // draws at a time

}  // namespace

SingleScore::SingleScore(const RegressorSystem& system,
                         const MarginalisedSystem& marginalised,
                         double noise_dof)
    : marginalised_(marginalised), dof_(noise_dof) {
  square_ = marginalised.g.squared_norms();
  constant_.resize(square_.size());
  for (Eigen::Index k = 0; k < square_.size(); ++k) {
    const Regressor& d = system.regressor(k);
    fixed_.push_back(d.fixed);
    sign_.push_back(d.fixed || (d.lowest < 0.0 && d.highest > 0.0) ? 0
                                                                   : (d.highest > 0.0 ? 1 : -1));
    constant_(k) = d.log_prior;
    if (!d.fixed) constant_(k) -= std::log(kUsualSignalToNoise) + 0.5 * std::log1p(precision());
    if (sign_.back() != 0) constant_(k) += std::log(2.0);
  }
}

double SingleScore::share_taken(std::size_t at, double square, double c, double ee) const {
  const double drop = fixed_[at] ? 2.0 * c - square : c * c / (square * (1.0 + precision()));
  return drop / (dof_ + ee);
}

double SingleScore::score(Eigen::Index k, double square, double c, double ee, double n) const {
  const auto at = as_size(k);
  if (!(square > 1e-8) || sign_[at] * c < 0.0) return kNoScore;
  return constant_(k) - 0.5 * (n + dof_) * std::log1p(-share_taken(at, square, c, ee));
}

double SingleScore::most(Eigen::Index k, double square, double c, double ee, double n) const {
  // -log(1 - x) <= x / (1 - x); the last digits of either side do not matter to a score that is far below.
  constexpr double kRounding = 1e-9;
  const double taken = share_taken(as_size(k), square, c, ee);
  return constant_(k) + 0.5 * (n + dof_) * taken / (1.0 - taken) + kRounding;
}

double SingleScore::largest(const NormalEquations& equations, Eigen::Index rows) const {
  double result = kNoScore;
  for (std::size_t i = 0; i < equations.columns.size(); ++i) {
    const auto at = as_index(i);
    result = std::max(result,
                      score(equations.columns[i],
                            equations.gg(at, at),
                            equations.ge(at),
                            equations.ee,
                            as_double(rows)));
  }
  return result;
}

double SingleScore::largest(const Eigen::VectorXd& e) const {
  const Eigen::VectorXd c = marginalised_.g.transpose_times(e);
  const double ee = e.squaredNorm();
  const auto n = as_double(e.size());
  double result = kNoScore;
  for (Eigen::Index k = 0; k < c.size(); ++k)
    result = std::max(result, score(k, square_(k), c(k), ee, n));
  return result;
}

Eigen::VectorXd SingleScore::largest(const Eigen::MatrixXd& e) const {
  const RegressorColumns& g = marginalised_.g;
  const Eigen::MatrixXd c = linear::product(linear::transposed(g.distinct()), e);
  const auto n = as_double(e.rows());
  Eigen::VectorXd result = Eigen::VectorXd::Constant(e.cols(), kNoScore);
  for (Eigen::Index draw = 0; draw < e.cols(); ++draw) {
    const double ee = e.col(draw).squaredNorm();
    for (Eigen::Index k = 0; k < g.cols(); ++k) {
      const double own = g.factor(k) * c(g.index(k), draw);
      if (most(k, square_(k), own, ee, n) > result(draw))
        result(draw) = std::max(result(draw), score(k, square_(k), own, ee, n));
    }
  }
  return result;
}

double NullDistribution::p_value(double score) const {
  const auto first = std::lower_bound(largest.begin(), largest.end(), score);
  const auto above = as_double(largest.end() - first);
  return (above + 1.0) / (as_double(largest.size()) + 1.0);
}

namespace {

/// `prepare` makes residuals of a block of standard normals.
template <class Prepare>
NullDistribution drawn(const SingleScore& score,
                       Eigen::Index rows,
                       int draws,
                       std::uint64_t seed,
                       const Prepare& prepare) {
  constexpr std::uint64_t kStream = 61;
  Random random(seed, kStream);
  std::vector<Eigen::MatrixXd> blocks;
  for (int done = 0; done < draws; done += kBlock) {
    Eigen::MatrixXd& e = blocks.emplace_back(rows, std::min(kBlock, draws - done));
    for (double& own : e.reshaped()) own = random.normal();
  }
  NullDistribution result;
  result.largest.resize(as_size(draws));
  for_each_index(blocks.size(), [&](std::size_t k) {
    prepare(blocks[k]);
    const Eigen::VectorXd largest = score.largest(blocks[k]);
    std::copy(largest.begin(), largest.end(), result.largest.begin() + static_cast<std::ptrdiff_t>(k) * kBlock);
    blocks[k].resize(0, 0);
  });
  sort(result.largest);
  return result;
}

}  // namespace

NullDistribution draw_null(const SingleScore& score,
                           Eigen::Index rows,
                           int draws,
                           std::uint64_t seed) {
  return drawn(score, rows, draws, seed, [](Eigen::MatrixXd&) {});
}

NullDistribution draw_null_of_length(const SingleScore& score,
                                     const MarginalisedSystem& marginalised,
                                     int draws,
                                     std::uint64_t seed) {
  const double length = marginalised.e.norm();
  return drawn(score, marginalised.e.size(), draws, seed, [&](Eigen::MatrixXd& e) {
    e = marginalised.root.solve(e);
    for (Eigen::Index k = 0; k < e.cols(); ++k) e.col(k) *= length / e.col(k).norm();
  });
}

}  // namespace chaintrue::grid::diagnosis
