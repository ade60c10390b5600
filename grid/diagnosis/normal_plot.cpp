// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/normal_plot.hpp"

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/noise_draws.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kPlotDraws = 499;
constexpr int kInside = 474;  // 95 % of them
/// Fewer ranks have no shape: those of eight points.
constexpr Eigen::Index kFewestRows = 2 * static_cast<Eigen::Index>(kFewestPoints);

/// Rows of the marginalised system that are units' rows: readings of the machine are none of the
/// plot's.
Eigen::Index rows_of_units(const Analysis& a) {
  const std::vector<Eigen::Index>& kept = marginalised_system(a).kept.rows();
  const auto end = std::lower_bound(kept.begin(), kept.end(), a.system.observed_rows());
  return static_cast<Eigen::Index>(end - kept.begin());
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
  for (const double value : draws) rank.mean += value / kPlotDraws;
  constexpr std::size_t kTail = kPlotDraws / 40;
  rank.below = rank.mean - draws[kTail];
  rank.above = draws[kPlotDraws - 1 - kTail] - rank.mean;
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

std::optional<NormalPlot> normal_plot(const Analysis& a) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Eigen::Index rows = rows_of_units(a);
  if (rows < kFewestRows) return std::nullopt;
  const Eigen::VectorXd& left =
      a.decision.discrepancy_left ? a.estimate.left_given_discrepancy : a.estimate.left;
  NormalPlot plot;
  plot.values = shape_of(marginalised.kept(left).head(rows));
  constexpr std::uint64_t kStream = 64;
  const Eigen::MatrixXd noise = left_of_noise(a, Nuisances::taken_out, kPlotDraws, kStream);
  std::vector<std::vector<double>> curves;
  for (Eigen::Index draw = 0; draw < kPlotDraws; ++draw) {
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
  plot.p_value = static_cast<double>(as_far + 1) / (kPlotDraws + 1);
  const double wide = usual[kInside - 1];
  for (const Rank& rank : ranks) {
    plot.expected.push_back(rank.mean);
    plot.low.push_back(rank.mean - wide * rank.below);
    plot.high.push_back(rank.mean + wide * rank.above);
  }
  return plot;
}

}  // namespace chaintrue::grid::diagnosis
