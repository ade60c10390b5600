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
constexpr int kInside = 475;    // 95 % of them
constexpr int kOutermost = 12;  // 2.5 % of them

/// Rows of the space that are points' rows: readings of the machine are none of the plot's.
Eigen::Index rows_of_points(const Session& session, const Space& space) {
  const auto end = std::lower_bound(space.kept.begin(), space.kept.end(), session.observed_rows());
  return static_cast<Eigen::Index>(end - space.kept.begin());
}

/// What the fit of settings and causes leaves of noise, a column a draw.
Eigen::MatrixXd left_of_noise(const Analysis& a, std::uint64_t seed) {
  const Space& space = space_of(a);
  const auto n = static_cast<Eigen::Index>(space.kept.size());
  const Eigen::Index settings = a.rows.by_setting.cols();
  const auto causes = static_cast<Eigen::Index>(a.estimate.free.size());
  // In units of what each unknown may be beforehand.
  Eigen::MatrixXd design(n, settings + causes);
  design.leftCols(settings) = a.rows.by_setting(space.kept, Eigen::all) * a.rows.sigma.asDiagonal();
  for (Eigen::Index k = 0; k < causes; ++k) {
    const int column = a.estimate.directions[a.estimate.free[static_cast<std::size_t>(k)]];
    design.col(settings + k) =
        a.rows.g(space.kept, column) * kWideDelta / std::max(space.g.col(column).norm(), 1e-12);
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

/// How far the draws go at one rank.
struct Reach {
  double mean = 0.0;
  double below = 0.0;  ///< from the mean down to what 2.5 % are below
  double above = 0.0;
};

Reach reach_at(const std::vector<std::vector<double>>& curves, std::size_t rank) {
  std::vector<double> draws;
  double sum = 0.0;
  for (const auto& curve : curves) {
    draws.push_back(curve[rank]);
    sum += curve[rank];
  }
  std::sort(draws.begin(), draws.end());
  const double mean = sum / static_cast<double>(draws.size());
  return {mean, mean - draws[kOutermost], draws[draws.size() - 1 - kOutermost] - mean};
}

/// Largest deviation of a curve over all ranks, in units of the reach there.
double largest_deviation(const std::vector<Reach>& reaches, const std::vector<double>& curve) {
  double largest = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double off = curve[i] - reaches[i].mean;
    largest = std::max(largest, off < 0.0 ? -off / reaches[i].below : off / reaches[i].above);
  }
  return largest;
}

}  // namespace

std::optional<NormalPlot> normal_plot(const Session& session,
                                      const Analysis& a,
                                      std::uint64_t seed) {
  // Of distances the holes' own errors hide what is normal and what is not.
  if (session.distances) return std::nullopt;
  const Space& space = space_of(a);
  const Eigen::Index rows = rows_of_points(session, space);
  if (rows < 2 * static_cast<Eigen::Index>(kFewestPoints)) return std::nullopt;
  const Eigen::VectorXd& left =
      a.judgement.pattern_left ? a.estimate.left_beside_pattern : a.estimate.left;
  NormalPlot plot;
  plot.values = shape_of(Eigen::VectorXd(left(space.kept)).head(rows));
  const Eigen::MatrixXd noise = left_of_noise(a, seed);
  std::vector<std::vector<double>> curves;
  for (Eigen::Index draw = 0; draw < kDraws; ++draw) {
    curves.push_back(shape_of(noise.col(draw).head(rows)));
  }
  std::vector<Reach> reaches;
  for (std::size_t i = 0; i < plot.values.size(); ++i) reaches.push_back(reach_at(curves, i));
  std::vector<double> deviations;
  for (const auto& curve : curves) deviations.push_back(largest_deviation(reaches, curve));
  std::sort(deviations.begin(), deviations.end());
  const double own = largest_deviation(reaches, plot.values);
  const auto as_far =
      deviations.end() - std::lower_bound(deviations.begin(), deviations.end(), own);
  // The data count as one draw.
  plot.p_value = (static_cast<double>(as_far) + 1.0) / (kDraws + 1.0);
  const double band = deviations[kInside - 1];
  for (const Reach& reach : reaches) {
    plot.expected.push_back(reach.mean);
    plot.low.push_back(reach.mean - band * reach.below);
    plot.high.push_back(reach.mean + band * reach.above);
  }
  return plot;
}

}  // namespace chaintrue::grid::diagnosis
