// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Monte Carlo distribution of the largest single score over the whole catalogue when no effect
/// acts. Scores of similar effects are far from independent, so no correction for their number is
/// valid; draws are valid for any catalogue and points. Source: V. Rofatto et al., Remote Sensing
/// 12 (2020) 860, on the largest statistic of many alternatives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "grid/diagnosis/evidence.hpp"
#include "grid/parallel.hpp"
#include "grid/random.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// Per regressor: log of prior times Bayes factor against nothing, Student form, in one inner
/// product; a regressor of the wrong sign has no score.
class SingleScore {
 public:
  SingleScore(const RegressorSystem& system, const MarginalisedSystem& marginalised,
              double noise_dof)
      : system_(system),
        marginalised_(marginalised),
        dof_(noise_dof),
        square_(squared_lengths(system, marginalised)) {
    constant_.resize(square_.size());
    for (const Index k : each_below(square_.size())) {
      const Regressor& d = system.regressor(k);
      fixed_.push_back(d.fixed);
      sign_.push_back(d.fixed || (d.lowest < 0.0 && d.highest > 0.0) ? 0
                                                                     : (d.highest > 0.0 ? 1 : -1));
      constant_(k) = d.log_prior;
      if (!d.fixed) constant_(k) -= std::log(kUsualSignalToNoise) + 0.5 * std::log1p(precision());
      if (sign_.back() != 0) constant_(k) += std::log(2.0);
    }
  }

  /// The largest over the columns of normal equations with this many rows.
  double largest(const NormalEquations& equations, Index rows) const {
    double result = kNoScore;
    for (const auto i : each_index(equations.columns)) {
      const auto at = as_index(i);
      result = std::max(result, score(equations.columns[i], equations.gg(at, at), equations.ge(at),
                                      equations.ee, as_double(rows)));
    }
    return result;
  }

  /// The largest score for each column of `e`, which are like MarginalisedSystem::e.
  VectorXd largest(const MatrixXd& e) const {
    // Thousands of draws: only products with distinct columns are stored.
    const RegressorColumns& g = system_.g;
    const MatrixXd rows = marginalised_.kept.spread(marginalised_.root.solve(e));
    const MatrixXd c = linear::inner(g.distinct(), rows);
    const auto n = as_double(e.rows());
    VectorXd result = VectorXd::Constant(e.cols(), kNoScore);
    for (const Index draw : each_below(e.cols())) {
      const double ee = e.col(draw).squaredNorm();
      for (const Index k : each_below(g.cols())) {
        const double own = g.factor(k) * c(g.index(k), draw);
        result(draw) = std::max(result(draw), score(k, square_(k), own, ee, n, result(draw)));
      }
    }
    return result;
  }

 private:
  static constexpr double kNoScore = -1e3;
  /// Prior of a strength.
  static double precision() { return 1.0 / (kUsualSignalToNoise * kUsualSignalToNoise); }

  /// For a regressor with this square and inner product with the residual, in this many rows; none
  /// if it is less than `least`.
  double score(Index k, double square, double c, double ee, double n,
               double least = kNoScore) const {
    const auto at = as_size(k);
    if (!(square > 1e-8) || sign_[at] * c < 0.0) return kNoScore;
    // The reduction of the residual's square by the regressor's best size.
    const double drop = fixed_[at] ? 2.0 * c - square : c * c / (square * (1.0 + precision()));
    const double taken = drop / (dof_ + ee);
    // -log(1 - x) <= x / (1 - x) spares most logarithms.
    const double power = 0.5 * (n + dof_);
    if (constant_(k) + power * taken / (1.0 - taken) < least) return kNoScore;
    return constant_(k) - power * std::log1p(-taken);
  }

  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  double dof_;
  VectorXd square_;
  VectorXd constant_;
  std::vector<int> sign_;  ///< +1: coefficient >= 0 only, -1: <= 0, 0: either
  Flags fixed_;
};

struct NullDistribution {
  std::vector<double> largest;  ///< ascending
  /// Share of draws at least as large: never 0, the data count as one draw.
  double p_value(double score) const {
    const auto first = std::lower_bound(largest.begin(), largest.end(), score);
    const auto above = as_double(largest.end() - first);
    return (above + 1.0) / (as_double(largest.size()) + 1.0);
  }
};
/// What is stated about the noise. If nothing is stated, residuals of a given length point in every
/// direction with equal probability, whatever the noise, so the strongest score has one
/// distribution for all residuals of that length (E. Lehmann and J. Romano, Testing Statistical
/// Hypotheses (2005), section 5.2: an unknown scale is conditioned out).
enum class NoiseSize { stated, unknown };

/// For residuals like those of `marginalised`; of unknown size: as long as those, and projected on the
/// settings in the same way.
inline NullDistribution draw_null(const SingleScore& score, const MarginalisedSystem& marginalised,
                                  NoiseSize noise, int draws, std::uint64_t seed) {
  constexpr std::uint64_t kStream = 61;
  constexpr int kBlock = 250;  // draws at a time
  Random random(seed, kStream);
  std::vector<MatrixXd> blocks;
  for (int done = 0; done < draws; done += kBlock) {
    MatrixXd& e = blocks.emplace_back(marginalised.e.size(), std::min(kBlock, draws - done));
    for (double& own : e.reshaped()) own = random.normal();
  }
  const double length = marginalised.e.norm();
  NullDistribution result;
  result.largest.resize(as_size(draws));
  for_each_index(blocks.size(), [&](std::size_t k) {
    MatrixXd& e = blocks[k];
    if (noise == NoiseSize::unknown) {
      e = marginalised.root.solve(e);
      for (const Index draw : each_below(e.cols())) e.col(draw) *= length / e.col(draw).norm();
    }
    const VectorXd largest = score.largest(e);
    std::copy(largest.begin(), largest.end(),
              result.largest.begin() + static_cast<std::ptrdiff_t>(k) * kBlock);
    e.resize(0, 0);
  });
  sort(result.largest);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
