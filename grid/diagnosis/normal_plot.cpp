// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/normal_plot.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "grid/diagnosis/leading.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kDraws = 499;
constexpr int kInside = 474;  // 95 % of them

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

/// At each rank the draws' values, ascending.
using Ranks = std::vector<std::vector<double>>;

/// How deep inside the draws a curve lies at its shallowest rank: 0 outside of all.
int depth(const Ranks& ranks, const std::vector<double>& curve) {
  auto least = static_cast<std::ptrdiff_t>(kDraws);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const std::vector<double>& at = ranks[i];
    const auto below = std::lower_bound(at.begin(), at.end(), curve[i]) - at.begin();
    const auto above = at.end() - std::upper_bound(at.begin(), at.end(), curve[i]);
    least = std::min({least, below, above});
  }
  return static_cast<int>(least);
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
  Ranks ranks(plot.values.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    double sum = 0.0;
    for (const auto& curve : curves) {
      ranks[i].push_back(curve[i]);
      sum += curve[i];
    }
    std::sort(ranks[i].begin(), ranks[i].end());
    plot.expected.push_back(sum / kDraws);
  }
  std::vector<int> depths;
  for (const auto& curve : curves) depths.push_back(depth(ranks, curve));
  const int own = depth(ranks, plot.values);
  // The data count as one draw; of draws as deep as the data half are counted.
  double shallower = 0.0;
  for (const int d : depths) shallower += d < own ? 1.0 : d == own ? 0.5 : 0.0;
  plot.p_value = (shallower + 1.0) / (kDraws + 1.0);
  std::sort(depths.begin(), depths.end(), std::greater<>());
  const auto edge = static_cast<std::size_t>(depths[kInside - 1]);
  for (const auto& at : ranks) {
    plot.low.push_back(at[edge]);
    plot.high.push_back(at[at.size() - 1 - edge]);
  }
  return plot;
}

}  // namespace chaintrue::grid::diagnosis
