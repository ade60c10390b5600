// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in holes_fit.hpp; h, by how much all readings of a session are too long.
#include "grid/holes/holes_solution.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace chaintrue::grid {
namespace {

/// log N(y; 0, known + s2 noise), and the stated noise's own say: scaled inverse chi-square in the
/// logarithm of s2.
double log_evidence(const Eigen::MatrixXd& known,
                    const Eigen::MatrixXd& noise,
                    const Eigen::VectorXd& response,
                    double noise2,
                    double dof) {
  const Eigen::LLT<Eigen::MatrixXd> factor(known + noise2 * noise);
  const Eigen::MatrixXd lower = factor.matrixL();
  const double log_root = lower.diagonal().array().log().sum();
  return -log_root - 0.5 * response.dot(factor.solve(response)) -
         0.5 * dof * (std::log(noise2) + 1.0 / noise2);
}

/// Golden section over the logarithm; the posterior has one hill.
double choose_noise2(const Eigen::MatrixXd& known,
                     const Eigen::MatrixXd& noise,
                     const Eigen::VectorXd& response,
                     double dof) {
  constexpr double kGolden = 0.6180339887498949;
  double low = std::log(0.05);
  double high = std::log(400.0);
  const auto value = [&](double log_noise2) {
    return log_evidence(known, noise, response, std::exp(log_noise2), dof);
  };
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double at_left = value(left);
  double at_right = value(right);
  while (high - low > 1e-4) {
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = value(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = value(right);
    }
  }
  return std::exp(0.5 * (low + high));
}

/// Of each session h = hook^2 1' K^-1 y, variance hook^2 - hook^4 1' K^-1 1.
std::vector<FoundHook> hooks_of(const LinearHoles& holes,
                                const std::vector<Eigen::Index>& rows,
                                const Eigen::MatrixXd& inverse,
                                const Eigen::VectorXd& pulled) {
  std::vector<FoundHook> hooks;
  const double variance = std::pow(holes.set.tape.hook_sigma_mm.value_or(0.0), 2);
  if (variance == 0.0) return hooks;
  std::size_t sessions = 0;
  for (const HoleDistance& distance : holes.set.distances)
    sessions = std::max(sessions, distance.session + 1);
  for (std::size_t session = 0; session < sessions; ++session) {
    Eigen::VectorXd ones = Eigen::VectorXd::Zero(pulled.size());
    for (Eigen::Index i = 0; i < ones.size(); ++i) {
      const auto k = static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]);
      ones[i] = holes.set.distances[k].session == session ? 1.0 : 0.0;
    }
    hooks.push_back({variance * ones.dot(pulled),
                     std::sqrt(variance - variance * variance * ones.dot(inverse * ones))});
  }
  return hooks;
}

}  // namespace

std::vector<Eigen::Index> used_rows(const Eigen::VectorXd& weights) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (weights[k] > 0.0) rows.push_back(k);
  }
  return rows;
}

HolesSolution solve_holes(const LinearHoles& holes, const Eigen::MatrixXd& prior) {
  const std::vector<Eigen::Index> rows = used_rows(holes.weights);
  const Eigen::MatrixXd& by_v = holes.by_unknown;
  const Eigen::VectorXd& weights = holes.weights;
  const HoleMarks::View& view = holes.view;
  const Eigen::MatrixXd known =
      by_v * prior * by_v.transpose() + view.noise.size_mm2 + view.noise.hook_mm2;
  Eigen::MatrixXd noise = view.noise.holes_mm2;
  noise.diagonal() += view.noise.tape_mm2;
  Eigen::MatrixXd soft = noise;
  for (const Eigen::Index k : rows) {
    soft(k, k) += view.noise.tape_mm2[k] * (1.0 / weights[k] - 1.0);
  }
  const Eigen::VectorXd y = holes.response(rows);
  HolesSolution solution;
  solution.noise2 = choose_noise2(known(rows, rows), soft(rows, rows), y, holes.set.noise_dof);
  solution.log_evidence =
      log_evidence(known(rows, rows), soft(rows, rows), y, solution.noise2, holes.set.noise_dof);
  const Eigen::MatrixXd all = known + solution.noise2 * soft;
  const Eigen::LLT<Eigen::MatrixXd> factor(all(rows, rows));
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::VectorXd pulled = inverse * y;
  const Eigen::MatrixXd cross = prior * by_v(rows, Eigen::all).transpose();
  solution.change = cross * pulled;
  solution.covariance = prior - cross * inverse * cross.transpose();
  solution.hole_shift = solution.noise2 * holes.set.hole_sigma_mm * holes.set.hole_sigma_mm *
                        view.geometry.by_mark(rows, Eigen::all).transpose() * pulled;
  solution.hooks = hooks_of(holes, rows, inverse, pulled);
  solution.left_out.resize(weights.size());
  solution.left_out_sigma.resize(weights.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = rows[static_cast<std::size_t>(i)];
    solution.left_out[k] = pulled[i] / inverse(i, i);
    const double softened = soft(k, k) - noise(k, k);
    solution.left_out_sigma[k] = std::sqrt(1.0 / inverse(i, i) - solution.noise2 * softened);
  }
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (weights[k] > 0.0) continue;
    const Eigen::VectorXd with = all(rows, std::vector<Eigen::Index>{k});
    solution.left_out[k] = holes.response[k] - with.dot(pulled);
    solution.left_out_sigma[k] = std::sqrt(all(k, k) - with.dot(inverse * with));
  }
  return solution;
}

}  // namespace chaintrue::grid
