// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/normal_plot.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/leading.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kDraws = 499;
constexpr int kInside = 474;  // 95 % of them

/// Rows of the marginalised system that are points' rows: readings of the machine are none of the
/// plot's.
Eigen::Index rows_of_points(const Session& session, const MarginalisedSystem& marginalised) {
  const auto end =
      std::lower_bound(marginalised.kept.begin(), marginalised.kept.end(), session.observed_rows());
  return static_cast<Eigen::Index>(end - marginalised.kept.begin());
}

/// What the fit of settings and causes leaves of noise, a column a draw.
Eigen::MatrixXd left_of_noise(const Analysis& a, std::uint64_t seed) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const auto n = static_cast<Eigen::Index>(marginalised.kept.size());
  const Eigen::Index settings = a.system.by_setting.cols();
  const auto causes = static_cast<Eigen::Index>(a.estimate.free.size());
  // In units of what each unknown may be beforehand.
  Eigen::MatrixXd design(n, settings + causes);
  design.leftCols(settings) =
      a.system.by_setting(marginalised.kept, Eigen::all) * a.system.sigma.asDiagonal();
  for (Eigen::Index k = 0; k < causes; ++k) {
    const int column = a.estimate.regressors[a.estimate.free[static_cast<std::size_t>(k)]];
    design.col(settings + k) = a.system.g(marginalised.kept, column) * kWideSignalToNoise /
                               std::max(marginalised.g.col(column).norm(), 1e-12);
  }
  Eigen::MatrixXd normal = design.transpose() * design;
  normal.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(normal);
  constexpr std::uint64_t kStream = 64;
  synthetic::Random random(seed, kStream);
  Eigen::MatrixXd z(n, kDraws);
  for (Eigen::Index draw = 0; draw < kDraws; ++draw) {
    for (Eigen::Index i = 0; i < n; ++i) z(i, draw) = random.normal();
  }
  const Eigen::MatrixXd taken = llt.solve(design.transpose() * z);
  z.noalias() -= design * taken;
  return z;
}

/// Ascending, of rms 1.
std::vector<double> shape_of(Eigen::VectorXd values) {
  values /= std::max(std::sqrt(values.squaredNorm() / static_cast<double>(values.size())), 1e-300);
  std::sort(values.begin(), values.end());
  return {values.begin(), values.end()};
}

/// One rank over the draws: its mean, and how far 95 % of them lie below and above it.
struct Rank {
  double mean = 0.0;
  double below = 0.0;
  double above = 0.0;
};

Rank rank_of(std::vector<double> draws) {
  std::sort(draws.begin(), draws.end());
  Rank rank;
  for (const double value : draws) rank.mean += value / kDraws;
  constexpr std::size_t kTail = kDraws / 40;
  rank.below = rank.mean - draws[kTail];
  rank.above = draws[kDraws - 1 - kTail] - rank.mean;
  return rank;
}

/// How far a curve strays, as a multiple of what is usual at the rank where it strays most.
double strays(const std::vector<Rank>& ranks, const std::vector<double>& curve) {
  double most = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double off = curve[i] - ranks[i].mean;
    most = std::max(most, off < 0.0 ? -off / ranks[i].below : off / ranks[i].above);
  }
  return most;
}

}  // namespace

std::optional<NormalPlot> normal_plot(const Session& session,
                                      const Analysis& a,
                                      std::uint64_t seed) {
  // Of distances the holes' own errors hide what is normal and what is not.
  if (session.distances) return std::nullopt;
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Eigen::Index rows = rows_of_points(session, marginalised);
  if (rows < 2 * static_cast<Eigen::Index>(kFewestPoints)) return std::nullopt;
  const Eigen::VectorXd& left =
      a.decision.discrepancy_left ? a.estimate.left_beside_discrepancy : a.estimate.left;
  NormalPlot plot;
  plot.values = shape_of(Eigen::VectorXd(left(marginalised.kept)).head(rows));
  const Eigen::MatrixXd noise = left_of_noise(a, seed);
  std::vector<std::vector<double>> curves;
  for (Eigen::Index draw = 0; draw < kDraws; ++draw) {
    curves.push_back(shape_of(noise.col(draw).head(rows)));
  }
  std::vector<Rank> ranks;
  for (std::size_t i = 0; i < plot.values.size(); ++i) {
    std::vector<double> draws;
    for (const auto& curve : curves) draws.push_back(curve[i]);
    ranks.push_back(rank_of(std::move(draws)));
  }
  std::vector<double> usual;
  for (const auto& curve : curves) usual.push_back(strays(ranks, curve));
  std::sort(usual.begin(), usual.end());
  const double own = strays(ranks, plot.values);
  const auto as_far = usual.end() - std::lower_bound(usual.begin(), usual.end(), own);
  plot.p_value = static_cast<double>(as_far + 1) / (kDraws + 1);
  const double wide = usual[kInside - 1];
  for (const Rank& rank : ranks) {
    plot.expected.push_back(rank.mean);
    plot.low.push_back(rank.mean - wide * rank.below);
    plot.high.push_back(rank.mean + wide * rank.above);
  }
  return plot;
}

}  // namespace chaintrue::grid::diagnosis
