// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/findings.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kSmooth_mm = 450.0;  // length over which a discrepancy is looked for
constexpr int kDraws = 999;
constexpr int kDegree = 4;
/// Share of what is left that a coordinate must explain, beyond what its terms take by chance.
constexpr double kFollowsShare = 0.2;
/// Of what no place explains, so much must follow the visits before they are named.
constexpr double kTimeOverPlace = 0.3;

/// e'K e / e'e against draws of noise: is there more in common between neighbours than chance has?
double p_of_structure(const Session& session,
                      const LinearisedSystem& system,
                      const std::vector<Eigen::Index>& kept,
                      const Eigen::VectorXd& left,
                      std::uint64_t seed) {
  Eigen::VectorXd e = left(kept);
  Eigen::MatrixXd k =
      discrepancy_covariance(session, system, kept, {DiscrepancyKind::chains, kSmooth_mm});
  if (system.nuisances > 0) {
    const Eigen::LLT<Eigen::MatrixXd> noise = nuisance_noise(system, kept);
    noise.matrixL().solveInPlace(e);
    noise.matrixL().solveInPlace(k);
    k.transposeInPlace();
    noise.matrixL().solveInPlace(k);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
  const Eigen::ArrayXd values = eigen.eigenvalues().array();
  const double seen = e.dot(k * e) / std::max(e.squaredNorm(), 1e-300);
  constexpr std::uint64_t kStream = 63;
  synthetic::Random random(seed, kStream);
  int above = 0;
  Eigen::ArrayXd z(e.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    for (Eigen::Index i = 0; i < z.size(); ++i) z(i) = random.normal();
    if ((values * z.square()).sum() / z.square().sum() >= seen) ++above;
  }
  return (above + 1.0) / (kDraws + 1.0);
}

struct Coordinate {
  const char* name;
  double (*value)(const SessionPoint&, const PointState&);
};

constexpr Coordinate kCoordinates[] = {
    {"angle_left",
     [](const SessionPoint&, const PointState& s) { return s.reading.pose.chains.left.angle_rad; }},
    {"angle_right",
     [](const SessionPoint&, const PointState& s) {
       return s.reading.pose.chains.right.angle_rad;
     }},
    {"length_left",
     [](const SessionPoint&, const PointState& s) { return s.reading.pose.lengths.left_mm; }},
    {"length_right",
     [](const SessionPoint&, const PointState& s) { return s.reading.pose.lengths.right_mm; }},
    {"tension_left",
     [](const SessionPoint&, const PointState& s) {
       return s.reading.pose.chains.left.tension_at_sprocket_n;
     }},
    {"tension_right",
     [](const SessionPoint&, const PointState& s) {
       return s.reading.pose.chains.right.tension_at_sprocket_n;
     }},
    {"x", [](const SessionPoint& p, const PointState&) { return p.mark.x_mm; }},
    {"y", [](const SessionPoint& p, const PointState&) { return p.mark.y_mm; }},
    {"order",
     [](const SessionPoint& p, const PointState&) { return static_cast<double>(p.order); }},
};

/// Share of the square of what is left that a quartic along the coordinate takes in either chain,
/// less what as many terms take of noise.
double share_along(const Session& session,
                   const LinearisedSystem& system,
                   const std::vector<bool>& outliers,
                   const std::vector<Eigen::Vector2d>& chain,
                   const Coordinate& coordinate) {
  std::vector<double> t;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    if (outliers[i]) continue;
    t.push_back(coordinate.value(session.points[i], system.points[i]));
    used.push_back(i);
  }
  const auto [low, high] = std::minmax_element(t.begin(), t.end());
  if (!(*high > *low)) return 0.0;
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd basis(n, kDegree + 1);
  Eigen::MatrixXd values(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = 2.0 * (t[static_cast<std::size_t>(i)] - *low) / (*high - *low) - 1.0;
    basis(i, 0) = 1.0;
    basis(i, 1) = x;
    for (int k = 2; k <= kDegree; ++k) basis(i, k) = 2.0 * x * basis(i, k - 1) - basis(i, k - 2);
    values.row(i) = chain[used[static_cast<std::size_t>(i)]].transpose();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
  const Eigen::MatrixXd rest = values - basis * qr.solve(values);
  const double of_noise = static_cast<double>(n - kDegree - 1) / static_cast<double>(n);
  return 1.0 - rest.squaredNorm() / (of_noise * std::max(values.squaredNorm(), 1e-300));
}

}  // namespace

LeftOver left_over(const Session& session, const Analysis& a, std::uint64_t seed) {
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[a.decision.marginalised];
  LeftOver result;
  const Eigen::VectorXd left = left_of_machine(a.system, a.estimate, a.estimate.left);
  result.p_value = p_of_structure(session, a.system, marginalised.kept, left, seed);
  if (a.decision.best_discrepancy >= 0) {
    const Estimate beside = estimate(
        session, a.system, marginalised, a.decision.regressors, a.decision.best_discrepancy);
    const Eigen::VectorXd discrepancy = beside.left - beside.left_beside_discrepancy;
    result.signal_to_noise =
        length_in_noise(a.system, marginalised.kept, discrepancy) / std::sqrt(beside.noise_square);
  }
  // A distance has no place to follow, and a few holes draw no curve.
  if (result.p_value >= kFalseAlarm || session.distances) return result;
  const auto chain = chain_residuals(a.system, a.estimate.left);
  for (const Coordinate& coordinate : kCoordinates) {
    if (coordinate.name == std::string_view("order") && !session.ordered) continue;
    const double share = share_along(session, a.system, marginalised.outliers, chain, coordinate);
    // Where the bed was visited in order, time and place run together: place is the simpler guess.
    const double needed = coordinate.name == std::string_view("order")
                              ? result.share + kTimeOverPlace * (1.0 - result.share)
                              : result.share;
    if (share > needed) {
      result.share = share;
      result.follows = coordinate.name;
    }
  }
  if (result.share < kFollowsShare) result.follows.clear();
  return result;
}

}  // namespace chaintrue::grid::diagnosis
